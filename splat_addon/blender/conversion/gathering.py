# SPDX-License-Identifier: GPL-3.0-or-later
"""Gathers one or several objects into the single mesh that is sampled, in the space of the resulting surfel object.

Instances are made real: sampling a copy takes half as long as transforming the surfels of another, and each copy gets
the right density, whatever its scale.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace

import bpy
import numpy as np
from mathutils import Matrix

from ...sampling import Surface, TriangleMesh, have_same_values, joined, transformed
from ..geometry.sources import Piece, Reader, ShownMeshes, shown_by, why_nothing
from ..materials.material_surfaces import Unread
from ..meshes.mesh_extraction import ExtractedMesh, read_mesh
from .placement import relative, without_scale, without_shear


@dataclass(frozen=True, eq=False)
class GatheredMesh:
    """mesh: of all sources, in the space of `matrix_world`.
    materials: the materials that its indices refer to.
    unread: inputs of materials that could not be read.
    notes: one sentence for each kind of thing that was left out.
    others: session_uids of further objects that contribute to it.
    """

    mesh: TriangleMesh
    matrix_world: Matrix
    materials: tuple[bpy.types.Material | None, ...]
    unread: tuple[tuple[bpy.types.Material, Unread], ...]
    notes: list[str]
    others: frozenset[int]


def frame_of(source: bpy.types.Object, in_world_units: bool) -> Matrix:
    """The transform of the surfel object that replaces `source`, with the same scale or without.

    Raises ValueError with a sentence for a transform that is not finite or flattens the object.
    """
    return without_scale(source.matrix_world) if in_world_units else without_shear(source.matrix_world)[0]


def gather(
    sources: list[bpy.types.Object], depsgraph: bpy.types.Depsgraph, in_world_units: bool, read: Reader = read_mesh
) -> GatheredMesh:
    """The surfaces of all sources as one mesh in the frame of the first. read: returns an `ExtractedMesh`.

    Raises ValueError with a sentence if there are no faces, or for an impossible transform.
    """
    frames = [frame_of(source.evaluated_get(depsgraph), in_world_units) for source in sources]
    shown = [shown_by(source, depsgraph, read) for source in sources]
    pieces = [piece for each in shown for piece in each.pieces]
    if not any(len(piece.content.triangles) for piece in pieces):
        raise ValueError(_why_nothing(sources, shown))
    meshes, materials = _with_shared_slots([piece for piece in pieces if len(piece.content.triangles)])
    notes = [note for each in shown for note in each.notes()]
    notes += [f"Some faces are left out: {sentence}" for piece in pieces for sentence in piece.content.unseen]
    unread = tuple(dict.fromkeys(each for piece in pieces for each in piece.content.unread))
    if len(sources) > 1:
        notes += [
            f"{source.name!r} is left out: {_why_nothing([source], [each])}"
            for source, each in zip(sources, shown, strict=True)
            if not any(len(piece.content.triangles) for piece in each.pieces)
        ]
    placed = [transformed(mesh, relative(matrix, frames[0])) for mesh, piece in meshes for matrix in piece.matrices]
    others = frozenset().union(*(each.others for each in shown))
    return GatheredMesh(joined(placed), frames[0], materials, unread, list(dict.fromkeys(notes)), others)


def _why_nothing(sources: list[bpy.types.Object], shown: list[ShownMeshes]) -> str:
    points = sum(len(piece.content.triangles.positions) for each in shown for piece in each.pieces)
    unseen = dict.fromkeys(sentence for each in shown for piece in each.pieces for sentence in piece.content.unseen)
    if unseen:
        return f"None of its faces is seen ({', '.join(unseen)}); give them a material with a surface."
    sentence = why_nothing(sources[0], shown[0], points)
    return " ".join([sentence, *(f"{note}." for note in shown[0].notes())])


def _with_shared_slots(
    pieces: list[Piece],
) -> tuple[list[tuple[TriangleMesh, Piece]], tuple[bpy.types.Material | None, ...]]:
    """The pieces' meshes with one shared list of slots, and its materials.

    A single mesh keeps its slots. For several meshes, the slots that faces use are combined; a material that gives two
    meshes different colours, for example because one lacks the texture's UV map, gets a slot for each.
    """
    if len(pieces) == 1:
        return [(pieces[0].content.triangles, pieces[0])], pieces[0].content.materials
    slots: list[tuple[bpy.types.Material | None, Surface]] = []
    indices = [_slot_indices(piece.content, slots) for piece in pieces]
    surfaces = tuple(surface for _, surface in slots)
    meshes = [
        (replace(piece.content.triangles, materials=into, surfaces=surfaces), piece)
        for piece, into in zip(pieces, indices, strict=True)
    ]
    return meshes, tuple(material for material, _ in slots)


def _slot_indices(content: ExtractedMesh, slots: list) -> np.ndarray:
    """(T,) index into `slots` for each triangle; missing slots are appended."""
    mesh = content.triangles
    own = np.zeros(len(mesh), np.int32) if mesh.materials is None else mesh.materials
    used = np.unique(own)
    into = np.zeros(int(used[-1]) + 1, np.int32)
    for index in used:
        material = content.materials[index] if index < len(content.materials) else None
        surface = mesh.surfaces[min(index, len(mesh.surfaces) - 1)]
        known = (
            k for k, (other, theirs) in enumerate(slots) if other == material and have_same_values(theirs, surface)
        )
        into[index] = next(known, len(slots))
        if into[index] == len(slots):
            slots.append((material, surface))
    return into[own]


def groups(
    sources: Iterable[bpy.types.Object], active: bpy.types.Object | None, join: bool
) -> list[list[bpy.types.Object]]:
    """The sources of each surfel object: one each, or all for one, with the active object first."""
    ordered = sorted(sources, key=lambda source: source != active) if join else list(sources)
    return [ordered] if join and ordered else [[source] for source in ordered]
