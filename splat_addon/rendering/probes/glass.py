# SPDX-License-Identifier: GPL-3.0-or-later
"""What stands behind glass, as a picture, and the surfaces of glass, through which light is followed to it."""

from __future__ import annotations

from dataclasses import replace
from weakref import WeakKeyDictionary

import numpy as np

from ..frame import Frame
from ..scene import Placed, Scene
from ..scene.camera import Camera
from ..scene.glass_surfaces import GlassSurfaces
from ..scene.material import Material
from ..scene.table import InstanceTable
from .flat_pictures import picture_texels

#: Beside the frame's picture, a share of it, in which bent rays may end.
BESIDE = 0.125
#: Pixels along an edge of what is seen behind glass.
MOST_PIXELS = 4096


def is_glass(material: Material) -> bool:
    """Whether it lets light through as glass does."""
    return material.finish.transmission > 0 and material.metallic < 1


def has_glass(placed: Placed) -> bool:
    """Whether any of an object's materials is glass."""
    return not placed.is_holdout and any(map(is_glass, placed.materials))


def glass_slots(placed: Placed) -> np.ndarray:
    """(n,) bool: which surfels or corners of an object are of glass."""
    slots = np.array([is_glass(material) for material in placed.materials])
    return slots[np.minimum(placed.shape.materials, len(slots) - 1)]


class WithoutGlass:
    """Scenes without what is of glass, which only casts its shadow; shapes of which a part is glass are kept."""

    def __init__(self):
        self._rest: WeakKeyDictionary = WeakKeyDictionary()

    def of(self, scene: Scene) -> Scene:
        """The scene without glass: the same object if it has none."""
        if not any(has_glass(kind.placed) for kind in scene.table.kinds):
            return scene
        return replace(scene, surfels=self._parted(scene.surfels), polygons=self._parted(scene.polygons))

    def _parted(self, placed: tuple[Placed, ...]) -> tuple[Placed, ...]:
        made = []
        for one in placed:
            if not (one.is_seen and has_glass(one)):
                made.append(one)
                continue
            made.append(replace(one, is_seen=False))
            if (rest := self._shape(one)) is not None:
                made.append(replace(one, shape=rest, casts_shadow=False))
        return tuple(made)

    def _shape(self, placed: Placed):
        """What of a shape is not glass; None for nothing."""
        slots, known = tuple(map(is_glass, placed.materials)), self._rest.setdefault(placed.shape, {})
        if slots not in known:
            rows = np.flatnonzero(~glass_slots(placed))
            known[slots] = placed.shape.take(rows) if len(rows) else None
        return known[slots]


def behind_camera(camera: Camera) -> Camera:
    """The camera with a window that is larger by `BESIDE`."""
    left, right, bottom, top = camera.whole_pixels()
    beside = [int(np.ceil(edge * BESIDE)) for edge in camera.size]
    across, up = (right - left) / camera.size[0] * beside[0], (top - bottom) / camera.size[1] * beside[1]
    size = tuple(edge + 2 * more for edge, more in zip(camera.size, beside, strict=True))
    scale = min(MOST_PIXELS / max(size), 1.0)
    size = tuple(max(int(np.ceil(edge * scale)), 1) for edge in size)
    window = left - across, right + across, bottom - up, top + up
    made = Camera(camera.matrix_world, window, size, camera.near, camera.far)
    return replace(made, is_orthographic=camera.is_orthographic)


class GlassPicture:
    """What is seen behind glass, and the glass itself. seen: by the camera, without glass."""

    def __init__(self, surfaces: GlassSurfaces, camera: Camera, seen: Frame):
        self.surfaces, self.window, self.size, self._seen = surfaces, camera.window, camera.size, seen

    def behind(self) -> np.ndarray:
        """(h, w, 4) float32, as of `picture_texels`."""
        return picture_texels(self._seen.color, self._seen.depth)


def surfaces_of(table: InstanceTable) -> GlassSurfaces:
    """The glass of a scene."""
    rows = np.flatnonzero(table.of_kinds(lambda placed: placed.is_seen) & table.of_kinds(has_glass))
    return GlassSurfaces.of([(table.placed[row], glass_slots(table.placed[row])) for row in rows.tolist()])
