# SPDX-License-Identifier: GPL-3.0-or-later
"""The sums of a picture's samples on the device: one picture is read back, whatever the number of samples."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from .features.sample_sum import NEAREST, NEAREST_KEY, ODD, SUMS, added_up
from .frame import EMPTY_DEPTH, HELD_BY
from .plan.frame_plan import FramePlan
from .plan.tile import texture_key
from .read_back import read_arrays
from .scene.camera import Camera
from .scene.panorama import Panorama
from .settings import NEAREST as OF_NEAREST
from .settings import Settings

if TYPE_CHECKING:
    from .device.interface import Texture as DeviceTexture
    from .plan.graph import Texture
    from .upload.resources import Resources

#: Outputs that are not made of sums and nearest depths.
_APART = {"cryptomatte", *OF_NEAREST} - {"depth"}

#: Sums of larger pictures, with 44 bytes a pixel or more, would take much of a device's memory: 3840 x 2160.
_MOST_PIXELS = 1 << 23


def may_add_up(camera: Camera | Panorama, size: tuple[int, int], settings: Settings) -> bool:
    """Whether samples of a picture of this size can be added up on the device: faces of a panorama are resampled, and
    objects are told apart by the numbers of each sample."""
    return isinstance(camera, Camera) and size[0] * size[1] <= _MOST_PIXELS and _APART.isdisjoint(settings.outputs)


class SampleSums:
    """Sums that stay on the device while other pictures are drawn there, until `end`."""

    def __init__(self, resources: Resources):
        self._resources = resources

    def begin(self, plan: FramePlan) -> None:
        """Empty the sums of what this plan draws."""
        sums = [texture for texture in (*SUMS.values(), ODD) if texture.name in plan.filled]
        nearest = [texture for texture in (NEAREST, NEAREST_KEY) if texture.name in plan.filled]
        self._resources.held = {_key(texture, plan) for texture in (*sums, *nearest)}
        device = self._resources.device
        if sums:
            device.target([self._texture(texture, plan) for texture in sums]).clear(color=0.0)
        if nearest:
            depth, key = (self._texture(texture, plan) for texture in nearest)
            device.target([depth], key).clear(color=EMPTY_DEPTH, depth=1.0)

    def end(self) -> None:
        """Let the next picture take their place."""
        self._resources.held = frozenset()

    def shown(self, plan: FramePlan) -> DeviceTexture:
        """The sum of colours."""
        return self._texture(SUMS["combined"], plan)

    def read(self, plan: FramePlan, settings: Settings) -> tuple[dict[str, np.ndarray], int]:
        """The arrays of these outputs, sums and nearest depths, and the number of pixels with a number that was not
        added."""
        held = {**SUMS, "depth": NEAREST}
        texels = {name: self._read(held[name], plan) for name in plan.find(added_up)}
        places = {name: HELD_BY[name] for name in read_arrays(settings.outputs)}
        arrays = {name: np.ascontiguousarray(texels[texture][..., where]) for name, (texture, where) in places.items()}
        return arrays, int(np.count_nonzero(self._read(ODD, plan))) if ODD.name in plan.filled else 0

    def _read(self, texture: Texture, plan: FramePlan) -> np.ndarray:
        return self._resources.device.target([self._texture(texture, plan)]).read(0)

    def _texture(self, texture: Texture, plan: FramePlan) -> DeviceTexture:
        return self._resources.texture(_key(texture, plan))


def _key(texture: Texture, plan: FramePlan):
    return texture_key(texture, plan.tiles[0][2:], plan)
