# SPDX-License-Identifier: GPL-3.0-or-later
"""How close two pictures are, for tests and measurements: `differences`, and FLIP by its authors' own program."""

from __future__ import annotations

import numpy as np

from ..differences import psnr, srgb

__all__ = ("flip_map", "mean_flip", "psnr", "srgb")


def mean_flip(picture: np.ndarray, truth: np.ndarray) -> float:
    """Mean FLIP of two scene-linear pictures (h, w, 3 or 4), 0 to 1, by its authors' package flip-evaluator: for low
    dynamic range, 67 pixels a degree. Andersson et al. 2020, "FLIP: A Difference Evaluator for Alternating Images"."""
    import flip_evaluator

    return float(flip_evaluator.evaluate(_display(truth), _display(picture), "LDR", applyMagma=False)[1])


def flip_map(picture: np.ndarray, truth: np.ndarray) -> np.ndarray:
    """(h, w, 3) 0 to 1: FLIP of each pixel in the colours of magma."""
    import flip_evaluator

    return flip_evaluator.evaluate(_display(truth), _display(picture), "LDR")[0]


def _display(linear: np.ndarray) -> np.ndarray:
    return np.ascontiguousarray(srgb(np.nan_to_num(linear[..., :3])), np.float32)
