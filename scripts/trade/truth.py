# SPDX-License-Identifier: GPL-3.0-or-later
"""The float64 pictures, kept between runs, and how far a frame is from them.

FLIP (Andersson et al. 2020) is NVIDIA's own evaluator, for low dynamic range at its default of 67 pixels a degree.
"""

from __future__ import annotations

import hashlib
from dataclasses import fields, is_dataclass, replace
from pathlib import Path

import flip_evaluator
import numpy as np
from environment import ROOT

from splat_addon.reference import render_exact
from splat_addon.reference.filters import GAUSSIAN_MARGIN, filter_weights, resample
from splat_addon.reference.metrics import psnr, srgb
from splat_addon.rendering import Frame

FILTERS = ("gaussian", "box")

#: What the truth is computed by: when it changes, kept pictures are computed anew.
SOURCES = sorted((ROOT / "splat_addon" / "reference").glob("*.py"))


def exact_frames(scene, camera, settings, samples: int, folder: Path) -> dict[str, Frame]:
    """filter -> the exact frame, of colour and coverage only, read from `folder` where it was computed before.

    Both filters take the same rays: a picture of `samples` times the size, of one ray a pixel, with a margin.
    """
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / f"{_digest(scene, camera, settings.shading, settings.epsilon, samples)}.npz"
    if not path.is_file():
        np.savez(path, **_filtered(_rays(scene, camera, settings, samples), samples))
    with np.load(path) as kept:
        return {name: Frame(kept[name][..., :4], None, None, kept[name][..., 4]) for name in FILTERS}


def _rays(scene, camera, settings, samples: int) -> np.ndarray:
    """(rows, columns, 5): colour and coverage of every ray of the picture and `GAUSSIAN_MARGIN` pixels around it."""
    width, height = (edge + 2 * GAUSSIAN_MARGIN for edge in camera.size)
    around = camera.cropped(-GAUSSIAN_MARGIN, -GAUSSIAN_MARGIN, width, height)
    fine = render_exact(scene, replace(around, size=(width * samples, height * samples)), settings, samples=1)
    return np.concatenate([fine.color, fine.coverage[..., None]], axis=2)


def _filtered(rays: np.ndarray, samples: int) -> dict[str, np.ndarray]:
    """filter -> (h, w, 5) pixels."""
    pixels = {}
    for name in FILTERS:
        weights = filter_weights(name, samples)
        spare = (GAUSSIAN_MARGIN - (len(weights) // samples - 1) // 2) * samples
        inner = rays[spare : len(rays) - spare, spare : rays.shape[1] - spare]
        pixels[name] = resample(inner, weights, samples).astype(np.float32)
    return pixels


def accuracy(frame: Frame, exact: dict[str, Frame]) -> dict:
    """Columns of a row: PSNR of sRGB and mean FLIP under each filter, holes, and pixels that are no numbers."""
    row = {}
    for name, truth in exact.items():
        row[f"psnr_{name}"] = round(psnr(frame.color, truth.color), 2)
        row[f"flip_{name}"] = round(mean_flip(frame.color, truth.color), 4)
    covered = exact["box"].coverage > 0.999
    row["holes"] = int(np.count_nonzero(covered & (frame.coverage == 0)))
    row["non_finite"] = int(np.count_nonzero(~np.isfinite(frame.color).all(axis=2)))
    return row


def mean_flip(picture: np.ndarray, truth: np.ndarray) -> float:
    """Of two scene-linear pictures (h, w, 3 or 4)."""
    return float(flip_evaluator.evaluate(_display(truth), _display(picture), "LDR", applyMagma=False)[1])


def flip_map(picture: np.ndarray, truth: np.ndarray) -> np.ndarray:
    """(h, w, 3) 0 to 1: the error of each pixel in the colours of magma."""
    return flip_evaluator.evaluate(_display(truth), _display(picture), "LDR")[0]


def _display(linear: np.ndarray) -> np.ndarray:
    return np.ascontiguousarray(srgb(np.nan_to_num(linear[..., :3])), np.float32)


def _digest(*values) -> str:
    """The same for the same scene, camera, numbers and sources, in any run."""
    state = hashlib.sha256()
    for value in (*values, *(path.read_bytes() for path in SOURCES)):
        _feed(state, value)
    return state.hexdigest()[:32]


def _feed(state, value) -> None:
    if is_dataclass(value):
        for field in fields(value):
            _feed(state, getattr(value, field.name))
    elif isinstance(value, np.ndarray):
        state.update(f"{value.dtype}{value.shape}".encode() + np.ascontiguousarray(value).tobytes())
    elif isinstance(value, (tuple, list)):
        for item in (len(value), *value):
            _feed(state, item)
    else:
        state.update(f"{value!r};".encode())
