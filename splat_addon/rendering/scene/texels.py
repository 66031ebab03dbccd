# SPDX-License-Identifier: GPL-3.0-or-later
"""Colours in the layout of a texture on the device, which has four channels."""

from __future__ import annotations

import numpy as np


def opaque_texels(colors: np.ndarray) -> np.ndarray:
    """(..., 4) float32 from (..., 3) float32, with an alpha of 1."""
    return np.concatenate([colors, np.ones((*colors.shape[:-1], 1), np.float32)], axis=-1)
