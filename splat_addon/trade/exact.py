# SPDX-License-Identifier: GPL-3.0-or-later
"""The picture that a scene's pictures come closer to with more samples, under both pixel filters.

Quads without merged surfels, with many samples at other places each: those of the box lie in one pixel, those of the
Gaussian where it is high (importance sampling).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace

import numpy as np

from ..differences import psnr
from ..rendering import Camera, RenderCancelled, Renderer, Scene, Settings
from ..rendering.assembly.accumulation import pixel_offset, sample_camera

#: Samples along each side of a pixel of each picture.
_BOX_EDGE, _GAUSSIAN_EDGE = 4, 2

#: Variance of the places of pictures, square pixels: that of the Gaussian pixel without that of the samples of each
#: picture, which are a grid.
_GAUSSIAN = Settings.filter_variance - (1 - 1 / _GAUSSIAN_EDGE**2) / 12

#: Told the finished share; returns False to cancel.
Told = Callable[[float], bool | None]


def nobody(share: float) -> None:
    """Is told of the progress where nobody asks."""


@dataclass(frozen=True, eq=False)
class ExactPictures:
    """colors: filter -> (h, w, 4) scene-linear. converged: filter -> dB that they are estimated to be exact to."""

    colors: dict[str, np.ndarray]
    converged: dict[str, float]

    @classmethod
    def drawn(
        cls,
        renderer: Renderer,
        scene: Scene,
        camera: Camera,
        settings: Settings,
        pictures: int = 32,
        told: Told = nobody,
    ) -> ExactPictures:
        """Draw them. pictures: the number for the Gaussian, a multiple of 8; the box has a quarter of it. Raises
        `RenderCancelled`, and ValueError for a camera that is a panorama or for too few pictures."""
        if not isinstance(camera, Camera):
            raise ValueError("A panorama has no exact picture to compare with: choose another camera.")
        if pictures < 8 or pictures % 8:
            raise ValueError(f"The number of exact pictures must be a multiple of 8, not {pictures}.")
        whole = replace(settings, **_EXACT, layers=max(settings.layers, 8), shadow_resolution=_texels(settings))
        counts = {"box": pictures // 4, "gaussian": pictures}
        total, done, sums = sum(counts.values()), 0, {}
        for name, count in counts.items():
            edge = _BOX_EDGE if name == "box" else _GAUSSIAN_EDGE
            halves = [0.0, 0.0]
            for number, moved in enumerate(_cameras(camera, name, count)):
                if told(done / total) is False:
                    raise RenderCancelled
                color = renderer.render(scene, moved, replace(whole, supersampling=edge), is_repeatable=True).color
                # one half has the first of each pair of places, the other the second
                half = number % 2
                halves[half] = halves[half] + color.astype(np.float64) * (2 / count)
                done += 1
            sums[name] = halves
        # the mean of two halves that err independently is half as far off as they are apart
        converged = {name: psnr(*halves) + 20 * math.log10(2) for name, halves in sums.items()}
        return cls({name: ((a + b) / 2).astype(np.float32) for name, (a, b) in sums.items()}, converged)


#: What the exact picture is drawn with.
_EXACT = {
    "method": "quad",
    "samples": 1,
    "detail_tolerance": 0.0,
    "storage": "float32",
    "sum_format": "float32",
    "as_printed": False,
    "edge_threshold": 0.0,
    "multisampling": 0,
    "sample_shading": False,
    "outputs": ("color",),
    "profile": False,
}


def _texels(settings: Settings) -> int:
    """Shadows as set stay without shadows, and others are as sharp as can be."""
    return settings.shadow_resolution and 2048


def _cameras(camera: Camera, name: str, count: int) -> Iterator[Camera]:
    """The cameras of the pictures of one filter."""
    left, right, bottom, top = camera.window
    steps = (right - left) / camera.size[0], (top - bottom) / camera.size[1]
    offsets = _places(name, count)
    for number, offset in enumerate(offsets):
        moved = sample_camera(camera, number, count)
        # from the place in the pixel that a picture's samples have, to the one that is wanted
        dx, dy = (offset - pixel_offset(number, count)) * steps
        a, b, c, d = moved.window
        yield moved.with_values(window=(a + dx, b + dx, c + dy, d + dy), sample_variance=0.0)


def _places(name: str, count: int) -> np.ndarray:
    """(count, 2) places in pixels, from the pixel's middle, with the mean 0."""
    even = np.array([pixel_offset(number, count) for number in range(count)])
    if name == "box":
        # the samples of each picture are a grid, whose cells they fill together
        return even / _BOX_EDGE
    # Box and Muller 1958; the second of a pair is opposite the first
    first = (even[: count // 2] + 0.5) % 1
    radius = np.sqrt(-2 * np.log1p(-np.clip(first[:, 0], 0, 1 - 1e-6)))
    places = radius[:, None] * np.stack([np.cos(2 * np.pi * first[:, 1]), np.sin(2 * np.pi * first[:, 1])], axis=1)
    # few places would be wider in one direction than in another
    places = places @ np.linalg.inv(np.linalg.cholesky(places.T @ places / len(places))).T * math.sqrt(_GAUSSIAN)
    return np.stack([places, -places], axis=1).reshape(count, 2)
