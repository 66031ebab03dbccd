# SPDX-License-Identifier: GPL-3.0-or-later
"""Gives surfels that exist already the values that a mesh's materials have by now.

Each surfel keeps the triangle that it lies on and its place there, 8 bytes: with these, everything that depends on
materials follows from the mesh, whatever became of its shape.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ...surfels import OPTIONAL_LAYOUT, Surfels
from ..materials.material_sampler import MaterialSampler, Samples
from ..materials.texture_mapping import UV_FIELDS, axis_steps, fill_uvs, is_texture_mapped
from ..mesh.barycentric import barycentric
from ..mesh.triangle_mesh import TriangleMesh
from .tangents import layered_tangents

#: Surfels that are painted at a time.
_BLOCK = 1 << 16

#: Two shares of a place are whole numbers of 1 / `_STEPS`, moved into the range of int16.
_STEPS, _FIRST = 65535, 32768


def places_in_triangles(mesh: TriangleMesh, triangles: np.ndarray, surfels: Surfels) -> np.ndarray:
    """(N, 2) int16 places of surfels in their (N,) triangles: the shares of the second and third corner."""
    places = np.empty((len(surfels), 2), np.int16)
    for rows in _blocks(len(surfels)):
        at = surfels.positions[rows] + surfels.origin
        shares = barycentric(mesh, triangles[rows], at)[:, 1:]
        places[rows] = np.rint(shares * _STEPS) - _FIRST
    return places


def shares_of(places: np.ndarray) -> np.ndarray:
    """(n, 3) shares of the corners, from (n, 2) int16 places."""
    second, third = (places.T.astype(np.float64) + _FIRST) / _STEPS
    third = np.minimum(third, 1 - second)
    return np.stack([1 - second - third, second, third], axis=1)


@dataclass(frozen=True, eq=False)
class Repainting:
    """What paints surfels of a mesh again.

    mesh: with the triangles that were sampled, in any shape. spacing, splat_size: of that sampling, in the mesh's
    units. texture_mapped: whether colours that are a single image are left to the renderer. are_bent: whether a normal
    map may have bent the normals before.
    """

    mesh: TriangleMesh
    spacing: float
    splat_size: float
    texture_mapped: bool = False
    are_bent: bool = False

    @property
    def fields(self) -> tuple[str, ...]:
        """The fields of `Surfels` that depend on the materials; other optional ones of materials are not needed."""
        own = ("colors", "materials", *MaterialSampler(self.mesh.surfaces).optional)
        own += ("normals",) * (self.are_bent or has_normal_map(self.mesh))
        is_mapped = self.texture_mapped and is_texture_mapped(self.mesh.surfaces)
        return (*own, *UV_FIELDS) if is_mapped else own

    def blocks(
        self, triangles: np.ndarray, places: np.ndarray, arrays: dict[str, np.ndarray]
    ) -> Iterator[tuple[slice, dict[str, np.ndarray]]]:
        """Rows of surfels, block by block, and their new values of `fields`.

        triangles, places: (N,) and (N, 2), where the surfels lie. arrays: their `rotations` and `scales`.
        """
        sampler = MaterialSampler(self.mesh.surfaces)
        tangents = layered_tangents(self.mesh) if sampler.needs_tangents else None
        for rows in _blocks(len(triangles)):
            here = {name: arrays[name][rows] for name in ("rotations", "scales")}
            yield rows, self._painted(sampler, tangents, triangles[rows], shares_of(places[rows]), here)

    @np.errstate(over="ignore", invalid="ignore", divide="ignore")
    def _painted(self, sampler: MaterialSampler, tangents, triangles, shares, arrays) -> dict[str, np.ndarray]:
        mesh, count = self.mesh, len(triangles)
        corners = mesh.positions[mesh.triangles[triangles]].astype(np.float64)
        edges = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
        facing = np.cross(*edges)
        axes = np.abs(facing).argmax(axis=1)
        out = {name: self._room(name, count) for name in (*self.fields, "normals")}
        out["materials"][...] = 0 if mesh.materials is None else mesh.materials[triangles]
        out["normals"][...] = _shading_normals(mesh, triangles, shares, facing)
        # a merged surfel stands for several samples
        size = np.maximum(arrays["scales"].min(axis=1) / (self.splat_size * self.spacing), 1)
        per_step = _per_step(edges, facing, axes, self.spacing * size)
        colors = color_steps = uvs = uv_steps = None
        if sampler.needs_colors and mesh.corner_colors is not None:
            colors, color_steps = _at(mesh.corner_colors[triangles], shares, per_step)
        if sampler.needs_uvs and mesh.corner_uvs is not None:
            uvs, uv_steps = _at(mesh.corner_uvs[triangles], shares, per_step)
        across = None if tangents is None else _at(tangents[triangles], shares, per_step)[0]
        samples = Samples(out["materials"], colors, uvs, uv_steps, across, color_steps)
        sampler.fill(out, samples)
        if UV_FIELDS[0] in out:
            steps = axis_steps(arrays, axes, self.spacing) / size
            fill_uvs(out, mesh.surfaces, samples, steps)
        return {name: out[name] for name in self.fields}

    @staticmethod
    def _room(name: str, count: int) -> np.ndarray:
        columns, kind = _COLUMNS[name] if name in _COLUMNS else OPTIONAL_LAYOUT[name][:2]
        return np.empty((count, columns) if columns > 1 else count, kind)


def has_normal_map(mesh: TriangleMesh) -> bool:
    return any(surface.normal_map is not None for surface in mesh.surfaces)


_COLUMNS = {"colors": (4, np.float32), "materials": (1, np.int32), "normals": (3, np.float32)}


def _blocks(count: int) -> Iterator[slice]:
    return (slice(start, min(start + _BLOCK, count)) for start in range(0, count, _BLOCK))


def _per_step(edges, facing: np.ndarray, axes: np.ndarray, steps: np.ndarray) -> np.ndarray:
    """(2, 2, n) change of the shares of the second and third corner (axis 1) per column and per row (axis 0) of the
    image along (n,) `axes`. steps: (n,) the size of its cells."""
    rows = np.arange(len(axes))
    (u1, v1), (u2, v2) = ((edge[rows, (axes + 1) % 3], edge[rows, (axes + 2) % 3]) for edge in edges)
    per_area = steps / facing[rows, axes]
    return np.stack([[v2 * per_area, -v1 * per_area], [-u2 * per_area, u1 * per_area]])


def _at(corners: np.ndarray, shares: np.ndarray, per_step: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(c, n) values from (n, 3, c) values at the corners, and their (2, c, n) change per column and per row."""
    values = np.einsum("nkc,nk->cn", corners, shares, dtype=np.float64).astype(np.float32)
    first, second = (corners[:, k].astype(np.float64) - corners[:, 0] for k in (1, 2))
    steps = np.stack([(first.T * along[0] + second.T * along[1]) for along in per_step])
    return values, steps.astype(np.float32)


def _shading_normals(mesh: TriangleMesh, triangles: np.ndarray, shares: np.ndarray, facing: np.ndarray) -> np.ndarray:
    """(n, 3) unit; the triangle's own where those at its corners have no mean."""
    own = facing / np.linalg.norm(facing, axis=1, keepdims=True)
    if mesh.corner_normals is None:
        return own
    mean = np.einsum("nkc,nk->nc", mesh.corner_normals[triangles], shares, dtype=np.float64)
    length = np.linalg.norm(mean, axis=1, keepdims=True)
    return np.where(np.isfinite(length) & (length > 1e-15), mean / length, own)
