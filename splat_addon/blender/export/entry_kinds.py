# SPDX-License-Identifier: GPL-3.0-or-later
"""What the entries of a depsgraph show: each kind is read once, and stands in the places of its entries."""

from __future__ import annotations

from dataclasses import dataclass, field

import bpy
import numpy as np

from ...rendering import Instance
from ...rendering.scene import placed_at
from ...rendering.scene.placements import Placements, joined, placements
from ..conversion.color_watch import out_of_date
from ..conversion.placement import finite_matrix
from ..conversion.series import why_not_shown
from ..conversion.source_record import is_stood_in, stood_in
from ..geometry.sources import asked_of, owner_of
from ..materials.material_override import override_of
from ..mesh_sampling_settings import Form, form_of
from ..object_detail import detail_of
from .contents import ABOUT_BARE_POINTS, Content, content_of, not_drawn
from .entries import kind_of, matrices_of
from .light_linking import LightSets
from .live_mesh import LiveMesh
from .live_meshes import LiveMeshes
from .notes import Notes
from .places import Manner, Places, in_order, parts_at
from .styles import style_of
from .surfel_instances import SurfelInstances
from .surfel_store import SurfelStore
from .traits import ray_visibility, traits_of

#: What has no faces is not drawn as a mesh.
_NO_FORM = Form("HIDDEN")


@dataclass(eq=False)
class EntryKind:
    """What entries show that differ in their places only.

    shows: whether it may be visible. surfels: instances of those that are surfels, placed in the space of an entry.
    mesh: the one that it shows, in some manner. notes: on one entry. rows: of its entries.
    """

    name: str
    shows: bool = False
    surfels: list[Instance] = field(default_factory=list)
    mesh: LiveMesh | None = None
    manner: Manner | None = None
    notes: Notes = field(default_factory=Notes)
    rows: list[int] = field(default_factory=list)


class EntryKinds:
    """What the entries of a depsgraph show.

    surfels: instances of those that are surfels; meshes are added to `live_meshes`.
    """

    def __init__(
        self,
        depsgraph: bpy.types.Depsgraph,
        store: SurfelStore,
        live_meshes: LiveMeshes,
        light_sets: LightSets,
        notes: Notes,
    ):
        self.surfels = placements(())
        self._depsgraph, self._live_meshes, self._light_sets, self._notes = depsgraph, live_meshes, light_sets, notes
        self._override = override_of(depsgraph)
        self._of_surfels = SurfelInstances(depsgraph, store, self._override)
        self._stood_in = stood_in(depsgraph)

    @property
    def made(self) -> set[bpy.types.Object]:
        """The objects in the .blend whose surfels were read from their attributes."""
        return self._of_surfels.made

    def add_all(self) -> None:
        """Add all entries."""
        matrices = matrices_of(self._depsgraph)
        are_finite = np.isfinite(matrices).all(axis=(1, 2)).tolist()
        kinds: dict[tuple, EntryKind] = {}
        for row, entry in enumerate(self._depsgraph.object_instances):
            if not entry.show_self:
                continue
            key = kind_of(entry)
            if key not in kinds:
                kinds[key] = self._kind(entry)
            kind = kinds[key]
            if kind.shows and not are_finite[row]:
                self._leave_out(kind.name, matrices[row])
                continue
            kind.rows.append(row)
        of_meshes: dict[LiveMesh, list[EntryKind]] = {}
        for kind in kinds.values():
            self._notes.add_those_of(kind.notes, len(kind.rows))
            if kind.mesh is not None and kind.rows:
                of_meshes.setdefault(kind.mesh, []).append(kind)
        for mesh, own in of_meshes.items():
            rows, of = in_order([kind.rows for kind in own])
            mesh.places = Places(tuple(kind.manner for kind in own), of, matrices[rows])
        self._place([kind for kind in kinds.values() if kind.surfels], matrices)

    def _leave_out(self, name: str, matrix: np.ndarray) -> None:
        try:
            finite_matrix(matrix)
        except ValueError as error:
            self._notes.leave_out(name, error)

    def _place(self, kinds: list[EntryKind], matrices: np.ndarray) -> None:
        """Make the instances of kinds of surfels."""
        rows, of = in_order([kind.rows for kind in kinds])
        try:
            self.surfels = _placed([kind.surfels for kind in kinds], of, matrices[rows])
        except ValueError:  # of some of them, which are found
            for row, number in zip(rows.tolist(), of.tolist(), strict=True):
                try:
                    own = _placed([kinds[number].surfels], np.zeros(1, int), matrices[[row]])
                    self.surfels = joined(self.surfels, own)
                except ValueError as error:
                    self._notes.leave_out(kinds[number].name, error)

    def _kind(self, entry: bpy.types.DepsgraphObjectInstance) -> EntryKind:
        """The kind of an entry, whose meshes are read while the entry is valid."""
        kind = EntryKind(entry.object.name)
        if any(ray_visibility(entry, self._depsgraph)):
            try:
                self._fill(kind, entry)
            except Exception as error:
                kind.notes.leave_out(kind.name, error)
        return kind

    def _fill(self, kind: EntryKind, entry: bpy.types.DepsgraphObjectInstance) -> None:
        """Find what an entry shows. Raises ValueError with a sentence if it cannot be drawn."""
        object_, notes, scene = entry.object, kind.notes, self._depsgraph.scene
        if sentence := why_not_shown(object_.original.data):
            raise ValueError(sentence)
        content = content_of(entry)
        if not content:
            if sentence := not_drawn(object_):
                notes.add(sentence)
            return
        kind.shows = True
        owner, traits = owner_of(entry), traits_of(entry, self._depsgraph, self._light_sets)
        if content.has_surfels:
            if sentence := out_of_date(object_.original):
                notes.add(sentence)
            stream = self._of_surfels.stream_of(object_.original, notes)
            if stream is not None:
                kind.surfels += self._of_surfels.streamed(object_, stream, traits, notes)
                return
            kind.surfels += self._of_surfels.stored(entry, content, traits, notes)
        form = form_of(entry, scene) if Content.FACES in content else _NO_FORM
        if form.kind != "HIDDEN" and not any(is_stood_in(each, self._stood_in) for each in asked_of(entry)):
            kind.mesh = self._live_meshes.of(object_, owner, form, self._override)
            kind.manner = Manner(traits, form, detail_of(owner), style_of(object_.original, scene))
        if Content.BARE_POINTS in content:
            notes.add(ABOUT_BARE_POINTS)


def _placed(of_kinds: list[list[Instance]], of: np.ndarray, matrices: np.ndarray) -> Placements:
    """Instances at n places of entries. of_kinds: those of each kind, placed in the space of an entry. of: (n,) the
    kinds."""
    rows, numbers = parts_at(of, list(map(len, of_kinds)))
    parts, moved = [part for own in of_kinds for part in own], matrices[rows]
    if any(part.stream is not None for part in parts):
        moved = moved.astype(np.float64)
    for number, part in enumerate(parts):
        if part.stream is not None:
            own = numbers == number
            moved[own] = moved[own] @ part.matrix_world
    return placed_at(parts, moved, numbers)
