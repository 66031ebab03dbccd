# SPDX-License-Identifier: GPL-3.0-or-later
"""Exact pictures under both pixel filters, kept in a folder between runs: the truth is slow."""

from __future__ import annotations

import hashlib
from dataclasses import fields, is_dataclass, replace
from pathlib import Path

import numpy as np

from ..rendering.frame import Frame
from .exact import render_exact
from .filters import GAUSSIAN_MARGIN, filter_weights, resample

FILTERS = ("gaussian", "box")

#: What the truth is computed by: when it changes, kept pictures are computed anew.
SOURCES = sorted(Path(__file__).parent.glob("*.py"))


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
