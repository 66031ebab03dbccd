# SPDX-License-Identifier: GPL-3.0-or-later
"""The mean of frames whose cameras differ a little (Haeberli & Akeley, "The accumulation buffer", 1990).

The cameras follow a sequence of low discrepancy that may stop anywhere, so more samples are always better: additive
recurrence by the generalised golden ratio (Roberts, "The unreasonable effectiveness of quasirandom sequences", 2018).
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import replace

import numpy as np

from .camera import Camera
from .frame import Frame

#: Coordinates of a sample: two within the pixel, two on the lens.
DIMENSIONS = 4


def sample_points(count: int) -> np.ndarray:
    """(count, DIMENSIONS) float64 in [0, 1): the first is the middle, and any first few are spread evenly."""
    ratio = np.roots([1.0, *[0.0] * (DIMENSIONS - 1), -1.0, -1.0])  # the real root above 1 of x^(d + 1) = x + 1
    ratio = ratio[np.abs(ratio.imag) < 1e-9].real.max()
    steps = ratio ** -np.arange(1.0, DIMENSIONS + 1)
    return (0.5 + np.arange(count)[:, None] * steps) % 1


def sample_cameras(camera: Camera, count: int) -> Iterator[Camera]:
    """The camera of each sample: its pixel centres lie at that sample's place in the pixels of `camera`.

    One sample is `camera` itself. Evenly over the pixel: the mean is that of a box filter one pixel wide.
    """
    for x, y, *_ in sample_points(count):
        yield _moved(camera, x - 0.5, y - 0.5)


def mean_frame(frames: Iterable[Frame]) -> Frame:
    """Means of colour, normal and coverage; the nearest depth; times added up, other statistics of the last frame.

    Holds one sum and one frame at a time, in float32: a thousand frames round to about 1e-6.
    """
    count, sums, depth, milliseconds, passes, stats = 0, {}, None, 0.0, {}, {}
    for frame in frames:
        for name in ("color", "normal", "coverage"):
            if (values := getattr(frame, name)) is not None:
                sums[name] = values + sums[name] if name in sums else values
        if frame.depth is not None:
            depth = frame.depth if depth is None else np.minimum(depth, frame.depth)
        milliseconds += frame.stats["milliseconds"]
        for name, elapsed in frame.stats["passes"].items():
            passes[name] = passes.get(name, 0.0) + elapsed
        count, stats = count + 1, frame.stats
    stats = {**stats, "milliseconds": milliseconds, "passes": passes, "samples": count}
    means = {name: total / np.float32(count) for name, total in sums.items()}
    return Frame(means.get("color"), depth, means.get("normal"), means.get("coverage"), stats)


def _moved(camera: Camera, x: float, y: float) -> Camera:
    """The camera with its window moved by pixels."""
    left, right, bottom, top = camera.window
    dx, dy = x * (right - left) / camera.size[0], y * (top - bottom) / camera.size[1]
    return replace(camera, window=(left + dx, right + dx, bottom + dy, top + dy))
