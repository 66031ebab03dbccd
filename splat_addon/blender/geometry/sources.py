# SPDX-License-Identifier: GPL-3.0-or-later
"""The surfaces that an object shows: its own evaluated mesh, and every mesh that it instances.

The depsgraph's list of instances contains all of them in every supported version: the mesh of a curve, a text or a
family of metaballs is an instance that its object makes of itself, and so are instances of Geometry Nodes and
collections.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import bpy
import numpy as np

from ...interchange.placement import flattens
from .attributes import has_surfels
from .points_proxy import is_points_modifier, shows_as_points
from .reading import own_materials, readable_mesh

#: Types whose evaluated geometry is, or may be, a mesh; the latter only with modifiers that could make one.
_SURFACES = frozenset({"MESH", "CURVE", "SURFACE", "FONT", "META"})
_SURFACES_BY_MODIFIERS = frozenset({"POINTCLOUD", "CURVES"})


def has_surfaces(source: bpy.types.Object) -> bool:
    """Whether `shown_by` may find a surface in this kind of object; surfels have none."""
    if source.type == "EMPTY":
        return source.instance_type == "COLLECTION" and source.instance_collection is not None
    if source.type in _SURFACES_BY_MODIFIERS:
        return bool(source.modifiers)
    return source.type in _SURFACES and not is_surfel_object(source)


def instanced_collections(source: bpy.types.Object) -> set[bpy.types.Collection]:
    """The collections whose objects `source` shows as a collection instance, with those inside them."""
    found, waiting = set(), [source]
    while waiting:
        owner = waiting.pop()
        placed = owner.instance_collection if owner.instance_type == "COLLECTION" else None
        for each in (placed, *placed.children_recursive) if placed is not None else ():
            if each not in found:
                found.add(each)
                waiting += each.objects
    return found


def is_surfel_object(source: bpy.types.Object) -> bool:
    """Whether the object stores surfels itself."""
    return source.type == "MESH" and has_surfels(source.data)


@dataclass(eq=False)
class Piece:
    """One mesh, as it was read, and the (4, 4) float64 matrices of all its places, from its space to the world."""

    content: Any
    matrices: list[np.ndarray] = field(default_factory=list)


@dataclass(eq=False)
class ShownMeshes:
    """What one object shows.

    others: session_uids of further objects that it shows, so that it changes when they do.
    skipped: sentence -> number of instances that cannot be sampled.
    types: types of other things that it shows.
    """

    pieces: list[Piece] = field(default_factory=list)
    others: set[int] = field(default_factory=set)
    skipped: dict[str, int] = field(default_factory=dict)
    types: set[str] = field(default_factory=set)

    def skip(self, sentence: str) -> None:
        self.skipped[sentence] = self.skipped.get(sentence, 0) + 1

    def notes(self) -> list[str]:
        """One sentence for each kind of thing that was left out."""
        return [sentence.format(count, "s" * (count > 1)) for sentence, count in self.skipped.items()]


#: Function that reads a mesh while it is valid.
Reader = Callable[[bpy.types.Object, bpy.types.Mesh], Any]

_FLATTENED = "Left out {} instance{} with a scale of 0 on some axis"
_SURFELS = "Left out {} instance{} of surfels, which are not sampled again"


def shown_by(source: bpy.types.Object, depsgraph: bpy.types.Depsgraph, read: Reader) -> ShownMeshes:
    """Every mesh that the source shows in the depsgraph; `read` is called once per mesh, however often it is
    instanced."""
    shown, pieces, owners = ShownMeshes(), {}, {}
    for entry in depsgraph.object_instances:
        if owner_of(entry) != source or not entry.show_self:
            continue
        object_ = entry.object
        if object_.original != source:
            shown.others.add(object_.original.session_uid)
        if object_.type == "POINTCLOUD" and has_surfels(object_.data):
            if not shows_as_points(object_.original):
                shown.skip(_SURFELS)
            continue
        if object_.type != "MESH":
            if entry.is_instance:
                shown.types.add(object_.type)
            continue
        matrix = np.array(entry.matrix_world, np.float64)
        if entry.is_instance and (not np.isfinite(matrix).all() or flattens(matrix[:3, :3])):
            shown.skip(_FLATTENED)
            continue
        key = mesh_key(object_)
        first = owners.setdefault(key, object_.original)
        if first != object_.original and getattr(getattr(pieces[key], "content", None), "asks_owner", False):
            key = *key, object_.original.session_uid
        if key not in pieces:
            with readable_mesh(object_) as mesh:
                is_surfels = has_surfels(mesh) or (not mesh.polygons and shows_as_points(object_.original))
                pieces[key] = None if is_surfels else Piece(read(object_, mesh))
        if pieces[key] is None:
            shown.skip(_SURFELS)
        else:
            pieces[key].matrices.append(matrix)
    shown.pieces = [piece for piece in pieces.values() if piece is not None]
    if source.type == "META":
        shown.others |= {other.session_uid for other in metaball_family(source)}
    return shown


def owner_of(entry: bpy.types.DepsgraphObjectInstance) -> bpy.types.Object:
    """The object in the file that an entry of `depsgraph.object_instances` belongs to: for an instance, its
    instancer."""
    return (entry.parent if entry.is_instance else entry.object).original


def may_change(entry: bpy.types.DepsgraphObjectInstance) -> bool:
    """Whether the geometry of an entry may be another in each frame, as far as this frame tells: its object or the
    instancer has shape keys, or other modifiers than the one that shows surfels as points."""
    for each in (entry.object.original, owner_of(entry)):
        if not all(map(is_points_modifier, each.modifiers)) or getattr(each.data, "shape_keys", None):
            return True
    return False


def asked_of(entry: bpy.types.DepsgraphObjectInstance) -> tuple[bpy.types.Object, ...]:
    """The objects in the file that determine how an entry is drawn: for a collection instance, also the object inside
    it."""
    owner = owner_of(entry)
    return (entry.object.original, owner) if owner.instance_type == "COLLECTION" else (owner,)


def mesh_key(evaluated: bpy.types.Object) -> tuple:
    """A key that is equal for entries with the same evaluated mesh and materials, within one evaluation."""
    # an evaluated material has no session_uid of its own
    slots = (material.original.session_uid if material else 0 for material in own_materials(evaluated))
    return evaluated.data.session_uid, *slots


def metaball_family(source: bpy.types.Object) -> list[bpy.types.Object]:
    """All metaball objects that merge with this one; Blender groups them by name, ignoring the number."""
    stem = _stem(source.name)
    return [other for other in bpy.data.objects if other.type == "META" and _stem(other.name) == stem]


def _stem(name: str) -> str:
    head, dot, tail = name.rpartition(".")
    return head if dot and tail.isdigit() else name


def why_nothing(source: bpy.types.Object, shown: ShownMeshes, points: int) -> str:
    """The sentence for a source without faces. points: number of vertices in its meshes."""
    if source.type == "META":
        family = sorted(other.name for other in metaball_family(source) if other != source)
        if family:
            return (
                f"It forms one mesh with the metaballs {', '.join(map(repr, family))}, and another of them has that "
                "mesh; select all of them."
            )
    if "POINTCLOUD" in shown.types:
        return (
            "It makes points without a surface; use Object > Convert Points to Surfels, or let its Geometry Nodes "
            "put meshes there."
        )
    if source.type == "CURVE" or shown.types & {"CURVE", "CURVES"}:
        return "Its curves have no surface; give them a bevel, an extrusion or a fill first."
    if source.type == "EMPTY":
        return "The collection that it shows has no surfaces in it; put a mesh there."
    if source.type in _SURFACES_BY_MODIFIERS:
        return "Its modifiers make no mesh, so there is no surface to sample; let them make one."
    if not shown.pieces and not source.show_instancer_for_render:
        return "It shows no instances, and renders do not show its own mesh; switch Show Instancer > Render on."
    return f"The mesh {'has no faces' if points else 'is empty'}, so there is no surface to sample; add faces first."
