# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads surfels from the point attributes of a mesh, or of a point cloud that modifiers made from one.

They follow the mesh where it was deformed, and stay the same `Surfels` as long as nothing changed.
"""

from __future__ import annotations

from typing import NamedTuple

import bpy
import numpy as np

from ...interchange import followed
from ...surfels import LAYOUT, OPTIONAL_LAYOUT, Surfels, usable_rows, valid_surfels
from ..ids import POINT_ATTRIBUTES, REST, SOLID, PointAttribute
from .offsets import Points, offset_of
from .reading import read_values

#: The attributes that are not floats.
_TYPES = {"INT": np.int32, "INT16_2D": np.int16}


def read_surfels(mesh: Points, offset: np.ndarray | None = None) -> tuple[Surfels, int]:
    """The surfels stored in `mesh`, and the number of unusable points left out, see `read_stored`."""
    return read_stored(mesh, offset=offset)[:2]


class Stored(NamedTuple):
    """surfels: None until a view that reads them slowly has any.
    skipped: number of unusable points, which were left out.
    strayed: number of surfels that were moved individually, so that their frames are unknown.
    """

    surfels: Surfels | None
    skipped: int
    strayed: int


def read_stored(
    mesh: Points,
    known: dict[str, tuple[Surfels, np.ndarray, Stored]] | None = None,
    name: str = "",
    is_solid: bool = False,
    offset: np.ndarray | None = None,
) -> Stored:
    """The surfels stored in `mesh`, with its offset as their origin; in a mesh with faces, the points that belong to no
    face.

    If centres have moved together since they were written, their frames are moved too (`interchange.followed`). This
    takes seconds per million surfels, so known caches the result by name (by default the mesh's) for as long as the
    values stay the same.
    is_solid: True if the mesh does not say so itself, but its source does. offset: that of the mesh in the .blend, if
    modifiers made this one.

    Attributes are found by name; optional ones may be missing. Raises ValueError if a required one is missing or has
    the wrong type, and for a mesh in edit mode, whose attributes do not contain the points (`Object.to_mesh()` does).
    NaN, zero or negative sizes and the like only drop the point concerned (see `valid_surfels`).
    """
    name = name or mesh.name_full
    arrays = {field: read_field(mesh, layout, name) for field, layout in stored_fields(mesh, name).items()}
    loose = _loose_points(mesh)
    arrays = arrays if loose is None else {name: values[loose] for name, values in arrays.items()}
    origin = offset_of(mesh) if offset is None else offset
    return stored_of(arrays, is_solid or bool(mesh.get(SOLID)), {} if known is None else known, name, origin)


#: Blender's types of one number.
_NUMBERS = ("FLOAT", "INT", "INT8", "BOOLEAN")


def read_beside(mesh: Points, attribute: str, skipped: int) -> np.ndarray | None:
    """(N,) float32 values of a point attribute of one number, of the surfels that `read_stored` gives; None if there is
    no such attribute. skipped: the number of unusable points."""
    found = mesh.attributes.get(attribute)
    if found is None or found.domain != "POINT" or found.data_type not in _NUMBERS:
        return None
    values = read_values(found.data, "value", 1, count_of(mesh))
    loose = _loose_points(mesh)
    values = values if loose is None else values[loose]
    if not skipped:
        return values
    name = mesh.name_full
    arrays = {f: read_field(mesh, of, name) for f, of in stored_fields(mesh, name).items() if f != REST_FIELD}
    arrays = arrays if loose is None else {name: column[loose] for name, column in arrays.items()}
    return values[usable_rows(**(arrays | {"scales": arrays["scales"][:, :2]}))]


#: The name in `stored_fields` of the centres as they were written.
REST_FIELD = "rest"


def stored_fields(mesh: Points, name: str) -> dict[str, PointAttribute]:
    """The attributes that make up the surfels of a mesh, by field. Raises ValueError as `read_stored`."""
    if getattr(mesh, "is_editmode", False):
        raise ValueError(
            f"The surfel mesh {mesh.name!r} is in edit mode, where its points cannot be read; leave edit mode."
        )
    there = (field for field in OPTIONAL_LAYOUT if POINT_ATTRIBUTES[field].name in mesh.attributes)
    fields = {field: POINT_ATTRIBUTES[field] for field in (*LAYOUT, *there)}
    if count_of(mesh):
        for layout in fields.values():
            _find(mesh, layout, name)
    rest = mesh.attributes.get(REST.name)
    if rest is not None and (rest.data_type, rest.domain) == (REST.data_type, "POINT"):
        fields[REST_FIELD] = REST
    return fields


def read_field(mesh: Points, layout: PointAttribute, name: str, values: np.ndarray | None = None) -> np.ndarray:
    """(N,) or (N, columns) values of one attribute. values: the array to read into, as `room_for` makes it."""
    values = room_for(layout, count_of(mesh)) if values is None else values
    if len(values):
        _find(mesh, layout, name).data.foreach_get(layout.property, values.ravel())
    return values


def read_rows(mesh: Points, layout: PointAttribute, name: str, rows: np.ndarray) -> np.ndarray:
    """(n,) or (n, columns) values of one attribute at a few points. Each takes 2 to 6 microseconds, a thousand times as
    long as `read_field` takes for one of many."""
    data, values = _find(mesh, layout, name).data, room_for(layout, len(rows))
    for value, row in enumerate(rows.tolist()):
        values[value] = getattr(data[row], layout.property)
    return values


def room_for(layout: PointAttribute, count: int) -> np.ndarray:
    """An array for the values of one attribute."""
    shape = (count, layout.columns) if layout.columns > 1 else count
    return np.empty(shape, _TYPES.get(layout.data_type, np.float32))


def stored_of(arrays: dict[str, np.ndarray], is_solid: bool, known: dict, name: str, origin: np.ndarray) -> Stored:
    """The surfels of arrays that were read by `stored_fields`; no Blender data is touched. known, name: as in
    `read_stored`. origin: of the surfels."""
    arrays = dict(arrays)
    rest = arrays.pop(REST_FIELD, None)
    arrays["scales"] = arrays["scales"][:, :2]
    surfels, skipped = valid_surfels(origin, is_solid, **arrays)
    if rest is None:
        return Stored(surfels, skipped, 0)
    if skipped:
        rest = rest[usable_rows(**arrays)]
    if np.array_equal(surfels.positions, rest):
        return Stored(surfels, skipped, 0)
    before = known.get(name)
    if before is not None and np.array_equal(before[1], rest) and have_same_values(before[0], surfels):
        return before[2]._replace(skipped=skipped)
    moved, strayed = followed(surfels, rest)
    known[name] = surfels, rest, Stored(moved, skipped, strayed)
    return known[name][2]


def count_of(mesh: Points) -> int:
    """The number of points."""
    return len(mesh.points if isinstance(mesh, bpy.types.PointCloud) else mesh.vertices)


def has_loose_points_only(mesh: Points) -> bool:
    """Whether all points are surfels, because the mesh has no faces."""
    return isinstance(mesh, bpy.types.PointCloud) or not mesh.polygons


def _loose_points(mesh: Points) -> np.ndarray | None:
    """(n,) points that belong to no face of a mesh with faces; None: all points are surfels."""
    if has_loose_points_only(mesh):
        return None
    is_loose = np.ones(len(mesh.vertices), bool)
    is_loose[read_values(mesh.attributes[".corner_vert"].data, "value", 1, len(mesh.loops), np.int32)] = False
    return np.flatnonzero(is_loose)


def have_same_values(a: Surfels, b: Surfels) -> bool:
    """Whether two sets of surfels have the same fields with the same values."""
    mine, other = a.arrays(), b.arrays()
    is_alike = a.is_solid == b.is_solid and mine.keys() == other.keys() and np.array_equal(a.origin, b.origin)
    return is_alike and all(np.array_equal(mine[name], other[name]) for name in mine)


def _find(mesh: Points, layout: PointAttribute, name: str) -> bpy.types.Attribute:
    wanted = f"{layout.data_type} on POINT"
    attribute = mesh.attributes.get(layout.name)
    if attribute is None:
        raise ValueError(
            f"The surfel mesh {name!r} has no attribute {layout.name!r}; "
            f"add it ({wanted}) or convert the source mesh again."
        )
    if (attribute.data_type, attribute.domain) != (layout.data_type, "POINT"):
        raise ValueError(
            f"The attribute {layout.name!r} of the surfel mesh {name!r} is {attribute.data_type} on "
            f"{attribute.domain}; convert it to {wanted}."
        )
    return attribute
