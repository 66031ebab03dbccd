# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads the points of an evaluated Blender object, a mesh's vertices or a point cloud, with their attributes.

The counterpart of `mesh_extraction` for objects without a surface; its result goes to `sampling.surfels_from_points`.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import bpy
import numpy as np

from .attributes import has_surfels
from .reading import own_materials, read_values, readable_mesh

#: Blender's attribute type -> what `foreach_get` takes, and values per point. "color" is scene-linear for both.
_READS = {
    "FLOAT": ("value", 1),
    "FLOAT_VECTOR": ("vector", 3),
    "FLOAT_COLOR": ("color", 4),
    "BYTE_COLOR": ("color", 4),
}
_COLOR_TYPES = ("FLOAT_COLOR", "BYTE_COLOR")
#: Names that importers and add-ons use for a point's colour, the most common first.
_COLOR_NAMES = ("Col", "color", "Color")


@dataclass(frozen=True, eq=False)
class ExtractedPoints:
    """positions: (N, 3) float32; normals: (N, 3), radii: (N,), colors: (N, 4) float32 or None. Object units.
    materials: the object's, None for an empty slot.
    """

    positions: np.ndarray
    normals: np.ndarray | None
    radii: np.ndarray | None
    colors: np.ndarray | None
    materials: tuple[bpy.types.Material | None, ...]


def has_points(source: bpy.types.Object) -> bool:
    """Whether `extract_points` can read this object: a point cloud, or a mesh that is not surfels already."""
    return source.type == "POINTCLOUD" or (source.type == "MESH" and not has_surfels(source.data))


def extract_points(source: bpy.types.Object, depsgraph: bpy.types.Depsgraph) -> ExtractedPoints:
    """The points of an object, as its modifiers make them."""
    evaluated = source.evaluated_get(depsgraph)
    materials = materials_of(evaluated)
    # The geometry set owns its point cloud, so it must live until the points are copied.
    geometry = _evaluated_geometry(evaluated)
    cloud = evaluated.data if evaluated.type == "POINTCLOUD" else geometry and geometry.pointcloud
    if cloud is not None:
        return _read_points(cloud.attributes, len(cloud.points), materials)
    with readable_mesh(evaluated) as mesh:
        points = _read_points(mesh.attributes, len(mesh.vertices), materials)
        if points.normals is None and mesh.polygons:
            points = replace(points, normals=read_values(mesh.vertex_normals, "vector", 3, len(mesh.vertices)))
    return points


def materials_of(evaluated: bpy.types.Object) -> tuple[bpy.types.Material | None, ...]:
    """The materials of the file in an evaluated object's slots, None for an empty one."""
    return tuple(material and material.original for material in own_materials(evaluated))


def sheared(points: ExtractedPoints, linear: np.ndarray) -> ExtractedPoints:
    """The points under a (3, 3) linear map; normals use its inverse transpose, radii stay."""
    normals = points.normals
    return replace(
        points,
        positions=points.positions @ linear.T,
        normals=None if normals is None else normals @ np.linalg.inv(linear),
    )


def _evaluated_geometry(evaluated: bpy.types.Object) -> bpy.types.GeometrySet | None:
    """What Geometry Nodes made of a mesh that has no vertices left; None for anything else."""
    if evaluated.type != "MESH" or len(evaluated.data.vertices) or not hasattr(evaluated, "evaluated_geometry"):
        return None
    return evaluated.evaluated_geometry()


def _read_points(attributes, count: int, materials) -> ExtractedPoints:
    def read(name: str, *types: str) -> np.ndarray | None:
        attribute = attributes.get(name)
        if attribute is None or attribute.domain != "POINT" or attribute.data_type not in types:
            return None
        return read_values(attribute.data, *_READS[attribute.data_type], count)

    positions = read("position", "FLOAT_VECTOR")
    colors = (read(name, *_COLOR_TYPES) for name in (*_COLOR_NAMES, *(a.name for a in attributes)))
    return ExtractedPoints(
        positions=np.empty((0, 3), np.float32) if positions is None else positions,
        normals=read("normal", "FLOAT_VECTOR"),
        radii=read("radius", "FLOAT"),
        colors=next((values for values in colors if values is not None), None),
        materials=materials,
    )
