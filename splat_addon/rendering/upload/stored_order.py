# SPDX-License-Identifier: GPL-3.0-or-later
"""Storage order with clipped surfels first, so that both kinds are one draw each, and clip lines are stored for the
former only."""

from __future__ import annotations

import numpy as np

from ...surfels import Surfels


def clipped_first(surfels: Surfels, order: np.ndarray | None = None):
    """The index that applies the given order (None: unchanged), but puts clipped surfels first.

    Clipped surfels are reversed, so that neighbours stay close where one kind ends and the other begins.
    """
    if not surfels.clipped_count:
        return slice(None) if order is None else order
    order = np.arange(len(surfels)) if order is None else order
    is_cut = surfels.is_cut()[order]
    return np.concatenate([order[is_cut][::-1], order[~is_cut]])
