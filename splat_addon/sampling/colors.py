# SPDX-License-Identifier: GPL-3.0-or-later
"""Where a material's base colour comes from, and its value at samples of the surface."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ..images import Image, Pyramid


@dataclass(frozen=True, eq=False)
class SurfaceColor:
    """The base colour of a material; the factors that are there multiply.

    color: scene-linear r, g, b, a. image: looked up at the interpolated corner_uvs, where the mesh has them.
    vertex_colors: times the interpolated corner_colors, where the mesh has them.
    """

    color: tuple[float, float, float, float] = (0.8, 0.8, 0.8, 1.0)
    image: Image | None = None
    vertex_colors: bool = False

    def __post_init__(self):
        if len(self.color) != 4 or not np.isfinite(self.color).all():
            raise ValueError(f"A surface's colour must be 4 finite numbers, not {self.color!r}.")


class Palette:
    """The surfaces of one mesh, ready to be asked for the colours of samples."""

    def __init__(self, surfaces: tuple[SurfaceColor, ...]):
        self._surfaces = surfaces
        self._pyramids = [Pyramid(s.image) if s.image is not None else None for s in surfaces]
        self.needs_uvs = any(s.image is not None for s in surfaces)
        self.needs_vertex_colors = any(s.vertex_colors for s in surfaces)

    def colors(self, materials, vertex_colors, uvs, uv_steps) -> np.ndarray:
        """(n, 4) float32 colours of n samples; one that is not finite falls back to its surface's `color`.

        materials: (n,) integers. vertex_colors: (4, n), or None. uvs: (2, n), or None.
        uv_steps: (2, 2, n) change of the texture coordinates from a sample to the next column's and the next row's.
        """
        if len(self._surfaces) == 1:
            return self._surface_colors(0, len(materials), vertex_colors, uvs, uv_steps)
        colors = np.empty((len(materials), 4), np.float32)
        indices = np.minimum(materials, len(self._surfaces) - 1)
        for index in np.unique(indices):
            at = np.flatnonzero(indices == index)
            parts = (None if a is None else a[..., at] for a in (vertex_colors, uvs, uv_steps))
            colors[at] = self._surface_colors(index, len(at), *parts)
        return colors

    def _surface_colors(self, index: int, count: int, vertex_colors, uvs, uv_steps) -> np.ndarray:
        surface, pyramid = self._surfaces[index], self._pyramids[index]
        constant = np.asarray(surface.color, np.float32)
        factors = []
        if surface.vertex_colors and vertex_colors is not None:
            factors.append(vertex_colors.T)
        if pyramid is not None and uvs is not None:
            factors.append(pyramid.lookup(uvs, pyramid.level_for(_texels_between(uv_steps, pyramid.size))))
        if not factors:
            return np.broadcast_to(constant, (count, 4))
        return _replaced_where_not_finite(math.prod(factors, start=constant), constant)


def _texels_between(uv_steps: np.ndarray, size: tuple[int, int]) -> np.ndarray:
    """(n,) pixels of a (width, height) image from a sample to its farther neighbour in the grid."""
    width, height = size
    columns, rows = (np.hypot(du * width, dv * height) for du, dv in uv_steps)
    return np.maximum(columns, rows)


def _replaced_where_not_finite(colors: np.ndarray, constant: np.ndarray) -> np.ndarray:
    finite = np.isfinite(colors)
    return colors if finite.all() else np.where(finite.all(axis=1, keepdims=True), colors, constant)
