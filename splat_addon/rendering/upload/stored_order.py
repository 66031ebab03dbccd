# SPDX-License-Identifier: GPL-3.0-or-later
"""Clipped surfels are stored before the others, so that either are a draw of their own, and their lines beside them."""

from __future__ import annotations

import numpy as np

from ...surfels import Surfels


def clipped_first(surfels: Surfels, order: np.ndarray | None = None):
    """The index that stores them in the given order (None: their own) but for the clipped ones, which come first.

    Those are turned round: where one kind ends and the other begins, neighbours in the order stay neighbours.
    """
    if not surfels.clipped_count:
        return slice(None) if order is None else order
    order = np.arange(len(surfels)) if order is None else order
    is_cut = surfels.is_cut()[order]
    return np.concatenate([order[is_cut][::-1], order[~is_cut]])
