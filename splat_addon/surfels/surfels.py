# SPDX-License-Identifier: GPL-3.0-or-later
"""The central data model: a set of oriented elliptical surface samples.

A *surfel* keeps its ellipse (position, frame, half-axes) apart from its shading normal: the ellipse shapes the splat,
the normal lights it. Positions are float32 relative to a float64 origin, so a model far from the world origin loses no
precision.
"""

from __future__ import annotations

from copy import copy
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..clip_lines import CLIP_FIELDS, are_reflex, unpack_lines
from ..large_surfels import grains
from ..quaternions import quaternion_axes
from .checks import DEMANDS, row_checks, shaped
from .hull import local_hull
from .layout import LAYOUT, OPAQUE, OPTIONAL_LAYOUT
from .shape import Shape

#: A surface whose opacity is less than this from 0 or 1 is clear or opaque in shadows (lib/screen_door.glsl). Of
#: the opaque area of a cut-out, this share may be neither: the blurred edges of a leaf's image.
_CLEAR, _BLURRED = 1 / 32, 0.75


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
        arrays = shaped(self.arrays())
        for name, good in row_checks(arrays).items():
            if not good.all():
                bad = np.flatnonzero(~good)
                value, demand = arrays[name][bad[0]].tolist(), DEMANDS.get(name, "finite")
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
        """(n, 3) float64 positions relative to `origin` whose convex hull holds all ellipses, tighter than the box."""
        return local_hull(self)


def field_values(surfels: Surfels, name: str) -> np.ndarray:
    """A field, or its default if it is an optional field that these surfels lack."""
    if getattr(surfels, name) is not None:
        return getattr(surfels, name)
    columns, dtype, value = OPTIONAL_LAYOUT[name]
    return np.full((len(surfels), columns) if columns > 1 else len(surfels), value, dtype)
