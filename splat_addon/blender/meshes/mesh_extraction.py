# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads a Blender object, evaluated with its modifiers, as a `sampling.TriangleMesh`.

It uses only the fast interfaces: attributes and `loop_triangle_polygons` copy whole arrays, whereas `vertices.co`,
`loops.vertex_index`, `polygons.material_index` and the legacy UV data take a hundred times as long. Rows are gathered
with `take`, which takes a quarter of the time of indexing.
"""

from __future__ import annotations

import zlib
from collections.abc import Iterable
from dataclasses import dataclass

import bpy
import numpy as np

from ...sampling import Image, Surface, TriangleMesh
from ..geometry.reading import read_values
from ..materials.graphs.reading import REST
from ..materials.material_surfaces import PLAIN, Unread, material_surface
from ..materials.mesh_layers import ATTRIBUTE_TYPES, GENERATED, NORMAL, POINTINESS, POSITION, TRUE_NORMAL, MeshLayers
from ..materials.slots import slot_materials
from ..materials.surface_shaders import why_unseen
from .pointiness import pointiness


@dataclass(frozen=True, eq=False)
class ExtractedMesh:
    """triangles: in the object's own space, without those whose material covers nothing.
    materials: of the object's slots, as in the file, None for an empty slot.
    unread: inputs of these materials that could not be read.
    unseen: the end of a sentence for each material that covers nothing.
    asks_owner: whether its materials look different on each object.
    """

    triangles: TriangleMesh
    materials: tuple[bpy.types.Material | None, ...]
    unread: tuple[tuple[bpy.types.Material, Unread], ...] = ()
    unseen: tuple[str, ...] = ()
    asks_owner: bool = False

    @property
    def notes(self) -> list[str]:
        """One sentence for each input that could not be read."""
        return unread_sentences(self.unread)


def unread_sentences(unread: Iterable[tuple[bpy.types.Material, Unread]]) -> list[str]:
    """Sentences about inputs that are not baked."""
    return [f"The material {owner.name!r}'s {what}" for owner, what in unread]


def is_unread(sentence: str) -> bool:
    """Whether this is one of `unread_sentences`, about something that could be baked."""
    return sentence.endswith((PLAIN, REST))


@dataclass(frozen=True, eq=False)
class Topology:
    """What stays constant while a mesh deforms.

    corner_vertices: (C,).
    faces: number of faces. edges: a checksum, which tells where one face ends and the next begins.
    corners: (T, 3) face corners of the triangles, face_of: (T,) their faces; both None if every face is a triangle.
        They come from the mesh as first seen; Blender may triangulate a bent face differently later.
    """

    corner_vertices: np.ndarray
    faces: int
    edges: int
    corners: np.ndarray | None
    face_of: np.ndarray | None

    def __len__(self) -> int:
        return self.faces if self.face_of is None else len(self.face_of)

    def at_corners(self, values: np.ndarray) -> np.ndarray:
        """(T, 3, ...) from (C, ...) values at face corners."""
        return values.reshape(-1, 3, *values.shape[1:]) if self.corners is None else values.take(self.corners, axis=0)

    def on_faces(self, values: np.ndarray) -> np.ndarray:
        """(T, ...) from values of the faces."""
        return values if self.face_of is None else values.take(self.face_of, axis=0)


def read_topology(mesh: bpy.types.Mesh, known: Topology | None = None) -> Topology:
    """The topology of the mesh; `known` itself if it is unchanged."""
    vertices = _corner_vertices(mesh)
    told = len(mesh.polygons), _edges(mesh)
    if known is not None and (known.faces, known.edges) == told and np.array_equal(known.corner_vertices, vertices):
        return known
    return Topology(vertices, *told, *_triangle_corners(mesh))


def read_mesh(
    evaluated: bpy.types.Object,
    mesh: bpy.types.Mesh,
    topology: Topology | None = None,
    images: dict | None = None,
    slots: list[bpy.types.Material | None] | None = None,
) -> ExtractedMesh:
    """Everything that sampling needs from an evaluated object's mesh; without triangles if it has no faces.

    topology: the mesh's, if it is known. images: keeps the textures' pixels from one call to the next. slots: the
    materials, None: its own.
    """
    slots = slot_materials(evaluated, mesh) if slots is None else slots
    topology = read_topology(mesh) if topology is None else topology
    indices = _material_indices(mesh, topology, max(len(slots), 1))
    used = np.arange(min(len(topology), 1)) if indices is None else np.flatnonzero(np.bincount(indices))
    layers = MeshLayers(mesh, owner=evaluated, **({} if images is None else {"_images": images}))
    surfaces, unread = _surfaces(slots, used, layers)
    triangles = TriangleMesh(
        positions=_positions(mesh),
        triangles=topology.at_corners(topology.corner_vertices),
        corner_normals=_corner_normals(mesh, topology),
        corner_colors=_layered(_color_reader(mesh, topology), layers.colors),
        corner_uvs=_layered(_uv_reader(mesh, topology), layers.uvs),
        materials=indices,
        surfaces=surfaces,
    )
    unseen = {k: why for k in used if k < len(slots) and slots[k] and (why := why_unseen(slots[k]))}
    if unseen:
        rows = [] if indices is None else np.flatnonzero(~np.isin(indices, list(unseen)))
        triangles = triangles.with_triangles(np.array(rows, np.int64))
    said = tuple(f"the material {slots[k].name!r} {why}" for k, why in unseen.items())
    return ExtractedMesh(triangles, tuple(m and m.original for m in slots), tuple(unread), said, layers.asks_owner)


class _NoPixels(dict):
    """White in place of every image."""

    def __contains__(self, key) -> bool:
        return True

    def __missing__(self, key) -> Image:
        return Image(np.ones((1, 1, 4), np.float32))


def read_without_pixels(evaluated: bpy.types.Object, mesh: bpy.types.Mesh) -> ExtractedMesh:
    """Everything but the pixels of textures, for predictions."""
    return read_mesh(evaluated, mesh, images=_NoPixels())


def _positions(mesh: bpy.types.Mesh) -> np.ndarray:
    count = len(mesh.vertices)
    return read_values(mesh.attributes["position"].data, "vector", 3, count) if count else np.empty((0, 3), np.float32)


def _edges(mesh: bpy.types.Mesh) -> int:
    """A checksum of the vertices of the edges; 0 if every face is a triangle."""
    if len(mesh.loops) == 3 * len(mesh.polygons):
        return 0
    return zlib.crc32(_edge_vertices(mesh))


def _edge_vertices(mesh: bpy.types.Mesh) -> np.ndarray:
    """(E, 2) int32."""
    count = len(mesh.edges)
    return read_values(mesh.attributes[".edge_verts"].data, "value", 2, count, np.int32).reshape(-1, 2)


def _corner_vertices(mesh: bpy.types.Mesh) -> np.ndarray:
    """(C,) int32 vertex of each face corner."""
    count = len(mesh.loops)
    return (
        read_values(mesh.attributes[".corner_vert"].data, "value", 1, count, np.int32)
        if count
        else np.empty(0, np.int32)
    )


def _triangle_corners(mesh: bpy.types.Mesh) -> tuple[np.ndarray | None, np.ndarray | None]:
    """(T, 3) int32 face corners of the triangles, and their (T,) faces; both None if every face is a triangle."""
    if len(mesh.loops) == 3 * len(mesh.polygons):
        return None, None
    mesh.calc_loop_triangles()
    count = len(mesh.loop_triangles)
    corners = read_values(mesh.loop_triangles, "loops", 3, count, np.int32)
    return corners, read_values(mesh.loop_triangle_polygons, "value", 1, count, np.int32)


def _corner_normals(mesh: bpy.types.Mesh, topology: Topology) -> np.ndarray | None:
    """(T, 3, 3) shading normals; None if every triangle is flat and has its own normal."""
    if not len(topology) or (mesh.normals_domain == "FACE" and len(topology) == len(mesh.polygons)):
        return None
    return topology.at_corners(read_values(mesh.corner_normals, "vector", 3, len(mesh.loops)))


def _material_indices(mesh: bpy.types.Mesh, topology: Topology, slots: int) -> np.ndarray | None:
    """(T,) int32 slot of each triangle, None: all 0; like Blender, an index past the last slot means the last."""
    attribute = mesh.attributes.get("material_index")
    if attribute is None:
        return None
    indices = read_values(attribute.data, "value", 1, len(mesh.polygons), np.int32)
    return topology.on_faces(np.clip(indices, 0, slots - 1))


def _surfaces(
    slots: list[bpy.types.Material | None], used: np.ndarray, layers: MeshLayers
) -> tuple[tuple[Surface, ...], list[tuple[bpy.types.Material, Unread]]]:
    """One surface per slot, at least one, plain for slots that no face uses; and what could not be read."""
    surfaces, all_unread = [], []
    for index, material in enumerate(slots or [None]):
        surface, unread = material_surface(material, layers) if index in used else (Surface(), [])
        surfaces.append(surface)
        all_unread += [(material.original, what) for what in unread]
    return tuple(surfaces), all_unread


def _layered(read, names: list[str]) -> np.ndarray | None:
    """(T, 3, width * layers) from `read`, a function of a layer's name that returns (T, 3, width); None without
    layers."""
    layers = [read(name) for name in names]
    return (np.concatenate(layers, axis=2) if len(layers) > 1 else layers[0]) if layers else None


def _color_reader(mesh: bpy.types.Mesh, topology: Topology):
    """The function that reads an attribute by name, as (T, 3, 4) colours at the corners.

    As in Blender's shaders, a single value becomes a grey.
    """

    def read(name: str) -> np.ndarray:
        if name in _DERIVED:
            values = np.asarray(_DERIVED[name](mesh, topology), np.float32)
            return np.concatenate([values, np.ones_like(values[..., :1])], axis=2)
        attribute = mesh.attributes[name]
        key, width = ATTRIBUTE_TYPES[attribute.data_type]
        values = read_values(attribute.data, key, width, len(attribute.data)).reshape(-1, width)
        if width < 4:
            rgba = np.zeros((len(values), 4), np.float32)
            rgba[:, : 3 if width == 1 else width] = values
            rgba[:, 3] = 1
            values = rgba
        if attribute.domain == "FACE":
            return np.broadcast_to(topology.on_faces(values)[:, None], (len(topology), 3, 4))
        if attribute.domain == "POINT":
            values = values.take(topology.corner_vertices, axis=0)
        return topology.at_corners(values)

    return read


def _generated(mesh: bpy.types.Mesh, topology: Topology) -> np.ndarray:
    """(T, 3, 3) Generated coordinates: the place in the box around the mesh before modifiers, 0 to 1."""
    places = read_values(mesh.vertices, "undeformed_co", 3, len(mesh.vertices)).reshape(-1, 3)
    low = np.array(mesh.texspace_location, np.float32) - np.array(mesh.texspace_size, np.float32)
    size = 2 * np.array(mesh.texspace_size, np.float32)
    return ((places - low) / np.where(size == 0, 1, size))[topology.at_corners(topology.corner_vertices)]


def _at_places(mesh: bpy.types.Mesh, topology: Topology) -> np.ndarray:
    return _positions(mesh).reshape(-1, 3)[topology.at_corners(topology.corner_vertices)]


def _true_normals(mesh: bpy.types.Mesh, topology: Topology) -> np.ndarray:
    corners = _at_places(mesh, topology)
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    return np.broadcast_to(
        (normals / np.linalg.norm(normals, axis=1, keepdims=True).clip(1e-37))[:, None], corners.shape
    )


def _normals(mesh: bpy.types.Mesh, topology: Topology) -> np.ndarray:
    normals = _corner_normals(mesh, topology)
    return _true_normals(mesh, topology) if normals is None else normals.reshape(-1, 3, 3)


def _pointiness(mesh: bpy.types.Mesh, topology: Topology) -> np.ndarray:
    """(T, 3, 3), the number as a grey."""
    normals = read_values(mesh.vertex_normals, "vector", 3, len(mesh.vertices)).reshape(-1, 3)
    values = pointiness(_positions(mesh).reshape(-1, 3), _edge_vertices(mesh), normals)
    return np.repeat(values[topology.at_corners(topology.corner_vertices)][..., None], 3, axis=2)


#: layer that follows from the mesh -> its reader
_DERIVED = {
    GENERATED: _generated,
    POSITION: _at_places,
    NORMAL: _normals,
    TRUE_NORMAL: _true_normals,
    POINTINESS: _pointiness,
}


def _uv_reader(mesh: bpy.types.Mesh, topology: Topology):
    return lambda name: topology.at_corners(read_values(mesh.uv_layers[name].uv, "vector", 2, len(mesh.loops)))
