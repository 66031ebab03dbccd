# SPDX-License-Identifier: GPL-3.0-or-later
"""Averages frames whose cameras differ slightly (Haeberli & Akeley, "The accumulation buffer", 1990).

The camera offsets follow low-discrepancy sequences that may stop anywhere, so more samples always improve the mean.
Positions in the pixel: additive recurrence with the generalised golden ratio (Roberts, "The unreasonable effectiveness
of quasirandom sequences", 2018), in pairs about the middle: forwards alone, 16 of them displace the picture by 0.1
pixels. All are moved by their mean, because a point without its pair would displace it by 0.03. Positions on the lens:
Halton 1960, bases 2 and 3, because two more of Roberts' dimensions nearly repeat every 13 samples. Times of an open
shutter: a third recurrence, in the same pairs.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from functools import lru_cache
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from ..frame import Frame
from ..scene.camera import Camera
from ..settings import NEAREST, OUTPUTS

#: Arrays of a frame that are means over its samples.
_MEANS = tuple(name for name in OUTPUTS if name not in (*NEAREST, "cryptomatte"))

#: Variance of a box one pixel wide, in square pixels.
_BOX_VARIANCE = 1 / 12

#: The root above 1 of x^3 = x + 1, the generalised golden ratio of two dimensions.
_RATIO = 1.3247179572447460
#: Found by a search over edges that move by 0.5 to 45 pixels, with 8 to 256 samples, for those that are blurred evenly.
#: Simpler steps, such as powers of the ratio, are in resonance with the positions in the pixel at some speeds.
_TIME_STEP = 0.33219


def sample_points(count: int, first: int = 0) -> np.ndarray:
    """(count, 4) float64 in [0, 1): two coordinates in the pixel and two on the lens, for samples starting at number
    `first`. Sample 0 is the middle of both."""
    number = np.arange(first, first + count)
    in_pixel = _steps(number)[:, None] * _RATIO ** -np.array((1.0, 2.0))
    on_lens = np.stack([_mirrored(number, base) for base in (2, 3)], axis=1)
    return (0.5 + np.concatenate([in_pixel, on_lens], axis=1)) % 1


def pixel_offset(number: int, samples: int) -> np.ndarray:
    """(2,) float64, in pixels: the offset of a sample from the pixel's middle. The offsets of all `samples` of a
    picture have the mean 0."""
    return _offsets(samples)[number]


@lru_cache(1)
def _offsets(samples: int) -> np.ndarray:
    points = sample_points(samples)[:, :2]
    return points - points.mean(axis=0)


def _steps(number: np.ndarray) -> np.ndarray:
    """(n,) sample numbers -> 0, 1, -1, 2, -2 ...: steps of a sequence that runs forwards and backwards."""
    return np.where(number % 2, number // 2 + 1, -(number // 2))


def _mirrored(number: np.ndarray, base: int) -> np.ndarray:
    """(n,) integers -> float64 in [0, 1): their digits in that base, mirrored at the radix point (radical inverse)."""
    value, place = np.zeros(len(number)), 1.0
    while number.any():
        place /= base
        value += place * (number % base)
        number = number // base
    return value


def sample_camera(camera: Camera, number: int, samples: int) -> Camera:
    """The camera of one of a picture's samples: a pinhole at the sample's point on the lens of `camera`, with pixel
    centres at the sample's point in each pixel.

    Offsets are uniform over the pixel, so the mean of several has a box filter one pixel wide. Their own filters are
    narrower by that, so that a picture is as sharp whatever the number of its samples.
    """
    # a camera that is one of a picture's samples already stays one
    variance = camera.sample_variance + (_BOX_VARIANCE if samples > 1 else 0.0)
    own = {"sample": camera.sample + number, "sample_variance": variance}
    moved = camera.with_values(window=_moved(camera, *pixel_offset(number, samples).tolist()), **own)
    return _through(moved, camera.lens.points(sample_points(1, number)[0, 2:])) if camera.lens else moved


def around_samples(camera: Camera, samples: int) -> Camera:
    """A camera that sees all that the samples of a picture see, in pixels of the same size."""
    width, height = camera.size
    return camera.cropped(-1, -1, width + 2, height + 2) if samples > 1 else camera


def sample_blocks(samples: int, moments: int) -> list[list[int]]:
    """The sample numbers for each time of an open shutter, in temporal order, spread as evenly as possible. Raises
    ValueError for more times than samples."""
    if not 1 <= moments <= samples:
        raise ValueError(f"The moments of an open shutter must be 1 to {samples}, one a sample, not {moments}.")
    in_time = np.argsort(_times(samples)).tolist() if moments > 1 else list(range(samples))
    ends = [samples * number // moments for number in range(moments + 1)]
    return [in_time[start:end] for start, end in pairwise(ends)]


def _times(samples: int) -> np.ndarray:
    """(samples,) their times in [0, 1)."""
    return (0.5 + _steps(np.arange(samples)) * _TIME_STEP) % 1


def moment_places(samples: int, moments: int) -> list[float]:
    """The time of each block, as a fraction of the exposure: the middle of its samples' share."""
    ends = np.cumsum([0, *(len(block) for block in sample_blocks(samples, moments))]) / samples
    return ((ends[1:] + ends[:-1]) / 2).tolist()


class Summed(NamedTuple):
    """A frame whose arrays that are means are sums of as many samples; one sample is a sum, too."""

    frame: Frame
    samples: int = 1


def mean_frame(added: Iterable[Summed]) -> Frame:
    """The mean frame: arrays that are means are averaged; depth, position and indices come from the nearest sample;
    times are added up; what could not be read is that of all; other statistics come from the last frame.

    Only one sum and one frame are held at a time, in float32: after a thousand frames rounding is about 1e-6.
    """
    count, sums, nearest, matte, milliseconds, passes, unread, stats = 0, {}, {}, None, 0.0, {}, {}, {}
    for frame, samples in added:
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
        unread |= dict.fromkeys(frame.stats.get("unread", ()))
        odd = max(stats.get("pixels_not_finite", 0), frame.stats["pixels_not_finite"])
        count, stats = count + samples, {**frame.stats, "pixels_not_finite": odd}
    stats = {**stats, "milliseconds": milliseconds, "passes": passes, "unread": tuple(unread), "samples": count}
    means = {name: total / np.float32(count) for name, total in sums.items()}
    arrays = means | nearest | {"cryptomatte": matte and matte.over(count)}
    return Frame(**{name: arrays.get(name) for name in OUTPUTS}, stats=stats)


def _nearer(kept: dict[str, np.ndarray], arrays: dict[str, np.ndarray]) -> dict[str, np.ndarray]:
    """Per pixel, the values of the set with the smaller depth."""
    if not kept:
        return arrays
    if "depth" not in arrays:
        return {}
    is_nearer = arrays["depth"] < kept["depth"]
    return {
        name: np.where(is_nearer[..., None] if values.ndim == 3 else is_nearer, values, kept[name])
        for name, values in arrays.items()
    }


def _moved(camera: Camera, x: float, y: float) -> tuple[float, float, float, float]:
    """The camera's window shifted by pixels."""
    left, right, bottom, top = camera.window
    dx, dy = x * (right - left) / camera.size[0], y * (top - bottom) / camera.size[1]
    return left + dx, right + dx, bottom + dy, top + dy


def _through(camera: Camera, place: np.ndarray) -> Camera:
    """The camera at a point on its lens, with the window shifted so that the focus plane stays fixed."""
    left, right, bottom, top = camera.window
    dx, dy = place / camera.lens.focus_distance
    matrix = camera.matrix_world.copy()
    matrix[:3, 3] += matrix[:3, :2] @ place
    return replace(camera, matrix_world=matrix, window=(left - dx, right - dx, bottom - dy, top - dy), lens=None)
