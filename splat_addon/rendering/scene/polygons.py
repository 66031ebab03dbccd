# SPDX-License-Identifier: GPL-3.0-or-later
"""Polygons among the splats: triangles as input of the renderer, and as texels that shaders fetch.

Source: Guennebaud, Barthe, Paulin 2006, section 5 (splats and polygons in one rendering).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ...surfels import Shape
from ..device.interface import MAX_TEXTURE_EDGE
from .strays import middle_of

#: Corners in a row of a texture.
CORNERS_PER_ROW = 512
MAX_TRIANGLES = CORNERS_PER_ROW * MAX_TEXTURE_EDGE // 3
TEXELS_PER_CORNER = 3
#: Triangles, one after the other, that are left out of a picture together.
BLOCK = 1024

#: field -> (columns, dtype) of one corner; one column is stored flat. The last seven fields are optional.
_LAYOUT = {
    "positions": (3, np.float32),
    "normals": (3, np.float32),
    "colors": (4, np.float32),
    "materials": (1, np.int32),
    "roughness": (1, np.float32),
    "metallic": (1, np.float32),
    "emission": (3, np.float32),
    "uvs": (2, np.float32),
    "seams": (1, np.uint8),
    "bumps": (6, np.float32),
    "glosses": (2, np.float32),
}
_OPTIONAL = ("roughness", "metallic", "emission", "uvs", "seams", "bumps", "glosses")


@dataclass(frozen=True, eq=False)
class Polygons(Shape):
    """T triangles of three corners each: corner k of triangle t is row 3 t + k, counter-clockwise seen from outside.

    positions: (3 T, 3) float32, object units, relative to `origin`. normals: (3 T, 3), for shading, of any length; zero
        means the triangle's own normal. colors: (3 T, 4) scene-linear; alpha is ignored.
    materials: (3 T,) index of the instance's slot, the same at the three corners.
    seams: (3 T,) 1 where a chart of `uvs` ends at the edge opposite the corner, plus 2 where one ends at the corner but
        at neither of the triangle's edges there; textures are not looked up beyond. None: 0 everywhere.
    bumps: (3 T, 6) u and v in the instance's normal maps, the unit tangent, and the sign of the bitangent
        cross(normal, tangent); a tangent of zero leaves the normal as it is. None: no normal maps.
    glosses: (3 T, 2) u and v in the instance's maps of roughness and metallic. None: no such maps.

    Raises ValueError with one sentence for a wrong shape, a number that is not finite, or too many triangles.
    """

    positions: np.ndarray
    normals: np.ndarray
    colors: np.ndarray
    materials: np.ndarray
    seams: np.ndarray | None = None
    bumps: np.ndarray | None = None
    glosses: np.ndarray | None = None

    def __post_init__(self):
        count = len(self.positions)
        if count % 3 or count > 3 * MAX_TRIANGLES:
            raise ValueError(
                f"Polygons need three corners each of at most {MAX_TRIANGLES:,} triangles, not {count:,} corners."
            )
        for name, (columns, dtype) in _LAYOUT.items():
            if name in _OPTIONAL and getattr(self, name) is None:
                continue
            array = np.ascontiguousarray(getattr(self, name), dtype)
            wanted = (count, columns) if columns > 1 else (count,)
            if array.shape != wanted:
                raise ValueError(f"Polygon {name} must have shape {wanted}, not {array.shape}.")
            if not np.isfinite(array).all():
                raise ValueError(f"Polygon {name} must be finite numbers; leave triangles out that have others.")
            object.__setattr__(self, name, array)
        if count and self.materials.min() < 0:
            raise ValueError(f"Polygon materials must be 0 or more, not {self.materials.min()}.")
        object.__setattr__(self, "normals", _unit_or_own(self.normals, self.positions))
        object.__setattr__(self, "origin", np.array(self.origin, np.float64))

    @property
    def triangles(self) -> int:
        """Number of triangles."""
        return len(self.positions) // 3

    @property
    def has_uvs(self) -> bool:
        """Whether there are texture coordinates."""
        return self.uvs is not None

    @property
    def is_transparent(self) -> bool:
        """Always False: polygons are opaque, but for the holes that textures cut into them."""
        return False

    @cached_property
    def local_bounds(self) -> tuple[np.ndarray, np.ndarray]:
        """Two (3,) float64 corners, relative to `origin`, of a box around all triangles (NaN if empty)."""
        if not len(self):
            return np.full(3, np.nan), np.full(3, np.nan)
        columns = self.positions.T
        return tuple(np.array([end(column) for column in columns], np.float64) for end in (np.min, np.max))

    @cached_property
    def longest_edges(self) -> np.ndarray:
        """(T,) float64, no less than the longest edge of each triangle, object units."""
        corners = self.positions.reshape(-1, 3, 3)
        return np.linalg.norm(corners.max(axis=1).astype(np.float64) - corners.min(axis=1), axis=1)

    @cached_property
    def longest_edge(self) -> float:
        """The greatest of them (0 if empty)."""
        return float(self.longest_edges.max(initial=0.0))

    @cached_property
    def block_bounds(self) -> tuple[np.ndarray, np.ndarray]:
        """Two (3, n) float64 corners, relative to `origin`, of a box around each block of triangles."""
        starts = np.arange(0, len(self), 3 * BLOCK)
        return tuple(end.reduceat(self.positions, starts).T.astype(np.float64) for end in (np.minimum, np.maximum))


def make_polygons(
    vertices: np.ndarray, triangles: np.ndarray, corner_normals=None, color=(0.8, 0.8, 0.8, 1.0), **fields
) -> Polygons:
    """`Polygons` of one colour from (V, 3) vertices and (T, 3) indices. corner_normals: (T, 3, 3), None: flat."""
    vertices, count = np.asarray(vertices, np.float64), 3 * len(triangles)
    origin = fields.pop("origin", middle_of(vertices) if count else np.zeros(3))
    positions = (vertices - origin)[np.asarray(triangles).ravel()]
    normals = np.zeros((count, 3)) if corner_normals is None else np.asarray(corner_normals).reshape(-1, 3)
    given = {"colors": np.tile(np.float32(color), (count, 1)), "materials": np.zeros(count, np.int32)} | fields
    return Polygons(positions, normals, origin=origin, **given)


def pack_polygons(shape: Polygons) -> np.ndarray:
    """(rows, 1536, 4) float32, three texels a corner: position, slot  |  normal, 0  |  colour."""
    texels = np.zeros((_rows(shape) * CORNERS_PER_ROW, TEXELS_PER_CORNER, 4), np.float32)
    filled = texels[: len(shape)]
    filled[:, 0, :3], filled[:, 0, 3] = shape.positions, shape.materials
    filled[:, 1, :3], filled[:, 2] = shape.normals, shape.colors
    return texels.reshape(-1, CORNERS_PER_ROW * TEXELS_PER_CORNER, 4)


def pack_polygon_uvs(shape: Polygons) -> np.ndarray:
    """(rows, 512, 4) float32: uv, seam of the opposite edge, seam of each corner."""
    texels = np.zeros((_rows(shape) * CORNERS_PER_ROW, 4), np.float32)
    texels[: len(shape), :2] = shape.uvs
    if shape.seams is not None:
        texels[: len(shape), 2], texels[: len(shape), 3] = shape.seams & 1, shape.seams >> 1
    return texels.reshape(-1, CORNERS_PER_ROW, 4)


def pack_polygon_bumps(shape: Polygons) -> np.ndarray:
    """(rows, 1024, 4) float32, two texels a corner: uv, sign, 0  |  tangent, 0."""
    texels = np.zeros((_rows(shape) * CORNERS_PER_ROW, 2, 4), np.float32)
    texels[: len(shape), 0, :3], texels[: len(shape), 1, :3] = shape.bumps[:, [0, 1, 5]], shape.bumps[:, 2:5]
    return texels.reshape(-1, 2 * CORNERS_PER_ROW, 4)


def pack_polygon_glosses(shape: Polygons) -> np.ndarray:
    """(rows, 512, 4) float32: uv, 0, 0."""
    texels = np.zeros((_rows(shape) * CORNERS_PER_ROW, 4), np.float32)
    texels[: len(shape), :2] = shape.glosses
    return texels.reshape(-1, CORNERS_PER_ROW, 4)


def _rows(shape: Polygons) -> int:
    return max(-(-len(shape) // CORNERS_PER_ROW), 1)


def _unit_or_own(normals: np.ndarray, positions: np.ndarray) -> np.ndarray:
    """(3 T, 3) unit normals; the triangle's own if there is none, and up for triangles without area."""
    length = np.linalg.norm(normals.astype(np.float64), axis=1, keepdims=True)
    if (length > 0).all():
        return (normals / length).astype(np.float32)
    a, b, c = positions.astype(np.float64).reshape(-1, 3, 3).transpose(1, 0, 2)
    own = np.cross(b - a, c - a)
    size = np.linalg.norm(own, axis=1, keepdims=True)
    own = np.where(size > 0, own / np.where(size > 0, size, 1), (0.0, 0.0, 1.0))
    own = np.repeat(own, 3, axis=0)
    return np.where(length > 0, normals / np.where(length > 0, length, 1), own).astype(np.float32)
