# SPDX-License-Identifier: GPL-3.0-or-later
"""A flat glossy object shows what a camera behind it sees: the picture's own, mirrored in its plane."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ..frame import Frame
from ..scene import Scene
from ..scene.camera import Camera
from .flat_pictures import picture_texels
from .places import FLATTEST, boxes, glossy

#: What lies this share of its length beside the plane still belongs to a mirror, for rounding.
_BESIDE = 1e-3
#: Pixels along an edge of a mirror's picture.
_MOST_PIXELS = 1024


@dataclass(frozen=True)
class Mirror:
    """normal: (3,) of its plane, towards the camera, world. middle: (3,) on the plane. axes: (3, 3) rows, half-axes of
    the box of what uses it. left_out: rows of the scene's table that its picture lacks."""

    normal: tuple[float, ...]
    middle: tuple[float, ...]
    axes: tuple[tuple[float, ...], ...]
    left_out: tuple[int, ...]


def mirror_of(scene: Scene, camera: Camera, around: tuple[Camera, ...] = ()) -> tuple[Mirror | None, int]:
    """The largest flat glossy object that the camera or those around it may see, and the number of others. None if it
    is not the camera that may see it.

    around: the cameras of a panorama's faces, which all have the same mirror, so that their borders do not show.
    """
    table = scene.table
    are_glossy = glossy(table)
    if not are_glossy.any():
        return None, 0
    corners, (middles, axes) = table.world_corners, boxes(table)
    lengths = np.sort(np.linalg.norm(axes, axis=2), axis=1)
    are_flat = (lengths[:, 0] <= FLATTEST * lengths[:, 2]) & (lengths[:, 1] > FLATTEST * lengths[:, 2])
    rows = [
        row
        for row in np.flatnonzero(are_glossy & are_flat)
        if any(_may_see(one, corners[row]) for one in (camera, *around))
    ]
    if not rows:
        return None, 0
    row = max(rows, key=lambda row: lengths[row, 1] * lengths[row, 2])
    if not _may_see(camera, corners[row]):
        return None, len(rows) - 1
    return _mirror(table, row, middles[row], axes[row], camera), len(rows) - 1


def _mirror(table, row: int, middle: np.ndarray, axes: np.ndarray, camera: Camera) -> Mirror | None:
    """None if the camera lies in the plane. What lies behind the plane is left out."""
    lengths = np.linalg.norm(axes, axis=1)
    thin = int(lengths.argmin())
    normal = np.cross(axes[(thin + 1) % 3], axes[(thin + 2) % 3])
    normal /= np.linalg.norm(normal)
    away = camera.matrix_world[:3, 2] if camera.is_orthographic else camera.matrix_world[:3, 3] - middle
    if away @ normal < 0:
        normal = -normal
    height, beside = abs(axes[thin] @ normal), _BESIDE * lengths.max()
    middle = middle + height * normal
    if not away @ normal > height:
        return None
    box = axes.copy()
    box[thin] = (height + beside) * normal
    heights = (table.world_corners - middle) @ normal
    behind = np.flatnonzero((heights <= beside).all(axis=1)).tolist()
    as_tuples = tuple(tuple(axis) for axis in box.tolist())
    return Mirror(tuple(normal.tolist()), tuple(middle.tolist()), as_tuples, tuple({*behind, int(row)}))


def _may_see(camera: Camera, corners: np.ndarray) -> bool:
    """Whether any of a box of (8, 3) corners may be in the picture."""
    to_view = camera.world_to_view()
    view = corners @ to_view[:3, :3].T + to_view[:3, 3]
    if camera.is_orthographic or (view[:, 2] < 0).all():
        left, right, bottom, top = camera.window
        places = view[:, :2] / (1.0 if camera.is_orthographic else -view[:, 2:])
        low, high = places.min(axis=0), places.max(axis=0)
        return bool(low[0] < right and high[0] > left and low[1] < top and high[1] > bottom)
    return bool((view[:, 2] < 0).any())


def mirrored_camera(mirror: Mirror, camera: Camera) -> Camera:
    """The camera in the plane's mirror, whose picture is turned from left to right."""
    normal, matrix = np.array(mirror.normal), np.array(camera.matrix_world, np.float64)
    matrix[:3, :3] -= 2 * np.outer(normal, normal @ matrix[:3, :3])
    matrix[:3, 3] -= 2 * normal * (normal @ (matrix[:3, 3] - mirror.middle))
    matrix[:3, 0] *= -1
    left, right, bottom, top = camera.whole_pixels()
    scale = min(_MOST_PIXELS / max(camera.size), 1.0)
    size = tuple(max(int(np.ceil(edge * scale)), 1) for edge in camera.size)
    window = (-right, -left, bottom, top)
    return replace(Camera(matrix, window, size, camera.near, camera.far), is_orthographic=camera.is_orthographic)


class MirrorPicture:
    """What a mirror shows. seen: by its camera."""

    def __init__(self, mirror: Mirror, camera: Camera, seen: Frame):
        self.mirror, self.window, self.size, self._seen = mirror, camera.window, camera.size, seen

    def texels(self) -> np.ndarray:
        """(h, w, 4) float32, as of `picture_texels`."""
        return picture_texels(self._seen.color, self._seen.depth)
