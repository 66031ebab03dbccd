# SPDX-License-Identifier: GPL-3.0-or-later
"""The colours that an object's settings choose in place of its own, for a picture: what is stored stays as it is."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial
from typing import NamedTuple

import bpy
import numpy as np

from ...interchange.scan_colors import CLASSES, GREYS, RAMP, ends_of, of_classes, on_ramp
from ...primaries import converted
from ...rendering.scene import Paint
from ...streaming import Stream, measured
from ...surfels import Surfels
from ..enum_values import check_choices
from ..geometry.derived import Derived
from ..geometry.offsets import offset_of
from ..geometry.reading import read_values
from ..ids import OBJECT_SETTINGS
from ..materials.ramps import table
from ..working_space import from_rec709


class Column(NamedTuple):
    """Numbers of the surfels of a mesh. digest: two columns with the same one are the same."""

    values: np.ndarray
    digest: int

    @classmethod
    def of(cls, values: np.ndarray) -> Column:
        return cls(values, hash(values.tobytes()))


def painter(object_: bpy.types.Object, store, points, key: int, skipped: int) -> Callable[..., Surfels]:
    """paint(surfels, notes=...) for an evaluated object, while its points can be read. store, points, key, skipped: as
    in `SurfelStore.column`."""
    attribute = getattr(object_.original, OBJECT_SETTINGS).color_column
    column = store.column(points, key, attribute, skipped) if attribute else None
    return partial(_scan_colored, object_=object_, column=column, derived=store.derived)


def _scan_colored(
    surfels: Surfels, object_: bpy.types.Object, column: Column | None, derived: Derived, notes
) -> Surfels:
    """The surfels in the colours that the object's settings choose. column: of the attribute that they show; None if
    there is none. derived: keeps them."""
    settings = getattr(object_.original, OBJECT_SETTINGS)
    check_choices(settings, "object properties")
    kind = settings.color_by
    if kind == "COLOR":
        return surfels
    if kind == "HEIGHT":
        row = _row(np.array(object_.matrix_world, np.float64))
        digest, values = row, partial(_heights, surfels, row)
    elif column is None:
        what = f"attribute {settings.color_column!r} of one number per point" if settings.color_column else "attribute"
        notes.add(f"{object_.name} has no {what} to be coloured by, and keeps its own colours")
        return surfels
    elif len(column.values) != len(surfels):  # some of them stand in for all while a view reads them
        return surfels
    else:
        digest, values = column.digest, lambda: column.values
    ramp, ends = _ramp(settings)
    key = kind, digest, ends, None if ramp is None else ramp.tobytes()
    return derived.get(surfels, key, lambda: _painted(surfels, _colors(kind, values(), ramp, ends)))


def stream_paint(object_: bpy.types.Object, stream: Stream, to_origin: np.ndarray, notes) -> Paint | None:
    """The colours that an evaluated object's settings choose for what views read from its file. stream: reads it.
    to_origin: (4, 4) from its coordinates to the object's."""
    settings = getattr(object_.original, OBJECT_SETTINGS)
    check_choices(settings, "object properties")
    kind = settings.color_by
    if kind == "COLOR":
        return None
    name = settings.color_column
    if kind != "HEIGHT" and name not in stream.file.scan:
        notes.add(
            f"{object_.name} keeps its own colours, as its file holds no {name or 'such numbers'}; "
            "store it with these colours, or colour it by height"
        )
        return None
    ramp, ends = _ramp(settings)
    if kind != "HEIGHT":
        held = low, high = stream.file.scan[name]
        if ends[0] is not None and (ends[0] < low or ends[1] > high):
            notes.add(
                f"{object_.name}: its file holds {name} from {low:,g} to {high:,g}; what is beyond is shown as these"
            )
        return _paint_of_scan(kind, name, held, ramp, ends)
    row = _row(np.array(object_.matrix_world, np.float64) @ to_origin)
    if settings.color_is_automatic:  # of all that is in the file, and not of what a view happens to read
        ends = ends_of(_heights_of_kept(object_))
    key = row, ends, None if ramp is None else ramp.tobytes()
    return Paint(key, lambda surfels, _: _painted(surfels, _colors(kind, _heights(surfels, row), ramp, ends)))


def _paint_of_scan(kind: str, name: str, held: tuple[float, float], ramp: np.ndarray | None, ends) -> Paint:
    """Colours of numbers that a file has, of which the bytes 0 and 255 stand for those held."""
    if ends[0] is None:  # of all that is in the file, or of the standard's classes
        ends = (0, len(CLASSES) - 1) if name == "classification" else held
    key = kind, name, ends, None if ramp is None else ramp.tobytes()

    def of(surfels: Surfels, scan: dict[str, np.ndarray]) -> Surfels:
        return _painted(surfels, _colors(kind, measured(scan[name], *held), ramp, ends))

    return Paint(key, of)


def _heights_of_kept(object_: bpy.types.Object) -> np.ndarray:
    """The world's Z of the surfels that the mesh of an evaluated object keeps of its file."""
    mesh, row = object_.original.data, np.array(object_.matrix_world, np.float64)[2]
    kept = mesh.attributes["position"].data  # empty in edit mode
    places = read_values(kept, "vector", 3, len(kept))
    return (places + offset_of(mesh)) @ row[:3] + row[3]


def _row(matrix: np.ndarray) -> tuple[float, ...]:
    """What gives the world's Z, of a (4, 4) matrix to the world."""
    return tuple(matrix[2].tolist())


def _ramp(settings) -> tuple[np.ndarray | None, tuple[float | None, float | None]]:
    """The (n, 3) colours of the object's own ramp, if it has one, and the values at its ends; None: automatic ones."""
    texture = settings.color_ramp
    ramp = table(texture.color_ramp)[:, :3].clip(0) if texture is not None and texture.use_color_ramp else None
    return ramp, (None, None) if settings.color_is_automatic else (settings.color_from, settings.color_to)


def _heights(surfels: Surfels, row: tuple[float, ...]) -> np.ndarray:
    """The world's Z of surfels. row: of the matrix from their space to the world."""
    return surfels.positions.astype(np.float64) @ row[:3] + (surfels.origin @ row[:3] + row[3])


def _colors(kind: str, values: np.ndarray, ramp: np.ndarray | None, ends) -> np.ndarray:
    """(N, 3) colours in the file's working space."""
    if ramp is not None:
        return on_ramp(values, ramp, *ends)
    if kind == "CLASSIFICATION":
        return converted(of_classes(values), from_rec709())
    return converted(on_ramp(values, GREYS if kind == "INTENSITY" else RAMP, *ends), from_rec709())


def _painted(surfels: Surfels, colors: np.ndarray) -> Surfels:
    """The surfels in these colours, with their own opacity and without images."""
    own = {name: None for name in ("uvs", "uv_along_x", "uv_along_y", "uv_border")}
    return replace(surfels, colors=np.column_stack([colors, surfels.colors[:, 3]]).astype(np.float32), **own)
