# SPDX-License-Identifier: GPL-3.0-or-later
"""Vectors in the last axis of arrays."""

from __future__ import annotations

import numpy as np


def unit(vectors: np.ndarray) -> np.ndarray:
    """(..., c) the same directions with length 1; NaN, without a warning, for vectors without any."""
    with np.errstate(over="ignore", divide="ignore", invalid="ignore"):
        return vectors / np.linalg.norm(vectors, axis=-1, keepdims=True)
