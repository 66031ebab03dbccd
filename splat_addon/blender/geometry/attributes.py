# SPDX-License-Identifier: GPL-3.0-or-later
"""Stores surfels as ordinary point attributes of a vertex-only mesh and reads them back, also from a point cloud that
modifiers made from such a mesh.

This storage works in every supported version; Geometry Nodes, Cycles, EEVEE and the exporters can read it, and a .blend
keeps it bit for bit. The conversion operator writes it; the engine reads it, evaluated with modifiers.

Everything goes through `attributes[name].data.foreach_set` and `foreach_get` on flat arrays of the exact type:
`vertices.foreach_set("co")` takes a hundred times as long.
"""

from __future__ import annotations

from typing import NamedTuple

import bpy
import numpy as np

from ...interchange import followed
from ...surfels import LAYOUT, OPTIONAL_LAYOUT, Surfels, valid_surfels
from .. import working_space
from ..ids import OFFSET, POINT_ATTRIBUTES, PRIMARIES, REST, SOLID, PointAttribute
from .gaussian_clouds import is_gaussian_cloud
from .reading import read_values

#: Data-blocks whose points can be surfels.
Points = bpy.types.Mesh | bpy.types.PointCloud

#: An attribute with either name on a mesh without faces marks the points as surfels.
MARKS = tuple(POINT_ATTRIBUTES[field].name for field in ("rotations", "scales"))


#: How far the matrices of one working space differ between versions of Blender; those of two differ by tenths.
_SAME_SPACE = 1e-3

#: The attributes that are not floats.
_TYPES = {"INT": np.int32, "INT16_2D": np.int16}


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


def offset_of(mesh: bpy.types.ID) -> np.ndarray:
    """What is added to the positions of a surfel mesh of the .blend, (3,) float64. What modifiers make of the mesh has
    no such property, but the same offset."""
    return numbers_of(mesh, OFFSET, 3, np.zeros(3))


def numbers_of(owner: bpy.types.ID, name: str, count: int, otherwise: np.ndarray) -> np.ndarray:
    """(count,) float64 of a custom property, if it holds so many finite numbers."""
    values = np.ravel(owner.get(name, ()))
    is_known = values.shape == (count,) and np.issubdtype(values.dtype, np.number) and np.isfinite(values).all()
    return values.astype(np.float64) if is_known else otherwise


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
    return values[_usable_rows(arrays | {"scales": arrays["scales"][:, :2]})]


def _usable_rows(arrays: dict[str, np.ndarray]) -> np.ndarray:
    """Which rows `valid_surfels` takes: their numbers take the materials' way."""
    numbers = np.where(arrays["materials"] < 0, -1, np.arange(len(arrays["materials"])))
    return valid_surfels(**(arrays | {"materials": numbers}))[0].materials


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
        rest = rest[_usable_rows(arrays)]
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


def _padded(values: np.ndarray, columns: int) -> np.ndarray:
    """`values` flattened, with each row padded to `columns` with zeros."""
    rows = values if values.ndim == 2 else values[:, None]
    if rows.shape[1] < columns:
        rows = np.pad(rows, ((0, 0), (0, columns - rows.shape[1])))
    return rows.ravel()


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
