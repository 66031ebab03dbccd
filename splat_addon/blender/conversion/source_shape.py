# SPDX-License-Identifier: GPL-3.0-or-later
"""What makes the shape of a source, as a short text to compare with: handlers, scripts and users swap or edit meshes,
curves and modifiers without any animation that could be found beforehand.

It is read from the source as the file has it, because renders do not evaluate a hidden source. Of a source that
surfels are bound to, only the faces are compared, as evaluated: its positions may change.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator

import bpy
import numpy as np

from ..fingerprints import checksum, of_values, plain, settings
from ..geometry.node_groups import input_of, nodes_in, taken_by
from ..geometry.sources import has_surfaces, instanced_collections
from .changing_shape import used_by

#: How far objects may move against each other unnoticed, as a share of the largest number of their matrix.
_STILL = 1e-4

#: Attributes of meshes: name, property, numbers each, and their type.
_POSITIONS = ("position", "vector", 3, np.float32)
_FACES = ((".corner_vert", "value", 1, np.int32), (".edge_verts", "value", 2, np.int32))

#: Properties of modifiers, curves and metaballs that change no render: of the viewport, the panels, or their children.
_IGNORED = frozenset(
    "rna_type name eval_time hide levels resolution resolution_u resolution_v sculpt_levels viewport_resolution".split()
)
_IGNORED_IF_IN_NAME = ("active", "open_", "select", "show_")


def shape_of(source: bpy.types.Object, depsgraph: bpy.types.Depsgraph, beside: bpy.types.Object | None = None) -> str:
    """The shape of a source: its data, its modifiers with what they use, and the collection that it shows.

    beside: an object that it was joined with. depsgraph: says where objects are.
    """
    told, places = [*_of_object(source)], _Places(depsgraph)
    places.add([source] if beside else _used(source), beside or source)
    inside = {each for placed in instanced_collections(source) for each in placed.objects if has_surfaces(each)}
    for each in sorted(inside, key=lambda each: each.name_full):
        told += _of_object(each)
        places.add([each], None)
        places.add(_used(each), each)
    return f"{checksum(told)} {places}"


def faces_of(mesh: bpy.types.Mesh) -> str:
    """The faces of an evaluated mesh."""
    return checksum(_of_faces(mesh))


def is_same(then: str, now: str) -> bool:
    """Whether a source has the shape that it had, but for rounding."""
    (code, *before), (other, *after) = then.split(), now.split()
    if code != other or len(before) != len(after):
        return False
    if not before:
        return True
    matrices = np.array([before, after], np.float64).reshape(2, -1, 12)
    off, size = np.abs(matrices[0] - matrices[1]).max(axis=1), np.abs(matrices[0]).max(axis=1)
    return bool((off <= _STILL * size).all())


class _Places:
    """Where objects are in the space of others: 12 numbers each."""

    def __init__(self, depsgraph: bpy.types.Depsgraph):
        self._depsgraph, self._told = depsgraph, []

    def add(self, objects: Iterable[bpy.types.Object], beside: bpy.types.Object | None) -> None:
        base = np.eye(4) if beside is None else np.linalg.pinv(self._matrix(beside))
        for owner in objects:
            self._told += [f"{value:.7g}" for value in (base @ self._matrix(owner))[:3].ravel()]

    def _matrix(self, owner: bpy.types.Object) -> np.ndarray:
        return np.nan_to_num(np.array(owner.evaluated_get(self._depsgraph).matrix_world, np.float64))

    def __str__(self) -> str:
        return " ".join(self._told)


def _of_object(owner: bpy.types.Object) -> Iterator[str]:
    yield from _of_data(owner.data)
    for modifier in _modifiers(owner):
        yield from (modifier.type, *_settings(modifier, bpy.types.Modifier.bl_rna.properties.keys()))
        if modifier.type == "NODES" and modifier.node_group is not None:
            yield from _of_nodes(modifier)
    for used in _used(owner):
        yield from _of_data(used.data)


def _modifiers(owner: bpy.types.Object) -> list[bpy.types.Modifier]:
    return [modifier for modifier in owner.modifiers if modifier.show_render]


def _used(owner: bpy.types.Object) -> list[bpy.types.Object]:
    """The objects that the modifiers of an object use."""
    found = [used for modifier in _modifiers(owner) for used in used_by(modifier)]
    for taken in (taken for m in _modifiers(owner) if m.type == "NODES" for taken in taken_by(m)):
        found += taken.all_objects if isinstance(taken, bpy.types.Collection) else [taken]
    return [used for used in dict.fromkeys(found) if used is not owner]


def _of_data(data: bpy.types.ID | None) -> Iterator[str]:
    keys = getattr(data, "shape_keys", None)
    yield from (f"{block.value:g} {block.mute}" for block in (keys.key_blocks if keys else ()))
    if isinstance(data, bpy.types.Mesh):
        yield from (of_values(data, *_POSITIONS), *_of_faces(data))
    elif isinstance(data, bpy.types.PointCloud | bpy.types.Curves):
        yield of_values(data, *_POSITIONS)
    elif isinstance(data, bpy.types.Curve):
        yield from _settings(data, bpy.types.ID.bl_rna.properties.keys())
        for spline in data.splines:
            points = (*spline.points, *spline.bezier_points)
            yield from (*_settings(spline), *(setting for point in points for setting in _settings(point)))
    elif isinstance(data, bpy.types.MetaBall):
        for element in data.elements:
            yield from _settings(element)


def _of_faces(mesh: bpy.types.Mesh) -> Iterator[str]:
    yield f"{len(mesh.vertices)} {len(mesh.edges)} {len(mesh.loops)} {len(mesh.polygons)}"
    yield from (of_values(mesh, *attribute) for attribute in _FACES)


def _of_nodes(modifier: bpy.types.NodesModifier) -> Iterator[str]:
    for item in modifier.node_group.interface.items_tree:
        if item.item_type == "SOCKET" and item.in_out == "INPUT" and hasattr(item, "default_value"):
            yield plain(input_of(modifier, item.identifier))
    for node in nodes_in(modifier.node_group):
        yield from (node.bl_idname, str(node.mute), *_settings(node, bpy.types.Node.bl_rna.properties.keys()))
        sockets = (*node.inputs, *node.outputs)
        yield from (plain(socket.default_value) for socket in sockets if hasattr(socket, "default_value"))


def _settings(of: bpy.types.bpy_struct, ignored: Iterable[str] = ()) -> Iterator[str]:
    """The values of its properties that are no pointers and change a render."""
    return settings(
        of,
        lambda name: name in _IGNORED or name in ignored or any(part in name for part in _IGNORED_IF_IN_NAME),
    )
