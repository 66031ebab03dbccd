# SPDX-License-Identifier: GPL-3.0-or-later
"""How close two pictures are. Used by tests and measurements, on the arrays of a `Frame`."""

from __future__ import annotations

import numpy as np


def srgb(linear: np.ndarray) -> np.ndarray:
    """Scene-linear values as sRGB code values 0 to 1 (IEC 61966-2-1), clipped; float64 of the same shape."""
    linear = np.clip(np.asarray(linear, np.float64), 0, 1)
    return np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)


#: of -> what the two pictures are turned into before they are compared
ENCODINGS = {"srgb": srgb, "linear": lambda linear: np.asarray(linear, np.float64)}


def psnr(a: np.ndarray, b: np.ndarray, of: str = "srgb") -> float:
    """Peak signal to noise ratio in dB of two pictures (h, w, c) of peak 1; infinite where they are equal, NaN where
    either holds a NaN.

    of: "srgb" compares what is seen on a screen, "linear" the values themselves. Only the first three channels
    are compared. Raises ValueError for an unknown encoding or different shapes.
    """
    if of not in ENCODINGS:
        raise ValueError(f"psnr is of one of {', '.join(ENCODINGS)}, not {of!r}.")
    if np.shape(a) != np.shape(b):
        raise ValueError(f"Only pictures of the same shape can be compared, not {np.shape(a)} and {np.shape(b)}.")
    a, b = (ENCODINGS[of](picture)[..., :3] for picture in (a, b))
    error = np.mean((a - b) ** 2)
    return float(-10 * np.log10(error)) if error != 0 else float("inf")


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
