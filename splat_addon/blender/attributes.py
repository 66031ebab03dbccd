# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfels as ordinary point attributes of a vertex-only mesh, and back.

The store that works in every supported version, that Geometry Nodes, Cycles, EEVEE and the exporters read, and
that a .blend keeps bit for bit. The conversion operator writes it; the engine reads it, evaluated with modifiers.

Everything goes through `attributes[name].data.foreach_set` and `foreach_get` on flat arrays of the exact type:
`vertices.foreach_set("co")` takes a hundred times as long.
"""

from __future__ import annotations

import bpy
import numpy as np

from ..surfels import LAYOUT, OPTIONAL_LAYOUT, Surfels, valid_surfels
from .ids import POINT_ATTRIBUTES, SOLID, PointAttribute

#: An attribute by either name on a mesh without faces says "these points are surfels".
MARKS = tuple(POINT_ATTRIBUTES[field].name for field in ("rotations", "scales"))


def has_surfels(mesh: bpy.types.Mesh) -> bool:
    """Whether `mesh` is meant as surfels: no faces, and at least one of the attributes `rotation` and `scale`.

    One of them is enough, so that surfels which lost the other are met with the sentence of `read_surfels`
    and not passed over in silence.
    """
    return not mesh.polygons and any(name in mesh.attributes for name in MARKS)


def write_surfels(name: str, surfels: Surfels) -> bpy.types.Mesh:
    """A new vertex-only mesh that stores `surfels`; `surfels.origin` is left to the object's location."""
    mesh = bpy.data.meshes.new(name)
    mesh.vertices.add(len(surfels))
    for field, layout in POINT_ATTRIBUTES.items():
        values = getattr(surfels, field)
        if values is None:
            continue
        # "position" is there as soon as there are vertices, and its name is reserved.
        attribute = mesh.attributes.get(layout.name) or mesh.attributes.new(layout.name, layout.data_type, "POINT")
        attribute.data.foreach_set(layout.property, _padded(values, layout.columns))
    if surfels.is_solid:
        mesh[SOLID] = True
    mesh.update()
    return mesh


def read_surfels(mesh: bpy.types.Mesh) -> tuple[Surfels, int]:
    """The surfels that `mesh` stores, with origin (0, 0, 0), and how many unusable points were left out.

    Attributes are found by name; optional ones need not be there. Raises ValueError where another is missing or one is
    not of the stored type, and for a mesh in edit mode, whose points are not in its attributes then
    (`Object.to_mesh()` has them); NaN, zero and negative sizes and the like only cost their own point (see
    `valid_surfels`).
    """
    if mesh.is_editmode:
        raise ValueError(
            f"The surfel mesh {mesh.name!r} is in edit mode, where its points cannot be read; leave edit mode."
        )
    there = [field for field in OPTIONAL_LAYOUT if POINT_ATTRIBUTES[field].name in mesh.attributes]
    arrays = {field: _read(mesh, POINT_ATTRIBUTES[field]) for field in (*LAYOUT, *there)}
    arrays["scales"] = arrays["scales"][:, :2]
    return valid_surfels(is_solid=bool(mesh.get(SOLID)), **arrays)


def _padded(values: np.ndarray, columns: int) -> np.ndarray:
    """`values` flat, each row filled up to `columns` with zeros."""
    rows = values if values.ndim == 2 else values[:, None]
    if rows.shape[1] < columns:
        rows = np.pad(rows, ((0, 0), (0, columns - rows.shape[1])))
    return rows.ravel()


def _read(mesh: bpy.types.Mesh, layout: PointAttribute) -> np.ndarray:
    """(N,) or (N, columns) values of one attribute."""
    shape = (len(mesh.vertices), layout.columns) if layout.columns > 1 else len(mesh.vertices)
    values = np.empty(shape, np.int32 if layout.data_type == "INT" else np.float32)
    if len(values):
        _find(mesh, layout).data.foreach_get(layout.property, values.ravel())
    return values


def _find(mesh: bpy.types.Mesh, layout: PointAttribute) -> bpy.types.Attribute:
    wanted = f"{layout.data_type} on POINT"
    attribute = mesh.attributes.get(layout.name)
    if attribute is None:
        raise ValueError(
            f"The surfel mesh {mesh.name!r} has no attribute {layout.name!r}; "
            f"add it ({wanted}) or convert the source mesh again."
        )
    if (attribute.data_type, attribute.domain) != (layout.data_type, "POINT"):
        raise ValueError(
            f"The attribute {layout.name!r} of the surfel mesh {mesh.name!r} is {attribute.data_type} on "
            f"{attribute.domain}; convert it to {wanted}."
        )
    return attribute
