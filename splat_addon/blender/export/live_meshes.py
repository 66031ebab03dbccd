# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes that are rendered without a conversion: as polygons, or sampled when first seen and followed from frame to
frame.

A mesh is read again when Blender reports that it or one of its materials changed. Unchanged values give the same
`Surfels` or `Polygons` object, by which the renderer recognises data already on the device.
"""

from __future__ import annotations

import math
from collections import Counter
from functools import partial

import bpy

from ...rendering import Instance, PolygonInstance
from ...rendering.detail.hierarchies import replaced
from ...rendering.scene.placements import Placements, joined
from ...sampling import (
    STRETCHED_SHARE,
    have_same_values,
    joined_at_edges,
    predict_count,
)
from ...surfels import Surfels
from ..conversion.animation import is_moving
from ..conversion.camera_density import views_told
from ..conversion.mesh_conversion import MAX_SURFELS, stray_triangles
from ..density import Density
from ..geometry.sources import mesh_key
from ..materials.surface_textures import MAPS
from ..mesh_sampling_settings import Form
from ..meshes.mesh_polygons import left_out_of_polygons, mesh_polygons, needs_surfels
from .changes import Changes
from .live_mesh import LiveMesh
from .live_sampling import deforming_surfels, spacing_for
from .mesh_reading import MeshReading, asked_about, mesh_reading


class LiveMeshes:
    """The meshes of one render or one 3D view.

    counts: about the last frame. "read": meshes that were read. "polygon_meshes" and their "triangles": drawn as
        polygons; "meshes" and their "surfels": sampled meshes. Of the sampled meshes, "sampled" were sampled in this
        frame and "followed" an earlier sampling; "stretched" counts those sampled again because they had stretched too
        far.
    most: surfels of a mesh; it is sampled coarser if there would be more. Without, more than MAX_SURFELS are refused.
    """

    def __init__(self, most: int | None = None):
        self._most = most
        self._kept: dict[tuple, LiveMesh] = {}
        self._names: dict[tuple, tuple] = {}
        self._frame: dict[tuple, LiveMesh] = {}
        self._changes: Changes | None = None
        self._images: dict = {}
        self._views: tuple = ()
        self.counts: Counter = Counter()

    def begin_frame(self, changes: Changes | None = None) -> None:
        """Start a frame. changes: since the one before; None: anything may have changed."""
        self._changes, self._frame, self._names, self.counts = changes, {}, {}, Counter()

    def forget_images(self) -> None:
        """Read textures again after an image or a material was edited."""
        self._images.clear()

    def of(
        self,
        evaluated: bpy.types.Object,
        owner: bpy.types.Object,
        form: Form,
        override: bpy.types.Material | None = None,
    ) -> LiveMesh:
        """The mesh with faces of an entry of `depsgraph.object_instances`, to which places are added; it is read while
        the entry is valid.

        form: how the entry is rendered. override: the material override of this view layer.
        """
        key = *mesh_key(evaluated), override and override.original.session_uid, form.split_group
        asked = asked_about(evaluated)
        first = self._frame.get(key)
        if first is not None and first.read.content.asks_owner and first.read.asked != asked:
            key = *key, evaluated.original.session_uid
        if key not in self._frame:
            live = self._kept.setdefault(self._lasting_key(evaluated, form.split_group), LiveMesh())
            live.places, live.owner = None, owner.name
            if live.read is None or live.read.key != key or self._may_differ(live.read, evaluated, asked):
                self.counts["read"] += 1
                before = live.read and live.read.topology
                live.read = mesh_reading(key, evaluated, live.owner, form.split_group, override, before, self._images)
            self._frame[key] = live
        return self._frame[key]

    def _may_differ(self, read: MeshReading, evaluated: bpy.types.Object, asked: tuple) -> bool:
        """Whether a mesh, of which nothing was evaluated again, may look different from when it was read."""
        changes = self._changes
        if changes is None or changes.are_pixels_edited or read.has_frames:
            return True
        # its owner may have been asked for any of its properties
        if read.content.asks_owner and (read.asked != asked or evaluated.name_full in changes.objects):
            return True
        names = evaluated.name_full, evaluated.data.name_full
        return not changes.geometry.isdisjoint(names) or not changes.materials.isdisjoint(read.made_of)

    def instances(
        self, depsgraph: bpy.types.Depsgraph, density: Density, looks: dict[str, bool], notes
    ) -> tuple[Placements, Placements]:
        """All instances added to this frame; the places of one mesh share its surfels or polygons. looks: options of
        sampling by name, see `looks_of_meshes`."""
        sampled, drawn = [], []
        self._views = is_moving(depsgraph.scene.camera), *views_told(depsgraph)
        for live in self._frame.values():
            if live.places is None:
                continue
            read = live.read
            for sentence in (*read.content.notes, *read.said):
                notes.add(sentence)
            if needs_surfels(read.content.triangles):
                live.be_surfels()
            try:
                if live.sampled_at and len(read.sampled_part):
                    if read.strays:
                        notes.add(f"{live.owner}: left out of its surfels are {stray_triangles(read.strays)}")
                    sampled.append(self._sampled_instances(live, depsgraph, density, looks))
                if live.drawn_at and len(read.drawn_part):
                    drawn.append(self._polygon_instances(live, notes))
            except Exception as error:
                notes.leave_out(live.owner, error)
            live.places = None
        self._kept = {name: live for name, live in self._kept.items() if name in self._names}
        return joined(*sampled), joined(*drawn)

    def _sampled_instances(self, live: LiveMesh, depsgraph, density, looks: dict[str, bool]) -> Placements:
        sampled = self._sampled(live, depsgraph, density.finer(live.detail), looks)
        if live.shown is None or live.shown[0] is not sampled:
            parts = live.read.parts
            whole = joined_at_edges(sampled, *parts, live.spacing) if parts else sampled
            before, live.shown = live.shown, (sampled, whole)
            if before is not None:
                replaced(before[1], live.shown[1])
        textures = live.looked_up("textures") if sampled.has_uvs else ()
        self.counts["meshes"] += 1
        self.counts["surfels"] += len(live.shown[1])
        return live.placed(partial(Instance, live.shown[1], textures=textures), live.sampled_at)

    def _polygon_instances(self, live: LiveMesh, notes) -> Placements:
        mesh = live.read.drawn_part
        if live.drawn is None or not have_same_values(live.drawn[0], mesh):
            live.drawn = mesh, mesh_polygons(mesh)
        self.counts["polygon_meshes"] += 1
        self.counts["triangles"] += len(mesh)
        for sentence in left_out_of_polygons(live.owner, mesh):
            notes.add(sentence)
        looked_up = {field: live.looked_up(field) for field in MAPS}
        return joined(
            *(live.placed(partial(PolygonInstance, shape, **looked_up), live.drawn_at) for shape in live.drawn[1])
        )

    def _lasting_key(self, evaluated: bpy.types.Object, group: str) -> tuple:
        """A key that identifies the same mesh in the next frame, after it has been evaluated again.

        Geometry Nodes may put several meshes of the same name into an object; they are told apart by their order.
        """
        name = evaluated.original.session_uid, evaluated.data.name_full, group
        number = 0
        while (*name, number) in self._names:
            number += 1
        self._names[(*name, number)] = name
        return (*name, number)

    def _sampled(
        self, live: LiveMesh, depsgraph: bpy.types.Depsgraph, density: Density, looks: dict[str, bool]
    ) -> Surfels:
        """The sampling of a mesh. Raises ValueError with a sentence if it cannot be sampled."""
        if looks != live.looks:
            live.deforming, live.looks = None, looks
        mesh, spacing = live.read.sampled_part, spacing_for(live, density, depsgraph, self._views)
        if live.deforming is not None and spacing == live.spacing and live.deforming.has_triangles_of(mesh):
            surfels, stretched = live.deforming.at(mesh)
            if stretched <= STRETCHED_SHARE:
                self.counts["followed"] += 1
                return surfels
            self.counts["stretched"] += 1
            live.deforming = None
            spacing = spacing_for(live, density, depsgraph, self._views)
        predicted = predict_count(mesh, spacing=spacing)
        if self._most is not None and predicted > self._most:
            spacing *= math.sqrt(predicted / self._most)
        elif predicted > MAX_SURFELS:
            raise ValueError(f"It would be {predicted:,} surfels and the limit is {MAX_SURFELS:,}; sample it coarser.")
        live.deforming = deforming_surfels(mesh, spacing, looks, live.read.parts is None, live.read.bends)
        live.density, live.spacing = density, spacing
        self.counts["sampled"] += 1
        return live.deforming.at(mesh)[0]
