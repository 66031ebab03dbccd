# SPDX-License-Identifier: GPL-3.0-or-later
"""The mean of frames whose cameras differ a little (Haeberli & Akeley, "The accumulation buffer", 1990).

The cameras follow sequences of low discrepancy that may stop anywhere, so more samples are always better. Places in the
pixel: additive recurrence by the generalised golden ratio (Roberts, "The unreasonable effectiveness of quasirandom
sequences", 2018). Places on the lens: Halton 1960, bases 2 and 3; two more of Roberts' nearly repeat every 13 samples.
Times of an open shutter: base 5. Times that run with the number are a little better on average, but at some speeds (2.3
pixels a picture of 16 samples) what moves keeps pace with the places in the pixel.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from itertools import pairwise

import numpy as np

from .frame import Frame
from .scene.camera import Camera
from .settings import NEAREST, OUTPUTS

#: Arrays of a frame that are means over its samples.
_MEANS = tuple(name for name in OUTPUTS if name not in (*NEAREST, "cryptomatte"))

#: The root above 1 of x^5 = x + 1. Of its powers, the first two serve pixels better than those of x^3 = x + 1: the
#: error along random edges with 16 samples is a third less.
_RATIO = 1.1673039782614187


def sample_points(count: int, first: int = 0) -> np.ndarray:
    """(count, 4) float64 in [0, 1): two coordinates in the pixel, two on the lens, of samples number `first` and on.
    Number 0 is the middle of both.
    """
    number = np.arange(first, first + count)
    in_pixel = number[:, None] * _RATIO ** -np.array((1.0, 2.0))
    on_lens = np.stack([_mirrored(number, base) for base in (2, 3)], axis=1)
    return (0.5 + np.concatenate([in_pixel, on_lens], axis=1)) % 1


def _mirrored(number: np.ndarray, base: int) -> np.ndarray:
    """(n,) whole numbers -> float64 in [0, 1): their digits in that base, mirrored at the point."""
    value, place = np.zeros(len(number)), 1.0
    while number.any():
        place /= base
        value += place * (number % base)
        number = number // base
    return value


def sample_camera(camera: Camera, number: int) -> Camera:
    """The camera of a sample: a pinhole at that sample's place on the lens of `camera`, whose pixel centres lie at
    that sample's place in its pixels.

    Evenly over the pixel: the mean is that of a box filter one pixel wide.
    """
    ((x, y, *on_lens),) = sample_points(1, number)
    moved = _moved(camera, x - 0.5, y - 0.5)
    return _through(moved, camera.lens.points(np.array(on_lens))) if camera.lens else moved


def sample_blocks(samples: int, moments: int) -> list[list[int]]:
    """The numbers of the samples that are taken at each moment of an open shutter, in the order of time, as many at
    each as can be. Raises ValueError for more moments than samples.
    """
    if not 1 <= moments <= samples:
        raise ValueError(f"The moments of an open shutter must be 1 to {samples}, one a sample, not {moments}.")
    in_time = np.argsort(_mirrored(np.arange(samples), 5)).tolist() if moments > 1 else list(range(samples))
    ends = [samples * number // moments for number in range(moments + 1)]
    return [in_time[start:end] for start, end in pairwise(ends)]


def moment_places(samples: int, moments: int) -> list[float]:
    """When each block's moment is, 0 to 1 of the time that the shutter is open: the middle of its samples' share."""
    ends = np.cumsum([0, *(len(block) for block in sample_blocks(samples, moments))]) / samples
    return ((ends[1:] + ends[:-1]) / 2).tolist()


def mean_frame(frames: Iterable[Frame]) -> Frame:
    """Means of what is a mean over a pixel's samples; depth, position and indices of the nearest; times added up, other
    statistics of the last frame.

    Holds one sum and one frame at a time, in float32: a thousand frames round to about 1e-6.
    """
    count, sums, nearest, matte, milliseconds, passes, stats = 0, {}, {}, None, 0.0, {}, {}
    for frame in frames:
        for name in _MEANS:
            if (values := getattr(frame, name)) is not None:
                sums[name] = values + sums[name] if name in sums else values
        following = {name: getattr(frame, name) for name in NEAREST}
        nearest = _nearer(nearest, {name: values for name, values in following.items() if values is not None})
        if frame.cryptomatte is not None:
            matte = matte.plus(frame.cryptomatte) if matte else frame.cryptomatte
        milliseconds += frame.stats["milliseconds"]
        for name, elapsed in frame.stats["passes"].items():
            passes[name] = passes.get(name, 0.0) + elapsed
        count, stats = count + 1, frame.stats
    stats = {**stats, "milliseconds": milliseconds, "passes": passes, "samples": count}
    means = {name: total / np.float32(count) for name, total in sums.items()}
    arrays = means | nearest | {"cryptomatte": matte and matte.over(count)}
    return Frame(**{name: arrays.get(name) for name in OUTPUTS}, stats=stats)


def _nearer(kept: dict[str, np.ndarray], arrays: dict[str, np.ndarray]) -> dict[str, np.ndarray]:
    """Of two sets of arrays with a depth, in each pixel that of the lesser one."""
    if not kept:
        return arrays
    if "depth" not in arrays:
        return {}
    is_nearer = arrays["depth"] < kept["depth"]
    return {
        name: np.where(is_nearer[..., None] if values.ndim == 3 else is_nearer, values, kept[name])
        for name, values in arrays.items()
    }


def _moved(camera: Camera, x: float, y: float) -> Camera:
    """The camera with its window moved by pixels."""
    left, right, bottom, top = camera.window
    dx, dy = x * (right - left) / camera.size[0], y * (top - bottom) / camera.size[1]
    return replace(camera, window=(left + dx, right + dx, bottom + dy, top + dy))


def _through(camera: Camera, place: np.ndarray) -> Camera:
    """The camera at a place on its lens, its window moved so that what is in focus stays where it was."""
    left, right, bottom, top = camera.window
    dx, dy = place / camera.lens.focus_distance
    matrix = camera.matrix_world.copy()
    matrix[:3, 3] += matrix[:3, :2] @ place
    return replace(camera, matrix_world=matrix, window=(left - dx, right - dx, bottom - dy, top - dy), lens=None)
