# SPDX-License-Identifier: GPL-3.0-or-later
"""Stores surfels as ordinary point attributes of a vertex-only mesh; `stored_surfels` reads them back.

This storage works in every supported version; Geometry Nodes, Cycles, EEVEE and the exporters can read it, and a .blend
keeps it bit for bit. The conversion operator writes it; the engine reads it, evaluated with modifiers.

Everything goes through `attributes[name].data.foreach_set` and `foreach_get` on flat arrays of the exact type:
`vertices.foreach_set("co")` takes a hundred times as long.
"""

from __future__ import annotations

import bpy
import numpy as np

from ...surfels import Surfels
from .. import working_space
from ..ids import OFFSET, POINT_ATTRIBUTES, PRIMARIES, REST, SOLID, PointAttribute
from .gaussian_clouds import is_gaussian_cloud
from .offsets import Points, numbers_of
from .stored_surfels import read_surfels as read_surfels  # users' scripts import it from here

#: An attribute with either name on a mesh without faces marks the points as surfels.
MARKS = tuple(POINT_ATTRIBUTES[field].name for field in ("rotations", "scales"))
#: How far the matrices of one working space differ between versions of Blender; those of two differ by tenths.
_SAME_SPACE = 1e-3


def has_surfels(mesh: Points) -> bool:
    """Whether `mesh` is meant as surfels: it has no faces, and at least one of the attributes `rotation` and `scale`.

    One of them is enough, so that surfels that lost the other are reported by `read_surfels` instead of being ignored
    silently. A point cloud that this extension did not make needs both, because others use one of these names for other
    purposes, and is no surfels if it is Gaussian splats, which have both.
    """
    if isinstance(mesh, bpy.types.PointCloud):
        if is_gaussian_cloud(mesh):
            return False
        return REST.name in mesh.attributes or all(name in mesh.attributes for name in MARKS)
    return not mesh.polygons and any(name in mesh.attributes for name in MARKS)


def has_surfels_beside_faces(mesh: bpy.types.Mesh) -> bool:
    """Whether `mesh` combines surfels and an ordinary mesh; only surfels written by this extension are recognised."""
    return bool(mesh.polygons) and REST.name in mesh.attributes


def write_surfels(name: str, surfels: Surfels, offset: np.ndarray | None = None) -> bpy.types.Mesh:
    """A new vertex-only mesh that stores `surfels`. `surfels.origin` must become the object's location; offset: what
    was added to it in exchange, by default what float32 loses."""
    mesh = bpy.data.meshes.new(name)
    fill(mesh, surfels, surfels.origin - surfels.origin.astype(np.float32) if offset is None else offset)
    return mesh


def fill(mesh: bpy.types.Mesh, surfels: Surfels, offset: np.ndarray) -> None:
    """Replace the contents of a mesh by surfels. offset: (3,) float64, to be added to their positions."""
    mesh.clear_geometry()
    mesh.vertices.add(len(surfels))
    for field, layout in POINT_ATTRIBUTES.items():
        values = getattr(surfels, field)
        if values is None:
            continue
        write_attribute(mesh, layout, values)
    write_attribute(mesh, REST, surfels.positions)
    if surfels.is_solid:
        mesh[SOLID] = True
    else:
        mesh.pop(SOLID, None)
    stamp_space(mesh)
    set_offset(mesh, offset)
    mesh.update()


def set_offset(mesh: bpy.types.Mesh, offset: np.ndarray) -> None:
    """Store what is added to the positions of a surfel mesh, (3,) float64."""
    if np.any(offset):
        mesh[OFFSET] = np.asarray(offset, np.float64).tolist()
    else:
        mesh.pop(OFFSET, None)


def since_written(mesh: Points) -> np.ndarray:
    """(3, 3) conversion of a surfel mesh's colours from the working space in which they were written to the file's; the
    identity if it is the same, or unknown."""
    now = working_space.to_xyz()
    then = numbers_of(mesh, PRIMARIES, 9, now.ravel())
    if np.allclose(then, now.ravel(), rtol=0, atol=_SAME_SPACE):
        return np.eye(3)
    return np.linalg.solve(now, then.reshape(3, 3))


def stamp_space(mesh: bpy.types.Mesh) -> None:
    """Store that the colours of a surfel mesh are in the file's working space."""
    mesh[PRIMARIES] = working_space.to_xyz().ravel().tolist()


def remove_attribute(mesh: bpy.types.Mesh, layout: PointAttribute) -> None:
    if (attribute := mesh.attributes.get(layout.name)) is not None:
        mesh.attributes.remove(attribute)


def write_attribute(mesh: bpy.types.Mesh, layout: PointAttribute, values: np.ndarray) -> None:
    # "position" exists as soon as there are vertices, and its name is reserved.
    attribute = mesh.attributes.get(layout.name) or mesh.attributes.new(layout.name, layout.data_type, "POINT")
    attribute.data.foreach_set(layout.property, _padded(values, layout.columns))


def _padded(values: np.ndarray, columns: int) -> np.ndarray:
    """`values` flattened, with each row padded to `columns` with zeros."""
    rows = values if values.ndim == 2 else values[:, None]
    if rows.shape[1] < columns:
        rows = np.pad(rows, ((0, 0), (0, columns - rows.shape[1])))
    return rows.ravel()
