# SPDX-License-Identifier: GPL-3.0-or-later
"""Keeps the surfels of a file's meshes between frames."""

from __future__ import annotations

from collections.abc import Collection
from typing import NamedTuple

import numpy as np

from ...rendering.detail.hierarchies import replaced
from ...surfels import Surfels
from ..conversion.changed_sources import ChangedSources
from ..geometry.derived import Derived
from ..geometry.offsets import Points
from ..geometry.stored_surfels import Stored, have_same_values, read_beside, read_stored
from ..materials.surface_textures import TextureStore
from .scan_colors import Column
from .streams import Streams
from .world import WorldStore


class Kept(NamedTuple):
    """A mesh as it was read."""

    name: str
    surfels: Surfels
    skipped: int
    strayed: int


def tell_replaced(before: list[Kept], kept: Kept) -> None:
    """Tell the renderer what a mesh's surfels were in the frame before."""
    if before and all(kept.surfels is not old.surfels for old in before):
        replaced(before[-1].surfels, kept.surfels)


class SurfelStore:
    """Keeps the `Surfels` of meshes between frames: the same object as long as the values are unchanged.

    Device data is cached by that identity. The values of what is read again are compared: reading and comparing a
    million surfels takes a tenth of the time of packing and uploading them.

    A mesh is identified by its session_uid: objects that share a mesh but differ in modifiers have evaluated meshes of
    the same name, and each evaluation by modifiers makes a new mesh of the same name.
    """

    def __init__(self):
        self.world = WorldStore()
        self.textures = TextureStore()
        self.derived = Derived()
        self.changed_sources = ChangedSources()
        self.streams = Streams()
        self._kept: dict[int, Kept] = {}
        self._current: set[int] = set()
        self._followed: dict = {}
        self._columns: dict[tuple[int, str], Column | None] = {}

    def get(self, points: Points, key: int, name: str, offset: np.ndarray, is_solid: bool = False) -> Stored:
        """The result of `read_stored`; read once per mesh and frame. There may be no surfels yet.

        key: session_uid of the mesh or point cloud, or of the mesh that the points were made beside.
        name: identifies it in the next evaluation. offset: of the mesh in the .blend.
        """
        if key not in self._current or self._kept[key].name != name:
            surfels, skipped, strayed = read_stored(points, self._followed, name, is_solid, offset)
            before = [kept for kept in self._kept.values() if kept.name == name]
            same = next((k.surfels for k in before if have_same_values(k.surfels, surfels)), surfels)
            self._kept[key] = Kept(name, same, skipped, strayed)
            tell_replaced(before, self._kept[key])
            self._current.add(key)
        kept = self._kept[key]
        return Stored(kept.surfels, kept.skipped, kept.strayed)

    def column(self, points: Points, key: int, attribute: str, skipped: int) -> Column | None:
        """An attribute of the surfels that `get` gave for this key, read once per mesh and frame; empty until all of
        these are there."""
        if key not in self._current:
            return Column(np.zeros(0, np.float32), 0)
        if (key, attribute) not in self._columns:
            values = read_beside(points, attribute, skipped)
            self._columns[key, attribute] = None if values is None else Column.of(values)
        return self._columns[key, attribute]

    def begin_frame(
        self,
        changed: Collection[str] | None = None,
        are_materials_edited: bool = False,
        is_sky_edited: bool = False,
        are_strokes_told: bool = True,
    ) -> None:
        """Start a frame: meshes named in `changed` (None: all) are read again when next requested.

        are_materials_edited: whether materials or their images may have been edited. is_sky_edited: the same of the
            world's. are_strokes_told: whether the former includes pixels that were painted, as in a viewport.
        """
        self.world.begin_frame(is_sky_edited)
        self.derived.begin_frame()
        self.changed_sources.begin_frame(changed is None or bool(changed))
        self.streams.begin_frame()
        self.textures.begin_frame(are_materials_edited, is_told=changed is not None and are_strokes_told)
        self._current = {k for k in self._current if changed is not None and self._kept[k].name not in changed}
        self._columns = {key: column for key, column in self._columns.items() if key[0] in self._current}

    def forget_unused(self) -> None:
        """Drop meshes and close files that this frame did not request."""
        self.streams.forget_unused()
        self._kept = {key: kept for key, kept in self._kept.items() if key in self._current}
        names = {kept.name for kept in self._kept.values()}
        self._followed = {name: before for name, before in self._followed.items() if name in names}
