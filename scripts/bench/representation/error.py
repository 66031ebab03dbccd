# SPDX-License-Identifier: GPL-3.0-or-later
"""Measures how far a picture is from that of the mesh."""

from __future__ import annotations

from dataclasses import dataclass

import flip_evaluator
import numpy as np
from scipy import ndimage

from splat_addon.reference.metrics import psnr, srgb

#: Scene-linear grey of the background, the colour of Blender's default world.
BACKGROUND = 0.05

#: In sRGB, the difference beyond which a pixel is wrong; the coverage below which it is bare, and above which it is
#: spilled.
WRONG, BARE, SPILLED = 0.15, 0.98, 0.02


@dataclass(frozen=True, eq=False)
class PictureError:
    """psnr: dB in sRGB.
    flip, flip_99: mean and 99th percentile of FLIP (Andersson et al. 2020) at 67 pixels per degree.
    blob: pixels in the largest connected blob of wrong ones.
    wrong, bare, spilled: number of pixels.
    difference: (h, w, 3) linear values that show four times the sRGB difference.
    """

    psnr: float
    flip: float
    flip_99: float
    blob: int
    wrong: int
    bare: int
    spilled: int
    difference: np.ndarray


def over_grey(color: np.ndarray, alpha: np.ndarray) -> np.ndarray:
    """(h, w, 3) premultiplied colour over the background."""
    return color + (1 - alpha[..., None]) * BACKGROUND


def picture_error(shown: np.ndarray, truth: np.ndarray, coverage: np.ndarray, true_coverage: np.ndarray):
    """shown, truth: (h, w, 3) scene-linear. coverage: (h, w) each."""
    off = np.abs(srgb(shown) - srgb(truth))
    is_wrong = off.max(axis=2) > WRONG
    blobs, count = ndimage.label(is_wrong, np.ones((3, 3)))
    displayed = (np.ascontiguousarray(srgb(picture), np.float32) for picture in (truth, shown))
    flip = np.asarray(flip_evaluator.evaluate(*displayed, "LDR", applyMagma=False)[0])
    return PictureError(
        psnr(shown, truth),
        float(flip.mean()),
        float(np.percentile(flip, 99)),
        int(np.bincount(blobs.ravel())[1:].max()) if count else 0,
        int(is_wrong.sum()),
        int(((true_coverage > 0.999) & (coverage < BARE)).sum()),
        int(((true_coverage < 0.001) & (coverage > SPILLED)).sum()),
        np.clip(4 * off, 0, 1) ** 2.2,
    )
