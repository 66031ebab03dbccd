# SPDX-License-Identifier: GPL-3.0-or-later
"""The central data model: a set of oriented elliptical surface samples.

A *surfel* keeps its ellipse (position, frame, half-axes) apart from its shading normal: the ellipse shapes the splat,
the normal lights it. Positions are float32 relative to a float64 origin, so a model far from the world origin loses no
precision.
"""

from __future__ import annotations

from copy import copy
from dataclasses import dataclass, fields, replace
from functools import cached_property
from typing import Self

import numpy as np

from .clip_lines import CLIP_FIELDS, are_reflex, unpack_lines
from .large_surfels import grains
from .quaternions import quaternion_axes

#: Cells along each edge of the lattice of `Surfels.local_hull`, and surfels that are put into it at a time.
_HULL_CELLS = 16
_HULL_AT_ONCE = 1 << 18

#: field -> (columns, dtype); one column is stored flat.
LAYOUT = {
    "positions": (3, np.float32),
    "rotations": (4, np.float32),
    "scales": (2, np.float32),
    "normals": (3, np.float32),
    "colors": (4, np.float32),
    "materials": (1, np.int32),
}

#: Optional fields, None where the scene does not need them: field -> (columns, dtype, default). The default, one number
#: for all columns, is what a set without the field means: Principled's own default, or no texture.
OPTIONAL_LAYOUT = {
    "roughness": (1, np.float32, 0.5),
    "metallic": (1, np.float32, 0.0),
    "emission": (3, np.float32, 0.0),
    "uvs": (2, np.float32, 0.0),
    "uv_along_x": (2, np.float32, 0.0),
    "uv_along_y": (2, np.float32, 0.0),
    "uv_border": (2, np.float32, 0.0),
    "clip_line": (2, np.int16, 0),
    "clip_line_2": (2, np.int16, 0),
    "blend_depth": (1, np.float32, 1.0),
    "lift": (1, np.float32, 0.0),
    "hidden_back": (1, np.float32, 0.0),
    "normal_along_x": (2, np.int16, 0),
    "normal_along_y": (2, np.int16, 0),
}

#: Minimum alpha of an opaque surfel: filtering an image of ones can leave alpha slightly below 1.
OPAQUE = 0.999

#: Minimum of `Surfels.hidden_back` of a surfel that is not drawn from behind; a mean of ones can be slightly below 1.
HIDDEN = 0.999

#: A surface whose opacity is less than this from 0 or 1 is clear or opaque in shadows (lib/screen_door.glsl). Of
#: the opaque area of a cut-out, this share may be neither: the blurred edges of a leaf's image.
_CLEAR, _BLURRED = 1 / 32, 0.75

#: How far a quaternion or normal may deviate from unit length before it is rejected (float32 rounding is 1e-7).
UNIT_TOLERANCE = 1e-3


@dataclass(frozen=True, eq=False, kw_only=True)
class Shape:
    """Fields shared by surfels and polygon corners (N of either), apart from positions and colours.

    origin: (3,) float64, object units, that positions are relative to.
    is_solid: the surface bounds a solid, so from outside no back face is ever visible (`sampling.is_solid`).
    roughness, metallic: (N,) float32, 0 to 1, overriding the material; None: use the material's.
    emission: (N, 3) float32, scene-linear radiance, overriding the material; None: use the material's.
    uvs: (N, 2) float32 coordinates into the instance's textures; None: no textures.
    """

    origin: np.ndarray = (0.0, 0.0, 0.0)
    is_solid: bool = False
    roughness: np.ndarray | None = None
    metallic: np.ndarray | None = None
    emission: np.ndarray | None = None
    uvs: np.ndarray | None = None

    def __len__(self) -> int:
        """The number of surfels or corners."""
        return len(self.positions)

    @property
    def has_own_material(self) -> bool:
        """Whether any material value is stored per surfel or corner."""
        return not all(a is None for a in (self.roughness, self.metallic, self.emission))

    def take(self, rows: np.ndarray) -> Self:
        """Some of the surfels, or corners. rows: indices, or a mask."""
        own = {f.name: getattr(self, f.name) for f in fields(self) if f.name not in ("origin", "is_solid")}
        return replace(self, **{name: array[rows] for name, array in own.items() if array is not None})

    @cached_property
    def brightest(self) -> float:
        """The largest absolute colour component (0 if empty)."""
        return float(np.abs(self.colors[:, :3]).max(initial=0.0))


@dataclass(frozen=True, eq=False)
class Surfels(Shape):
    """A set of N surfels as C-contiguous arrays, which are validated once, here.

    positions: (N, 3) float32, object units, relative to `origin`.
    rotations: (N, 4) float32 unit quaternions w, x, y, z; local x and y are the ellipse's axes,
        local z is the geometric normal.
    scales: (N, 2) float32, half-axes of the ellipse, object units, > 0.
    normals: (N, 3) float32, unit: the shading normal.
    colors: (N, 4) float32, scene-linear, not premultiplied; alpha is opacity.
    materials: (N,) int32, index into the object's material slots.
    uv_along_x, uv_along_y: (N, 2) change of `uvs` from the centre to the end of the local x and y half-axis. Where both
        are 0, or if any of the three fields is missing, `colors` is shown instead of a texture.
    uv_border: (N, 2) m of a line m . q = 1, q in half-axes, beyond which the texture is not sampled; 0 or None: no
        line.
    clip_line, clip_line_2: (N, 2) int16, up to two lines at which the splat ends, packed by `clip_lines` into 4 bytes
        each; 0 or None: no line.
    blend_depth: (N,) float32, 0 to 1, the depth within which the splat blends with others, in units of the longer
        half-axis: how far splats of the same surface lie off its plane. The renderer's epsilon is an upper bound; None:
        the epsilon everywhere.
    lift: (N,) float32, 0 or more, how high the smooth surface that shading normals describe lies above the splat, in
        units of the longer half-axis; None: nowhere.
    hidden_back: (N,) float32, 0 to 1, the share of the splat's back that is the other side of a card, which has surfels
        of its own: an opaque splat whose back is all hidden is not drawn from behind; None: 0.
    normal_along_x, normal_along_y: (N, 2) int16, change of `normals` from the centre to the end of the local x and y
        half-axis, packed by `normal_fields` into 4 bytes each; None: none.

    Raises ValueError with one sentence for a wrong shape, a non-finite or an out-of-range value;
    `valid_surfels` drops and counts such rows instead.
    """

    positions: np.ndarray
    rotations: np.ndarray
    scales: np.ndarray
    normals: np.ndarray
    colors: np.ndarray
    materials: np.ndarray
    uv_along_x: np.ndarray | None = None
    uv_along_y: np.ndarray | None = None
    uv_border: np.ndarray | None = None
    clip_line: np.ndarray | None = None
    clip_line_2: np.ndarray | None = None
    blend_depth: np.ndarray | None = None
    lift: np.ndarray | None = None
    hidden_back: np.ndarray | None = None
    normal_along_x: np.ndarray | None = None
    normal_along_y: np.ndarray | None = None

    def __post_init__(self):
        arrays = _shaped(self.arrays())
        for name, good in _row_checks(arrays).items():
            if not good.all():
                bad = np.flatnonzero(~good)
                value, demand = arrays[name][bad[0]].tolist(), _DEMANDS.get(name, "finite")
                raise ValueError(
                    f"{len(bad)} of {len(good)} surfels have unusable {name}, first row {bad[0]}: {value}; "
                    f"they must be {demand} (valid_surfels drops such rows)."
                )
        origin = np.array(self.origin, np.float64)
        if origin.shape != (3,) or not np.isfinite(origin).all():
            raise ValueError(f"The surfels' origin must be 3 finite numbers, not {self.origin!r}.")
        for name, array in (*arrays.items(), ("origin", origin)):
            view = array.view()
            view.flags.writeable = False
            object.__setattr__(self, name, view)

    def arrays(self) -> dict[str, np.ndarray]:
        """The arrays by field, in layout order, without the optional fields that are absent."""
        names = (*LAYOUT, *OPTIONAL_LAYOUT)
        return {name: getattr(self, name) for name in names if getattr(self, name) is not None}

    @property
    def radius(self) -> np.ndarray:
        """(N,) float32: the larger half-axis, object units."""
        return np.maximum(self.scales[:, 0], self.scales[:, 1])

    def half_axes(self) -> tuple[np.ndarray, np.ndarray]:
        """The two half-axis vectors of each ellipse: two (N, 3) float32 arrays, object units."""
        x, y, _ = quaternion_axes(self.rotations, 2)
        return x * self.scales[:, :1], y * self.scales[:, 1:]

    @property
    def has_uvs(self) -> bool:
        """Whether every point of the ellipses has texture coordinates."""
        return not any(a is None for a in (self.uvs, self.uv_along_x, self.uv_along_y))

    @property
    def is_clipped(self) -> bool:
        """Whether any surfel may be cut by a clip line."""
        return self.clip_line is not None or self.clip_line_2 is not None

    @property
    def normals_change(self) -> bool:
        """Whether any shading normals may change over their surfels."""
        return self.normal_along_x is not None or self.normal_along_y is not None

    def is_cut(self) -> np.ndarray:
        """(n,) bool: which surfels a clip line actually cuts."""
        cuts = (lines[:, 1] > 0 for lines in (self.clip_line, self.clip_line_2) if lines is not None)
        return np.logical_or.reduce([np.zeros(len(self), bool), *cuts])

    @cached_property
    def clipped_count(self) -> int:
        """Number of surfels that a clip line cuts."""
        return int(np.count_nonzero(self.is_cut())) if self.is_clipped else 0

    def clip_lines(self) -> tuple[np.ndarray, np.ndarray]:
        """(N, 2, 3) float64 lines a u + b v + c >= 0 of unit direction in half-axes, and (N,) bool, which surfels'
        lines make a reflex corner (`clip_lines.kept`)."""
        first, second = (field_values(self, name) for name in CLIP_FIELDS)
        return np.stack([unpack_lines(first), unpack_lines(second)], axis=1), are_reflex(first, second)

    def as_solid(self) -> Surfels:
        """The same surfels, marked as solid; the arrays are shared."""
        solid = copy(self)
        object.__setattr__(solid, "is_solid", True)
        return solid

    def as_transparent(self) -> Surfels:
        """The same surfels as part of a surface that lets light through, here or elsewhere; the arrays are shared."""
        part = copy(self)
        vars(part)["is_transparent"] = True
        return part

    def geometric_normals(self) -> np.ndarray:
        """(N, 3) float32 unit normals of the ellipses' planes."""
        return quaternion_axes(self.rotations)[2]

    @cached_property
    def is_transparent(self) -> bool:
        """Whether any surfel lets light through."""
        return bool((self.colors[:, 3] < OPAQUE).any())

    @cached_property
    def transparent_slots(self) -> tuple[int, ...]:
        """The materials of surfels that let light through."""
        return tuple(np.unique(self.materials[self.colors[:, 3] < OPAQUE]).tolist())

    @cached_property
    def is_cut_out(self) -> bool:
        """Whether nearly all of the surface is either clear or opaque, as where an image cuts leaves out of cards."""
        opacity, areas = self.colors[:, 3], self.scales.prod(axis=1)
        partly, wholly = (
            float(areas[which].sum()) for which in ((opacity > _CLEAR) & (opacity < 1 - _CLEAR), opacity >= 1 - _CLEAR)
        )
        return partly <= _BLURRED * wholly

    @cached_property
    def largest(self) -> float:
        """The longest half-axis, object units (0 when empty)."""
        return float(self.scales.max(initial=0.0))

    @cached_property
    def largest_grain(self) -> float:
        """The longest half-axis, but of the samples that large surfels replace, object units (0 when empty)."""
        share = 1.0 if self.blend_depth is None else grains(self.blend_depth)
        return float((self.radius * share).max(initial=0.0))

    @cached_property
    def local_bounds(self) -> tuple[np.ndarray, np.ndarray]:
        """Two (3,) float64 corners, relative to `origin`, of a box around all ellipses (NaN when empty)."""
        if not len(self):
            return np.full(3, np.nan), np.full(3, np.nan)
        margin = self.largest
        columns = self.positions.T
        low, high = (np.array([end(column) for column in columns], np.float64) for end in (np.min, np.max))
        return low - margin, high + margin

    @cached_property
    def local_hull(self) -> np.ndarray:
        """(n, 3) float64 positions relative to `origin` whose convex hull holds all ellipses, tighter than the box.

        They are corners of boxes, one around the centres in each row of a lattice, enlarged by the longest half-axis.
        """
        low, high = self.local_bounds
        if not len(self):
            return np.empty((0, 3))
        low, high = low + self.largest, high - self.largest
        cell = np.maximum(high - low, 1e-30) / _HULL_CELLS
        is_full = np.zeros((_HULL_CELLS,) * 3, bool)
        for start in range(0, len(self), _HULL_AT_ONCE):
            # What overflows in a lattice of huge extent is in its first or last cells.
            with np.errstate(over="ignore", invalid="ignore"):
                places = (self.positions[start : start + _HULL_AT_ONCE] - np.float32(low)) * np.float32(1 / cell)
            is_full[tuple(np.clip(np.nan_to_num(places), 0, _HULL_CELLS - 1).astype(np.int32).T)] = True
        y, z = np.nonzero(is_full.any(axis=0))
        rows = is_full[:, y, z]
        first = np.stack([rows.argmax(axis=0), y, z], axis=1)
        last = np.stack([_HULL_CELLS - rows[::-1].argmax(axis=0), y + 1, z + 1], axis=1)
        ends = low + first * cell - self.largest, low + last * cell + self.largest
        corners = [np.stack([ends[k >> axis & 1][:, axis] for axis in range(3)], axis=1) for k in range(8)]
        return np.concatenate(corners)


def valid_surfels(origin=(0.0, 0.0, 0.0), is_solid=False, **arrays) -> tuple[Surfels, int]:
    """`Surfels` made of the usable rows, and the number of rows left out.

    arrays: the fields of `Surfels`, with or without the optional ones. Quaternions and normals of any finite,
    non-zero length are normalised first (an attribute edited by hand or by Geometry Nodes is seldom unit); a zero or
    non-finite normal, a non-positive half-axis or a non-finite number drops its row.
    Raises ValueError where a whole array has the wrong shape.
    """
    arrays = _shaped(arrays)
    for name in ("rotations", "normals"):
        arrays[name] = _normalised(arrays[name])
    good = are_usable(arrays)
    skipped = int(len(good) - np.count_nonzero(good))
    if skipped:
        arrays = {name: array[good] for name, array in arrays.items()}
    return Surfels(origin=origin, is_solid=is_solid and not skipped, **arrays), skipped


def are_usable(arrays: dict[str, np.ndarray]) -> np.ndarray:
    """(N,) bool: which rows of some fields `Surfels` would take. arrays: in their shapes and types."""
    return np.logical_and.reduce(list(_row_checks(arrays).values()))


def faults_of(**fields) -> dict[str, int]:
    """What makes rows of the arguments of `valid_surfels` unusable -> the number of such rows."""
    arrays = _shaped({name: fields[name] for name in (*LAYOUT, *OPTIONAL_LAYOUT) if name in fields})
    arrays |= {name: _normalised(arrays[name]) for name in ("rotations", "normals")}
    bad = {name: int(len(good) - np.count_nonzero(good)) for name, good in _row_checks(arrays).items()}
    return {f"{name} that are not {_DEMANDS.get(name, 'finite')}": count for name, count in bad.items() if count}


def concatenate(parts: list[Surfels]) -> Surfels:
    """One set from several that share an origin.

    The result has an optional field if any part has it; other parts are filled with its default from OPTIONAL_LAYOUT.
    """
    if any((p.origin != parts[0].origin).any() for p in parts):
        raise ValueError("Only surfels with the same origin can be joined; move them to one origin first.")
    there = [n for n in OPTIONAL_LAYOUT if any(getattr(p, n) is not None for p in parts)]
    joined = {n: np.concatenate([field_values(p, n) for p in parts]) for n in (*LAYOUT, *there)}
    return Surfels(origin=parts[0].origin, is_solid=all(p.is_solid for p in parts), **joined)


def portions(surfels: Surfels, size: int, run: range | None = None) -> tuple[Surfels, ...]:
    """Consecutive runs of at most `size` surfels that share the arrays; the set itself if it is small enough. run: of
    these surfels only, without steps; nothing if it is empty."""
    if run is None:
        run = range(len(surfels))
        if len(surfels) <= size:
            return (surfels,)
    runs = (slice(start, min(start + size, run.stop)) for start in range(run.start, run.stop, size))
    return tuple(
        Surfels(
            origin=surfels.origin,
            is_solid=surfels.is_solid,
            **{name: array[run] for name, array in surfels.arrays().items()},
        )
        for run in runs
    )


def prepared(parts: tuple[Surfels, ...]) -> tuple[Surfels, ...]:
    """The same sets, with what every picture asks for found already; a thread may do that."""
    for part in parts:
        _ = (
            part.is_transparent,
            part.local_bounds,
            part.local_hull,
            part.largest,
            part.largest_grain,
            part.clipped_count,
            part.brightest,
        )
    return parts


def empty_surfels(origin=(0.0, 0.0, 0.0)) -> Surfels:
    """A set of no surfels."""
    return Surfels(origin=origin, **{n: np.zeros((0, c) if c > 1 else 0, t) for n, (c, t) in LAYOUT.items()})


#: Fields with requirements beyond being finite.
_DEMANDS = {
    "rotations": "unit quaternions",
    "scales": "finite and above 0",
    "normals": "unit vectors",
    "materials": "0 or more",
    "clip_line": "a direction and a cut of 0 or more",
    "clip_line_2": "a direction and a cut of 0 or more",
    "blend_depth": "0 to 1",
    "lift": "finite and 0 or more",
    "hidden_back": "0 to 1",
}


def field_values(surfels: Surfels, name: str) -> np.ndarray:
    """A field, or its default if it is an optional field that these surfels lack."""
    if getattr(surfels, name) is not None:
        return getattr(surfels, name)
    columns, dtype, value = OPTIONAL_LAYOUT[name]
    return np.full((len(surfels), columns) if columns > 1 else len(surfels), value, dtype)


def _shaped(arrays: dict) -> dict[str, np.ndarray]:
    missing = LAYOUT.keys() - arrays.keys()
    if missing:
        raise ValueError(f"Surfels need {', '.join(sorted(missing))}, which are missing.")
    unknown = arrays.keys() - LAYOUT.keys() - OPTIONAL_LAYOUT.keys()
    if unknown:
        raise ValueError(f"Surfels have no {', '.join(sorted(unknown))}.")
    layouts = {n: layout for n, layout in (LAYOUT | OPTIONAL_LAYOUT).items() if arrays.get(n) is not None}
    with np.errstate(over="ignore", invalid="ignore"):
        # values beyond float32's range become infinite, and are rejected as such
        arrays = {n: np.ascontiguousarray(arrays[n], layout[1]) for n, layout in layouts.items()}
    count = len(arrays["positions"])
    for name, array in arrays.items():
        columns = layouts[name][0]
        wanted = (count, columns) if columns > 1 else (count,)
        if array.shape != wanted:
            raise ValueError(f"Surfel {name} must have shape {wanted}, not {array.shape}.")
    return arrays


def _row_checks(arrays: dict[str, np.ndarray]) -> dict[str, np.ndarray]:
    """field -> (N,) bool: which rows are usable. Written so that NaN counts as unusable."""
    count = len(arrays["positions"])
    good = {name: np.empty(count, bool) for name in arrays}
    for name, array in arrays.items():
        check = _CHECKS.get(name, _finite)
        for start in range(0, count, _BLOCK):
            block = slice(start, start + _BLOCK)
            good[name][block] = check(array[block])
    return good


#: Rows of a field checked at a time, few enough for the temporaries to stay in the processor's cache.
_BLOCK = 16384


def _finite(rows: np.ndarray) -> np.ndarray:
    finite = np.isfinite(rows)
    return finite.all() or finite.reshape(len(rows), -1).all(axis=1)


def _are_unit(rows: np.ndarray) -> np.ndarray:
    # A product with a vector of ones, because numpy's own sums are slow along an axis of three or four.
    with np.errstate(over="ignore", invalid="ignore"):
        off = (rows * rows) @ np.ones(rows.shape[1], rows.dtype)
    off -= 1
    np.abs(off, out=off)
    return off.max(initial=0) < 2 * UNIT_TOLERANCE or off < 2 * UNIT_TOLERANCE


def _sizes(rows: np.ndarray) -> np.ndarray:
    return (rows.min(initial=1) > 0 and rows.max(initial=1) < np.inf) or _finite(rows) & (rows > 0).all(axis=1)


#: Requirements beyond being finite: (n, columns) rows -> (n,) bool, or one bool for all.
_CHECKS = {
    "rotations": _are_unit,
    "normals": _are_unit,
    "scales": _sizes,
    "materials": lambda rows: rows >= 0,
    "clip_line": lambda rows: rows[:, 1] >= 0,
    "clip_line_2": lambda rows: rows[:, 1] >= 0,
    "blend_depth": lambda rows: (rows >= 0) & (rows <= 1),
    "lift": lambda rows: (rows >= 0) & (rows < np.inf),
    "hidden_back": lambda rows: (rows >= 0) & (rows <= 1),
}


def _normalised(vectors: np.ndarray) -> np.ndarray:
    """Rows scaled to unit length where possible; rows that are already unit keep their bits."""
    squared = np.einsum("ij,ij->i", vectors, vectors)
    off = np.flatnonzero(~(np.abs(squared - 1) < 1e-5) & np.isfinite(vectors).all(axis=1))
    if not len(off):
        return vectors
    vectors = vectors.copy()
    rows = vectors[off].astype(np.float64)
    length = np.linalg.norm(rows, axis=1, keepdims=True)
    with np.errstate(divide="ignore", invalid="ignore"):
        vectors[off] = rows / length
    return vectors
