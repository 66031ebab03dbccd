# SPDX-License-Identifier: GPL-3.0-or-later
"""Uniform blocks: their layout as GLSL sees it, and their values as a device takes them."""

from __future__ import annotations

import numpy as np


def std140(*parts) -> np.ndarray:
    """float32 values: matrices column by column, vectors of four."""
    return np.concatenate([np.asarray(p, np.float64).T.ravel() for p in parts]).astype(np.float32)


#: Defined where fragments write depth / far.
LINEAR_DEPTH = (("LINEAR_DEPTH", "1"),)
#: Defined where sums are float16.
HALF_SUMS = (("HALF_SUMS", "1"),)
