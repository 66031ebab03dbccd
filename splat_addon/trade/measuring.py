# SPDX-License-Identifier: GPL-3.0-or-later
"""Draws a scene with each choice, in turns, and compares the pictures with the exact ones."""

from __future__ import annotations

import gc
import statistics
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from time import perf_counter

import numpy as np

from ..differences import flip, psnr
from ..rendering import Camera, RenderCancelled, Renderer, Scene, Settings
from .choices import Choice
from .exact import ExactPictures, Told, nobody


@dataclass(frozen=True, eq=False)
class Row:
    """One choice in one scene.

    filter: the pixel filter whose exact picture it is closer to, which `psnr` (dB of sRGB values) and `flip` (mean,
        0 to 1) are compared with; others: the same numbers under the other filter.
    seconds, least: the median and the least time of a picture. bytes: of textures on the device. splats: that were
    drawn in one sample. color: (h, w, 4) the picture. difference: (h, w) its FLIP.
    """

    choice: Choice
    filter: str
    psnr: float
    flip: float
    others: tuple[float, float]
    seconds: float
    least: float
    bytes: int
    splats: int
    color: np.ndarray = field(repr=False)
    difference: np.ndarray = field(repr=False)

    def without_pictures(self) -> Row:
        """The numbers alone, which take no memory."""
        none = np.zeros((0, 0, 4), np.float32)
        return replace(self, color=none, difference=none[..., 0])


def measure(
    renderer: Renderer,
    scene: Scene,
    camera: Camera,
    settings: Settings,
    choices: Sequence[Choice],
    exact: ExactPictures,
    turns: int = 1,
    told: Told = nobody,
    clock: Callable[[], float] = perf_counter,
) -> Iterator[Row]:
    """Yield a row for each choice, once it has been drawn in all turns; an untimed picture comes before them. Raises
    `RenderCancelled`, and as `Renderer.render`."""
    gc.collect()  # textures of renderers that are gone would count as bytes of the first choices
    for number, choice in enumerate(choices):
        wanted, times = choice.of(settings), []
        for turn in range(turns + 1):
            if told((number + turn / (turns + 1)) / len(choices)) is False:
                raise RenderCancelled
            started = clock()
            frame = renderer.render(scene, camera, wanted, is_repeatable=True)
            times.append(clock() - started)
        yield row_of(choice, frame, exact, times[1:])


def row_of(choice: Choice, frame, exact: ExactPictures, times: Sequence[float]) -> Row:
    """The row of a frame. times: seconds of pictures like it."""
    numbers = {}
    for name, color in exact.colors.items():
        difference = flip(frame.color, color)
        numbers[name] = float(difference.mean(dtype=np.float64)), psnr(frame.color, color), difference
    best = min(numbers, key=lambda name: numbers[name][0])
    (other,) = (each for name, each in numbers.items() if name != best)
    return Row(
        choice=choice,
        filter=best,
        flip=numbers[best][0],
        psnr=numbers[best][1],
        others=other[:2],
        seconds=statistics.median(times),
        least=min(times),
        bytes=frame.stats["texture_bytes"],
        splats=frame.stats["splats_drawn"],
        color=frame.color,
        difference=numbers[best][2],
    )
