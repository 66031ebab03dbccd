# SPDX-License-Identifier: GPL-3.0-or-later
"""The float64 pictures, kept between runs, and how far a frame is from them.

FLIP (Andersson et al. 2020) is NVIDIA's own evaluator, for low dynamic range at its default of 67 pixels a degree.
"""

from __future__ import annotations

import hashlib
from dataclasses import fields, is_dataclass
from pathlib import Path

import flip_evaluator
import numpy as np
from environment import ROOT

from splat_addon.reference import render_exact
from splat_addon.reference.metrics import psnr, srgb
from splat_addon.rendering import Frame

FILTERS = ("gaussian", "box")

#: What the truth is computed by: when it changes, kept pictures are computed anew.
SOURCES = sorted((ROOT / "splat_addon" / "reference").glob("*.py"))


def exact_frames(scene, camera, settings, samples: int, folder: Path) -> dict[str, Frame]:
    """filter -> the exact frame, of colour and coverage only, read from `folder` where it was computed before."""
    folder.mkdir(parents=True, exist_ok=True)
    frames = {}
    for name in FILTERS:
        path = folder / f"{_digest(scene, camera, settings.shading, settings.epsilon, samples, name)}.npz"
        if not path.is_file():
            frame = render_exact(scene, camera, settings, samples=samples, pixel_filter=name)
            np.savez(path, color=frame.color, coverage=frame.coverage)
        with np.load(path) as kept:
            frames[name] = Frame(kept["color"], None, None, kept["coverage"])
    return frames


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
