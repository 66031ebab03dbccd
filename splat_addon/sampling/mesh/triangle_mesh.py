# SPDX-License-Identifier: GPL-3.0-or-later
"""The input of sampling: triangles as plain arrays. `cleaning` drops unusable ones; `sample` turns them into
surfels."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from ..materials.surfaces import Surface
from .places import vertex_hashes

#: Triangles, or vertices, per batch: few enough for temporaries to stay in the processor's cache.
CHUNK = 16384

#: field -> shape of one triangle's entry (of one layer if there may be several), and dtype.
_PER_TRIANGLE = {
    "corner_normals": ((3, 3), np.floating),
    "corner_colors": ((3, 4), np.floating),
    "corner_uvs": ((3, 2), np.floating),
    "materials": ((), np.integer),
}
_LAYERED = ("corner_colors", "corner_uvs")


@dataclass(frozen=True, eq=False)
class TriangleMesh:
    """T triangles over V vertices. Arrays that have the form below are not copied, and must not change afterwards.

    positions: (V, 3) float64 in Fortran order, object units; non-finite values are allowed, and `drop_unusable` removes
        them.
    triangles: (T, 3) integer vertex indices, counter-clockwise seen from outside.
    corner_normals: (T, 3, 3) shading normals of any length; None or zero: the triangle's own normal.
    corner_colors: (T, 3, 4) scene-linear. corner_uvs: (T, 3, 2). Both may have several layers, concatenated in the last
        dimension.
    materials: (T,) integer index into `surfaces` and into the object's material slots; None: all 0.
    surfaces: what each material is made of; an index past the end uses the last.
    known_usable, facing_area: set only by `drop_unusable`. The latter is the area projected onto the image that each
        triangle faces most, object units squared. surveyed, connected: results of `survey` and `connectivity`,
        set only by them.

    Raises ValueError with one sentence for a wrong shape or type or an index out of range.
    """

    positions: np.ndarray
    triangles: np.ndarray
    corner_normals: np.ndarray | None = None
    corner_colors: np.ndarray | None = None
    corner_uvs: np.ndarray | None = None
    materials: np.ndarray | None = None
    surfaces: tuple[Surface, ...] = (Surface(),)
    known_usable: bool = field(default=False, init=False, repr=False)
    facing_area: float = field(default=0.0, init=False, repr=False)
    surveyed: object = field(default=None, init=False, repr=False)
    connected: object = field(default=None, init=False, repr=False)

    def __post_init__(self):
        # each component contiguous, because almost all computations go component by component
        positions = np.asfortranarray(self.positions, np.float64)
        if positions.ndim != 2 or positions.shape[1] != 3:
            raise ValueError(f"Mesh positions must have shape (V, 3), not {positions.shape}.")
        triangles = np.asarray(self.triangles)
        if triangles.ndim != 2 or triangles.shape[1] != 3 or not np.issubdtype(triangles.dtype, np.integer):
            raise ValueError(f"Triangles must be (T, 3) integers, not {triangles.shape} of {triangles.dtype}.")
        _check_indices("triangle", triangles, len(positions))
        object.__setattr__(self, "positions", positions)
        object.__setattr__(self, "triangles", triangles)
        for name, (shape, kind) in _PER_TRIANGLE.items():
            if getattr(self, name) is not None:
                array = np.asarray(getattr(self, name))
                if name in _LAYERED and array.ndim == 3 and array.shape[2]:
                    shape = (3, array.shape[2] // shape[1] * shape[1] or shape[1])
                if array.shape != (len(triangles), *shape) or not np.issubdtype(array.dtype, kind):
                    raise ValueError(
                        f"Mesh {name} must be {kind.__name__} of shape {(len(triangles), *shape)}, "
                        f"not {array.dtype} of shape {array.shape}."
                    )
                object.__setattr__(self, name, array)
        if self.materials is not None:
            _check_indices("material", self.materials, np.iinfo(np.int32).max)
        object.__setattr__(self, "surfaces", tuple(self.surfaces) or (Surface(),))

    def __len__(self) -> int:
        return len(self.triangles)

    def bounds(self) -> tuple[np.ndarray, np.ndarray]:
        """Two (3,) float64 corners of the box around all vertices; meaningful only for a usable mesh."""
        return self._bounds

    @cached_property
    def _bounds(self) -> tuple[np.ndarray, np.ndarray]:
        return self.positions.min(axis=0), self.positions.max(axis=0)

    @cached_property
    def places(self) -> np.ndarray:
        """(V,) uint64: `vertex_hashes`, equal for coincident vertices."""
        return vertex_hashes(self.positions)

    def with_triangles(self, rows: np.ndarray) -> TriangleMesh:
        """The mesh with some of its triangles, over the same vertices, of which it shares what is cached."""
        some = replace(self, **{name: array.take(rows, axis=0) for name, array in self.per_triangle().items()})
        for name in {"_bounds", "places"} & vars(self).keys():
            object.__setattr__(some, name, getattr(self, name))
        return some

    def per_triangle(self) -> dict[str, np.ndarray]:
        """The arrays that hold one entry per triangle, by field name."""
        names = ("triangles", *_PER_TRIANGLE)
        return {name: getattr(self, name) for name in names if getattr(self, name) is not None}


def triangle_chunks(count: int, size: int = CHUNK) -> Iterator[slice]:
    """Slices that cut `count` triangles into runs of at most `size`."""
    return (slice(start, min(start + size, count)) for start in range(0, count, size))


def gather_corners(components: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """(3, 3, t) by component, corner and triangle, from (3, V) components and (t, 3) vertex indices."""
    return corners_at(components, corner_indices(triangles))


def corner_indices(triangles: np.ndarray) -> np.ndarray:
    """(3, t) intp: the vertex at each corner of (t, 3) triangles, in the layout that is fastest for gathering."""
    return np.ascontiguousarray(triangles.T, np.intp)


def corners_at(components: np.ndarray, indices: np.ndarray) -> np.ndarray:
    """(3, 3, t) by component, corner and triangle, from (3, V) components and `corner_indices`."""
    corners = np.empty((3, *indices.shape), components.dtype)
    for component, row in zip(components, corners, strict=True):
        # mode "clip", because only it writes directly to `out`; the indices were validated when the mesh was made
        component.take(indices, out=row, mode="clip")
    return corners


def doubled_areas(corners: np.ndarray) -> np.ndarray:
    """(3, t) normal of each triangle from (3, 3, t) corners; its length is twice the area."""
    return crossed(corners[:, 1:] - corners[:, :1])


def crossed(edges: np.ndarray) -> np.ndarray:
    """(3, t) cross products of the two edges of each triangle in (3, 2, t)."""
    (x1, x2), (y1, y2), (z1, z2) = edges
    products = np.empty((3, *x1.shape), x1.dtype)
    for product, (a, b, c, d) in zip(products, ((y1, z2, z1, y2), (z1, x2, x1, z2), (x1, y2, y1, x2)), strict=True):
        np.multiply(a, b, out=product)
        product -= c * d
    return products


def _check_indices(name: str, indices: np.ndarray, limit: int):
    if indices.size and not (indices.min() >= 0 and indices.max() < limit):
        bad = indices[(indices < 0) | (indices >= limit)][0]
        raise ValueError(f"A {name} index must lie between 0 and {limit - 1}, not {bad}.")
