# SPDX-License-Identifier: GPL-3.0-or-later
"""What a probe sees, as shaders read it: a texture with the picture of each, sharp and blurred.

Sources: Szirmay-Kalos et al. 2005, "Approximate Ray-Tracing on the GPU with Distance Impostors" (distances beside
colours); Karis 2013, "Real Shading in Unreal Engine 4" (pictures blurred by the lobe).
"""

from __future__ import annotations

from functools import cache

import numpy as np

from ..frame import EMPTY_DEPTH, Frame
from ..scene.camera import Camera
from ..scene.environment import reflected_lobe
from ..scene.octahedral import bordered, octahedral_directions
from .places import Probe

#: Texels along the side of a picture of what reflects sharply and is large, of what reflects sharply, and of what does
#: not.
LARGE_SIDE, SHARP_SIDE, BLUNT_SIDE = 512, 256, 128
#: From this roughness on, the next smaller picture has enough.
SHARP_ROUGHNESS, BLUNT_ROUGHNESS = 0.06, 0.12
#: From so many pixels on, a thing is large: in the middle of a mirror ball that wide, texels are as large as pixels.
LARGE = 288
#: Each of these maps has half the texels along its side.
MAPS = 5
#: Roughness of pictures that are blurred by the lobe; below the first, the maps are looked up.
LEVELS = (0.4, 0.6, 0.8, 1.0)
LEVEL_SIDE = 32
#: Texels of the first row for each probe: rows of the map from the scene to its box, and its middle.
HEADER = 4


def side_of(probes: tuple[Probe, ...], camera: Camera) -> int:
    """Texels along the side of the sharp picture of each, for a camera."""
    if any(probe.roughness < SHARP_ROUGHNESS and probe.pixels(camera) > LARGE for probe in probes):
        return LARGE_SIDE
    return SHARP_SIDE if min(probe.roughness for probe in probes) < BLUNT_ROUGHNESS else BLUNT_SIDE


def probe_size(side: int) -> tuple[int, int]:
    """Width and height of the texels of one probe."""
    return (side + 2) + (side // 2 + 2), (side + 2) + (LEVEL_SIDE + 2)


class ProbePictures:
    """The pictures of a scene's probes. frames: of each, an octahedral map with its border. origin: (3,) float64, what
    places are relative to."""

    def __init__(self, probes: tuple[Probe, ...], frames: list[Frame]):
        self.origin, self.side = np.array(probes[0].middle), len(frames[0].color) - 2
        self.probes, self._frames = probes, frames

    def texels(self) -> np.ndarray:
        """(h, w, 4) float32: a row about the probes, and below one another what each sees."""
        width, height = probe_size(self.side)
        made = np.zeros((1 + height * len(self.probes), width, 4), np.float32)
        for number, (probe, frame) in enumerate(zip(self.probes, self._frames, strict=True)):
            made[0, HEADER * number : HEADER * (number + 1)] = _header(probe, self.origin)
            _fill(made[1 + height * number :][:height], frame, self.side)
        return made


def _header(probe: Probe, origin: np.ndarray) -> np.ndarray:
    to_box = np.linalg.inv(np.array(probe.axes)).T
    middle = np.array(probe.middle) - origin
    rows = np.concatenate([to_box, (-to_box @ middle)[:, None]], axis=1)
    return np.concatenate([rows, [[*middle, 0.0]]])


def _fill(made: np.ndarray, frame: Frame, side: int) -> None:
    """Write the maps: the sharp one has the inverse of the distance where others have their opacity."""
    color, distance = frame.color, frame.depth
    covered = (color[..., 3:] > 0.5) & (distance < EMPTY_DEPTH)[..., None]
    sharp = np.where(covered, color / np.maximum(color[..., 3:], 1e-6), 0.0)
    sharp[..., 3] = np.where(covered[..., 0], 1 / np.maximum(distance, 1e-30), 0.0)
    made[: side + 2, : side + 2] = sharp
    inner, left, low = color[1:-1, 1:-1], side + 2, 0
    for number in range(1, MAPS):
        inner = inner.reshape(len(inner) // 2, 2, -1, 2, 4).mean(axis=(1, 3))
        edge = len(inner) + 2
        made[low : low + edge, left : left + edge] = bordered(inner)
        low, left = (edge, left) if number == 1 else (low, left + edge)
    while len(color) - 2 > LEVEL_SIDE:
        color = bordered(color[1:-1, 1:-1].reshape((len(color) - 2) // 2, 2, -1, 2, 4).mean(axis=(1, 3)))
    seen = color[1:-1, 1:-1].reshape(-1, 4)
    for number, weights in enumerate(_lobes()):
        level = bordered((weights @ seen).reshape(LEVEL_SIDE, LEVEL_SIDE, 4))
        made[side + 2 :, number * (LEVEL_SIDE + 2) :][:, : LEVEL_SIDE + 2] = level


@cache
def _lobes() -> list[np.ndarray]:
    """For each level (n, n) float32, the weights of the texels of a map of this size in those of the level."""
    ticks = (np.arange(LEVEL_SIDE) + 0.5) / LEVEL_SIDE * 2 - 1
    x, y = np.meshgrid(ticks, ticks)
    directions = octahedral_directions(x, y).reshape(-1, 3).astype(np.float32)
    # the map stretches directions by the cube of their length on its octahedron
    share = np.abs(directions).sum(axis=1) ** 3
    cosines = directions @ directions.T
    lit = np.maximum(cosines, 0) * share
    found = [lit * reflected_lobe(cosines, roughness) for roughness in LEVELS]
    return [weights / weights.sum(axis=1, keepdims=True) for weights in found]
