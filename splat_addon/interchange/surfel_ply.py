# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfels as a lossless PLY file, using property names that other programs know where such names exist.

| property | type | meaning |
|---|---|---|
| x y z | float; double where the surfels' origin is not 0 | position, origin included |
| nx ny nz | float | shading normal |
| red green blue alpha | uchar | colour as other programs show it: sRGB, opacity |
| color_0 .. color_3 | float | colour, scene-linear, and opacity: the exact one |
| rot_0 .. rot_3 | float | quaternion w x y z; its z axis is the geometric normal |
| scale_0 scale_1 | float | half-axes along the quaternion's x and y axes, not logarithms |
| radius | float | the larger half-axis |
| material | int | index of the material slot |
| roughness, metallic, emission_0 .. emission_2, uvs_0 ... | float | where the surfels have them (`OPTIONAL_LAYOUT`) |
| clip_line_0, clip_line_1, clip_line_2_0, clip_line_2_1 | short | likewise, packed as `clip_lines` says |
| normal_along_x_0 .., normal_along_y_0 .. | short | likewise, packed as `Surfels` says |

Comments: "surfel_splatting 1"; "origin X Y Z" if it is not 0; "solid" if the surfels are solid.
"""

from __future__ import annotations

import os
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

import numpy as np

from ..doubts import clear_count, doubts_of_transparency
from ..surfels import LAYOUT, OPTIONAL_LAYOUT, Surfels, faults_of, valid_surfels
from .columns import (
    NORMAL,
    POSITION,
    ROTATION,
    VERSION,
    as_columns,
    display_color,
    has,
    linear_to_srgb,
    matrix,
    numbers_of,
    origin_for,
)
from .placement import joined, parts_of, world_positions
from .ply_file import read_vertices, vertex_count, vertex_portions, write_vertices
from .ply_header import is_ply

#: Bytes at the beginning of a file that tell whether it is PLY.
_FIRST = 4096

_ORIGIN, _SOLID = "origin", "solid"
_SCALE = ("scale_0", "scale_1")
_COLOR = ("color_0", "color_1", "color_2", "color_3")
_DISPLAY_COLOR = ("red", "green", "blue", "alpha")
_WHITE = (1.0, 1.0, 1.0, 1.0)
_NO_SURFELS = "The PLY file does not hold surfels: of x y z, nx ny nz, rot_0..3, scale_0..1 one is missing."

#: optional field -> its properties
_OPTIONAL = {
    name: tuple(f"{name}_{k}" for k in range(columns)) if columns > 1 else (name,)
    for name, (columns, _, _) in OPTIONAL_LAYOUT.items()
}


@dataclass(frozen=True, eq=False)
class StoredSurfels:
    """Surfels read from a file.

    faults: why a row is unusable -> number of rows; a row may have several. unusable: number of such rows.
    said: sentences about how they were read.
    """

    surfels: Surfels
    unusable: int
    faults: dict[str, int] = field(default_factory=dict)
    said: tuple[str, ...] = ()

    def notes(self) -> list[str]:
        """A sentence about what was left out, and others about what was assumed."""
        why = ", ".join(f"{count:,} with {fault}" for fault, count in self.faults.items())
        skipped = f"Skipped {self.unusable:,} unusable surfels: {why}"
        return [*[skipped] * bool(self.unusable), *self.said]


def write_ply(path: str | os.PathLike, surfels: Surfels | Sequence[Surfels], ascii: bool = False) -> list[str]:
    """Write all fields of `surfels`, one set or several, in the layout above. Returns sentences about what was lost,
    which is nothing. Raises OSError if the file cannot be written."""
    parts = parts_of(surfels)
    surfels, has_origin = joined(parts), any(part.origin.any() for part in parts)
    positions = world_positions(parts) if has_origin else surfels.positions
    shown = np.clip(surfels.colors.astype(np.float64), 0, 1)
    shown[:, :3] = linear_to_srgb(shown[:, :3])
    columns = {
        **as_columns(POSITION, positions),
        **as_columns(NORMAL, surfels.normals),
        **as_columns(_DISPLAY_COLOR, np.rint(255 * shown).astype(np.uint8)),
        **as_columns(_COLOR, surfels.colors),
        **as_columns(ROTATION, surfels.rotations),
        **as_columns(_SCALE, surfels.scales),
        "radius": surfels.radius,
        "material": surfels.materials,
    }
    for name, properties in _OPTIONAL.items():
        values = getattr(surfels, name)
        if values is not None:
            columns |= as_columns(properties, values.reshape(len(surfels), len(properties)))
    origin = " ".join(repr(float(value)) for value in surfels.origin)
    comments = [VERSION, *([f"{_ORIGIN} {origin}"] * has_origin), *([_SOLID] * surfels.is_solid)]
    write_vertices(path, columns, tuple(comments), ascii)
    return []


def read_ply(path: str | os.PathLike) -> Surfels:
    """Read a file that `write_ply` made. With an origin of 0 the result is bit-identical; otherwise positions are exact
    to 16 digits of the coordinate.

    Raises ValueError with one sentence for a damaged file, another layout, or rows that are not surfels.
    """
    columns, comments, _ = read_vertices(path)
    if not is_surfels(columns):
        raise ValueError(_NO_SURFELS)
    return Surfels(**_fields(columns, comments)[0])


class PlyPortions:
    """The usable surfels of a file that `write_ply` made, a million at a time; it can be iterated again.

    unusable: number of rows that the last iteration left out. Raises as `read_ply`, but unusable rows are no error.
    """

    def __init__(self, path: str | os.PathLike, most: int = 1 << 20):
        self._path, self._most = path, most
        self._forget()

    def _forget(self) -> None:
        self.unusable = self._clear = self._count = 0
        self._said: dict[str, None] = {}

    def notes(self) -> list[str]:
        """A sentence about each thing that the last iteration left out, assumed or found doubtful."""
        skipped = [f"Skipped {self.unusable:,} unusable surfels"] * bool(self.unusable)
        return [*skipped, *self._said, *doubts_of_transparency(self._clear, self._count)]

    def __len__(self) -> int:
        """The number of rows that the file says it has."""
        return vertex_count(self._path)

    def __iter__(self) -> Iterator[Surfels]:
        self._forget()
        for columns, comments, _ in vertex_portions(self._path, self._most):
            if not is_surfels(columns):
                raise ValueError(_NO_SURFELS)
            part = stored_surfels(columns, comments)
            self.unusable += part.unusable
            self._said |= dict.fromkeys(part.said)
            self._clear, self._count = self._clear + clear_count(part.surfels), self._count + len(part.surfels)
            yield part.surfels


def is_surfel_ply(path: str | os.PathLike) -> bool:
    """Whether a file has this layout. Raises ValueError with a sentence for a damaged PLY file, OSError."""
    with open(path, "rb") as stream:
        if not is_ply(stream.read(_FIRST)):
            return False
    return is_surfels(next(vertex_portions(path, 1)).columns)


def is_surfels(columns: dict[str, np.ndarray]) -> bool:
    """Whether the columns have the layout above; Gaussians use the same names for their scales, with another
    meaning."""
    return has(columns, POSITION, NORMAL, ROTATION, _SCALE) and not has(columns, ("opacity",))


def stored_surfels(columns: dict[str, np.ndarray], comments: tuple[str, ...], floats: str = "DISPLAY") -> StoredSurfels:
    """The usable rows. floats: as in `display_color`. Raises ValueError if a comment is damaged."""
    fields, said = _fields(columns, comments, floats)
    surfels, unusable = valid_surfels(**fields)
    return StoredSurfels(surfels, unusable, faults_of(**fields) if unusable else {}, tuple(said))


def _fields(columns: dict[str, np.ndarray], comments: tuple[str, ...], floats: str = "DISPLAY") -> tuple[dict, list]:
    """The arguments of `valid_surfels`, and what was assumed."""
    origin, positions = numbers_of(comments, _ORIGIN), matrix(columns, POSITION, np.float64)
    if origin is None:
        origin = origin_for(positions[np.isfinite(positions).all(axis=1)])
    # Infinite values stay infinite or become NaN, and are counted as unusable.
    with np.errstate(over="ignore", invalid="ignore"):
        positions = (positions - origin).astype(np.float32)
    colors, said = (matrix(columns, _COLOR), []) if has(columns, _COLOR) else display_color(columns, floats)
    if colors is None:
        colors = np.tile(np.float32(_WHITE), (len(positions), 1))
        said = [f"Took white as the colour of {len(positions):,} surfels, which have none"]
    material = columns["material"].astype(np.float64) if "material" in columns else np.zeros(len(positions))
    optional = {name: matrix(columns, group) for name, group in _OPTIONAL.items() if has(columns, group)}
    fields = {
        "positions": positions,
        "rotations": matrix(columns, ROTATION),
        "scales": matrix(columns, _SCALE),
        "normals": matrix(columns, NORMAL),
        "colors": colors,
        "materials": np.clip(np.nan_to_num(material), -1, 2**31 - 1).astype(LAYOUT["materials"][1]),
        "origin": origin,
        "is_solid": _SOLID in comments,
        **{name: values if len(_OPTIONAL[name]) > 1 else values[:, 0] for name, values in optional.items()},
    }
    return fields, said
