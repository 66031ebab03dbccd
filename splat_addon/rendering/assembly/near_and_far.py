# SPDX-License-Identifier: GPL-3.0-or-later
"""Takes what lies or reaches far beyond everything else apart, for one view: strays become instances of their own, and
far-reaching triangles pieces that a device can draw. What is left can be placed exactly, and depths and shadow maps
are fitted to it.
"""

from __future__ import annotations

from dataclasses import replace
from weakref import WeakKeyDictionary

import numpy as np

from ..scene import Instance, Placed, PolygonInstance, Scene
from ..scene.camera import Camera
from ..scene.far_reaching import least_length, pieces, reaching
from ..scene.polygons import Polygons
from ..scene.strays import without_strays
from ..scene.table import InstanceTable

#: Views whose scenes are kept: the faces of a panorama, and their next ones.
_VIEWS = 12


class NearAndFar:
    """The scenes for the views that one renderer draws: the same objects as long as a view stays."""

    def __init__(self):
        self._of_scene: tuple[Scene, list[Placed]] | None = None
        self._scenes: dict[tuple, tuple[Scene, Scene]] = {}
        self._apart: WeakKeyDictionary = WeakKeyDictionary()
        self._near: WeakKeyDictionary = WeakKeyDictionary()

    def resolved(self, scene: Scene, camera: Camera) -> Scene:
        """The scene for a view: the same object if nothing is far in it."""
        table = scene.table
        if self._of_scene is None or self._of_scene[0] is not scene:
            stray = table.taken(table.of_kinds(lambda placed: len(self._parts(placed)) > 1))
            self._of_scene = scene, list(stray.placed)
        least, (_, stray) = least_length(camera), self._of_scene
        reach = [table.placed[row] for row in _long(table, least).tolist()]
        if not (reach or stray):
            return scene
        key = id(scene), camera.matrix_world.tobytes(), camera.near, camera.is_orthographic, least
        if key not in self._scenes:
            parts = {each: self._taken_apart(each, camera, each in reach) for each in {*reach, *stray}}
            is_same = all(own == (each,) for each, own in parts.items())
            kinds = {
                name: tuple(part for each in getattr(scene, name) for part in parts.get(each, (each,)))
                for name in ("surfels", "polygons")
            }
            self._scenes = dict([*self._scenes.items()][1 - _VIEWS :])
            # the scene is kept too, as its id must stay its own
            self._scenes[key] = scene, scene if is_same else replace(scene, **kinds)
        return self._scenes[key][1]

    def _taken_apart(self, placed: Placed, camera: Camera, may_reach: bool) -> tuple[Placed, ...]:
        rows = reaching(placed, camera) if may_reach else ()
        if not len(rows):
            return self._of(placed)
        far = replace(placed, shape=pieces(placed, camera, rows), reaches=True)
        near = replace(placed, shape=self._others(placed, rows))
        near_parts = self._of(near) if len(near.shape) else ()
        return (*near_parts, far) if len(far.shape) else near_parts  # triangles without area have no pieces

    def _of(self, placed: Placed) -> tuple[Placed, ...]:
        parts = self._parts(placed)
        return tuple(replace(placed, shape=part) for part in parts) if len(parts) > 1 else (placed,)

    def _parts(self, placed: Placed) -> tuple:
        """The shape of an instance without strays, and these; streamed surfels lie together in any case."""
        if isinstance(placed, Instance) and (placed.is_cut or placed.stream is not None):
            return (placed.shape,)
        if placed.shape not in self._apart:
            parts = without_strays(placed.shape)
            # the shape itself would keep itself in memory
            self._apart[placed.shape] = parts if len(parts) > 1 else ()
        return self._apart[placed.shape] or (placed.shape,)

    def _others(self, placed: PolygonInstance, rows: np.ndarray):
        """The other triangles, which stay on the device while the same ones reach far."""
        of_shape = self._near.setdefault(placed.shape, {})
        key = rows.tobytes()
        if key not in of_shape:
            is_near = np.ones(placed.shape.triangles, bool)
            is_near[rows] = False
            of_shape.clear()
            of_shape[key] = placed.shape.take(np.repeat(is_near, 3))
        return of_shape[key]


def _long(table: InstanceTable, least: float) -> np.ndarray:
    """(k,) rows of instances that may have a triangle longer than this, world units, and are not flattened."""
    longest = np.array([shape.longest_edge if isinstance(shape, Polygons) else 0.0 for shape in table.shapes])
    if not longest.any():
        return np.zeros(0, np.int64)
    return np.flatnonzero((table.stretches * longest[table.shape_of] > least) & ~table.are_flattened)
