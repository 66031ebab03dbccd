# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads a mesh that is rendered without a conversion, with its materials, while Blender has it evaluated."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import bpy
import numpy as np

from ...rendering import Material
from ...sampling import Outline, TriangleMesh, drop_strays, outline
from ...surfels import OPTIONAL_LAYOUT
from ..geometry.reading import readable_mesh
from ..geometry.split_meshes import MeshParts, parts_by_group
from ..materials.image_files import shows_frames
from ..materials.slots import slot_materials
from ..meshes.mesh_extraction import ExtractedMesh, Topology, read_mesh, read_topology
from . import passed_over
from .holdouts import held_slots
from .notes import Notes
from .shading import shading_material


@dataclass(frozen=True, eq=False)
class MeshReading:
    """An evaluated mesh as it was read.

    key: result of `mesh_key`, and what else tells evaluations apart. asked: result of `asked_about`. parts: of a mesh
    that a vertex group splits. made_of: session_uids of its materials. has_frames: whether they show an image that is
    another in each frame. held: result of `held_slots`. said: sentences about its materials and its object. bends:
    whether its object has shape keys or modifiers that deform it.
    """

    key: tuple
    asked: tuple
    topology: Topology
    content: ExtractedMesh
    parts: MeshParts | None
    materials: tuple[Material, ...]
    made_of: frozenset[int]
    has_frames: bool
    held: list[int]
    said: list[str]
    bends: bool

    @property
    def whole(self) -> TriangleMesh:
        """What may be sampled of the mesh: all of it but strays."""
        return self._without_strays[0]

    @property
    def strays(self) -> int:
        """The number of triangles that reach too far to be sampled."""
        return self._without_strays[1]

    @cached_property
    def _without_strays(self) -> tuple[TriangleMesh, int]:
        return drop_strays(self.content.triangles)

    @cached_property
    def outline(self) -> Outline:
        """The outline of what may be sampled."""
        return outline(self.whole)

    @property
    def sampled_part(self) -> TriangleMesh:
        return self.parts.far if self.parts else self.whole

    @property
    def drawn_part(self) -> TriangleMesh:
        return self.parts.near if self.parts else self.content.triangles


def asked_about(evaluated: bpy.types.Object) -> tuple:
    """What the nodes of a material may ask about an object, in a form that can be compared."""
    placed = evaluated.matrix_world.copy().freeze()
    return evaluated.original.session_uid, placed, tuple(evaluated.color), evaluated.pass_index


def mesh_reading(
    key: tuple,
    evaluated: bpy.types.Object,
    owner: str,
    group: str,
    override: bpy.types.Material | None,
    topology: Topology | None,
    images: dict,
) -> MeshReading:
    """Read the mesh of an evaluated object.

    owner: name of the object that shows it. group: the vertex group that splits it, or an empty string. override: the
    material override of the view layer. topology: of the reading before. images: those that were read, for `read_mesh`.
    """
    # said in each frame, because the mesh itself is not read in each
    notes = Notes()
    for sentence in passed_over.of_object(evaluated.original):
        notes.add(sentence)
    with readable_mesh(evaluated) as mesh:
        slots = slot_materials(evaluated, mesh)
        if override is not None:
            slots = [override] * max(len(slots), 1)
        topology = read_topology(mesh, topology)
        content = read_mesh(evaluated, mesh, topology, images, slots)
        if unusable := _not_finite(content.triangles):
            notes.add(f"{owner}: {unusable:,} triangles with a non-finite vertex are left out")
        return MeshReading(
            key=key,
            asked=asked_about(evaluated),
            topology=topology,
            content=content,
            parts=parts_by_group(evaluated, mesh, content.triangles, group) if group else None,
            bends=evaluated.original.is_deform_modified(bpy.context.scene, "RENDER"),
            materials=tuple(shading_material(material, notes, OPTIONAL_LAYOUT) for material in slots),
            held=held_slots(slots),
            made_of=frozenset(material.original.session_uid for material in slots if material),
            has_frames=any(map(shows_frames, slots)),
            said=list(notes.counts.elements()),
        )


def _not_finite(mesh: TriangleMesh) -> int:
    """Number of triangles that have a vertex without a place."""
    are_bad = ~np.isfinite(mesh.positions).all(axis=1)
    return int(np.count_nonzero(are_bad[mesh.triangles].any(axis=1))) if are_bad.any() else 0
