# SPDX-License-Identifier: GPL-3.0-or-later
"""Where shadow maps lie in their atlas, and the data with which shaders look them up."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from ..scene.camera import Camera
from ..scene.table import InstanceTable
from ..view import View


@dataclass(frozen=True, eq=False)
class ShadowMap:
    """light: number in the scene. camera: the light's view. place: (x, y) of the map in the atlas, in texels.

    is_face: whether it is one face of a cube around a light, and continues in the adjacent faces.
    is_smaller: whether it has fewer texels than the settings say, because these are far smaller than pixels.
    used: x, y, width and height of the part that is drawn, which holds all that the picture looks up.
    casters: the instances that may block the light on its way to what is seen. around: all instances that cast shadows.
    """

    light: int
    camera: Camera
    place: tuple[int, int]
    is_face: bool
    is_smaller: bool
    used: tuple[int, int, int, int]
    casters: InstanceTable
    around: InstanceTable

    @property
    def drawn(self) -> Camera:
        """The light's view of the part that is drawn."""
        return self.camera if self.used == (0, 0, *self.camera.size) else self.camera.cropped(*self.used)

    @property
    def viewport(self) -> tuple[int, int, int, int]:
        """That part in the atlas."""
        return self.place[0] + self.used[0], self.place[1] + self.used[1], *self.used[2:]


def placed_in_atlas(maps: list[ShadowMap]) -> tuple[ShadowMap, ...]:
    """The maps at their places in the atlas: in rows, the largest first."""
    sides = [made.camera.size[0] for made in maps]
    order = sorted(range(len(maps)), key=lambda k: -sides[k])
    least, most = min(sides, default=1), max(sides, default=0)
    across = max(atlas_columns(sum(side * side for side in sides) / least**2) * least, most)
    places, x, y, height = {}, 0, 0, 0
    for k in order:
        side = maps[k].camera.size[0]
        if x + side > across:
            x, y, height = 0, y + height, 0
        places[k] = x, y
        x, height = x + side, max(height, side)
    return tuple(replace(made, place=places[k]) for k, made in enumerate(maps))


def atlas_columns(maps: float) -> int:
    """Maps of one size side by side in the atlas."""
    return max(math.ceil(math.sqrt(maps)), 1)


def atlas_size(maps: tuple[ShadowMap, ...]) -> tuple[int, int]:
    """Width and height in texels."""
    return tuple(max(m.place[k] + m.camera.size[k] for m in maps) for k in (0, 1))


def pack_shadow_maps(maps, views: tuple[View, ...], camera: Camera, scale: float) -> np.ndarray:
    """(M, 18, 4) float32. views: of `view.build_view`, one for each map. camera, scale: of the picture that is shaded.

    Rows of the map from its view space to the light's (3 texels) | window's left, bottom, 1 / width, 1 / height |
    place in the atlas, resolution, 1 for a parallel camera | depth = x stored + y, texel's size (at depth 1 of a
    perspective), 1 for a face of a cube | of such a one the faces to the left, right, below and above, each as rows
    from its view to theirs, with place in the atlas and the factor of depths (3 texels; a factor of 0 for none).
    """
    texels = np.zeros((len(maps), 18, 4))
    for row, made, view in zip(texels, maps, views, strict=True):
        light, rotation = made.camera, made.camera.matrix_world[:3, :3].T
        row[:3, :3] = rotation @ camera.matrix_world[:3, :3] * (view.scale / scale)
        row[:3, 3] = rotation @ (camera.matrix_world[:3, 3] - light.matrix_world[:3, 3]) * view.scale
        left, right, bottom, top = (v * (view.scale if light.is_orthographic else 1.0) for v in light.window)
        row[3] = left, bottom, 1 / (right - left), 1 / (top - bottom)
        row[4] = *made.place, light.size[0], light.is_orthographic
        near, far = (view.first, view.far) if light.is_orthographic else (0.0, view.far)
        row[5] = far - near, near, max(right - left, top - bottom) / light.size[0], made.is_face
        if made.is_face:
            row[6:] = _beside(made, maps, [v.far * view.scale / v.scale for v in views])
    return texels.astype(np.float32)


def _beside(made: ShadowMap, maps, depths) -> np.ndarray:
    """(12, 4) of a cube's face: see `pack_shadow_maps`. depths: the factor of each map, in the scale of this one."""
    texels = np.zeros((4, 3, 4))
    own = made.camera.matrix_world[:3, :3]
    for other, depth in zip(maps, depths, strict=True):
        if other.light != made.light:
            continue
        turn = other.camera.matrix_world[:3, :3].T @ own
        sides = turn[2] @ np.array([(1, -1, 0, 0), (0, 0, 1, -1), (0, 0, 0, 0)])
        if sides.max() > 0.5:
            texels[sides.argmax(), :, :3] = turn
            texels[sides.argmax(), :, 3] = *other.place, depth
    return texels.reshape(12, 4)


def map_ranges(maps: tuple[ShadowMap, ...], lights: int) -> np.ndarray:
    """(lights, 2) the first map of each light, and the number of its maps."""
    owners = np.array([m.light for m in maps], int)
    counts = np.bincount(owners, minlength=lights)
    return np.stack([np.concatenate([[0], np.cumsum(counts)[:-1]]), counts], axis=1)
