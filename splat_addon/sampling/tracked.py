# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfels that follow a deforming mesh: the same ones in the same order as long as it has the same triangles.

The mesh is sampled once. Then each surfel keeps its triangle, its place and its two half-axes in the triangle's own
coordinates (two edges and the normal), and is rebuilt from the triangle as it has become. Inside a triangle this is an
affine map, which maps ellipses to ellipses and a covered surface to a covered surface; only at the edges between
triangles that stretch differently can the cover thin out.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ..surfels import Surfels, axes_quaternions
from .joining import have_same_values
from .mesh import TriangleMesh
from .sample import Sampling, sample_surface
from .solid import is_solid

#: Surfels whose longer axis has grown by more than this show less detail than was asked for.
LARGEST_STRETCH = 2.5
#: Where more than this share of them has, the mesh should be sampled anew.
STRETCHED_SHARE = 0.01

#: A half-axis shrinks to this share of what it was, and not to nothing.
_LEAST_SHRINKING = 1e-3

#: Surfels handled at a time: their temporaries stay in the processor's cache.
_CHUNK = 1 << 15

#: A mapped normal that is this far from the interpolated one is meant.
_BENT = 1e-3


class TrackedSurfels:
    """The surfels of one sampling, and where they go.

    mesh: as it is sampled; options: of `sample_surface`. What it holds of this moment: `mesh`, `sampling`.
    """

    def __init__(self, mesh: TriangleMesh, **options):
        self.mesh, self._options = mesh, options
        self.sampling = sample_surface(mesh, **options)
        self._surfels = _solid_if(self.sampling, mesh)
        self._last = mesh, (self._surfels, 0.0)
        self._binding = None

    def has_triangles_of(self, mesh: TriangleMesh) -> bool:
        """Whether the mesh has as many vertices and the same triangles over them."""
        has_as_many = len(mesh.positions) == len(self.mesh.positions)
        return has_as_many and np.array_equal(mesh.triangles, self.mesh.triangles)

    def at(self, mesh: TriangleMesh) -> tuple[Surfels, float]:
        """The surfels on the mesh as it is now, and the share of them that is stretched beyond `LARGEST_STRETCH`.

        mesh: the same triangles over as many vertices. Its colours and other values at corners may have changed, which
        costs a second sampling. Raises ValueError for another topology; non-finite vertices leave their surfels where
        they were, as dots.
        """
        if not self.has_triangles_of(mesh):
            raise ValueError("The mesh has other triangles than the one that was sampled; sample it anew.")
        if not have_same_values(_appearance(mesh), _appearance(self.mesh)):
            self._repaint(mesh)
        elif have_same_values(_shape(mesh), _shape(self._last[0])):
            return self._last[1]
        if have_same_values(_shape(mesh), _shape(self.mesh)):
            self._last = mesh, (self._surfels, 0.0)
            return self._last[1]
        if self._binding is None:
            self._binding = _Binding(self.mesh, self.sampling.surfels, self._options)
        arrays, origin, stretched = self._binding.arrays_on(mesh)
        surfels = Surfels(origin=origin, **(self.sampling.surfels.arrays() | arrays))
        self._last = mesh, (_solid_if(replace(self.sampling, surfels=surfels), mesh), stretched)
        return self._last[1]

    def _repaint(self, mesh: TriangleMesh):
        """The same samples with the values that `mesh` has at its corners; the shape alone decides where they are."""
        self.mesh = replace(mesh, positions=self.mesh.positions, corner_normals=self.mesh.corner_normals)
        self.sampling = sample_surface(self.mesh, **self._options)
        self._surfels = replace(self.sampling.surfels, is_solid=self._surfels.is_solid)
        if self._binding is not None:
            self._binding.repaint(self.sampling.surfels)


def _shape(mesh: TriangleMesh) -> tuple:
    return mesh.positions, mesh.corner_normals


def _appearance(mesh: TriangleMesh) -> tuple:
    return mesh.corner_colors, mesh.corner_uvs, mesh.materials, mesh.surfaces


def _solid_if(sampling: Sampling, mesh: TriangleMesh) -> Surfels:
    return sampling.surfels.as_solid() if sampling.keeps_both_sides and is_solid(mesh) else sampling.surfels


class _Binding:
    """Each surfel in the coordinates of its triangle.

    Coordinates are those of the basis (edge 1, edge 2, normal as long as the root of its own length), so that the third
    grows with the others.
    """

    def __init__(self, mesh: TriangleMesh, surfels: Surfels, options: dict):
        self._surfels, self._mesh = surfels, mesh
        self._middle = mesh.positions.mean(axis=0)
        # Sampled once more with the triangle's number for a material: the order of samples depends on the shape alone.
        named = TriangleMesh(mesh.positions, mesh.triangles, materials=np.arange(len(mesh), dtype=np.int32))
        self._triangles = sample_surface(named, **options).surfels.materials
        count = len(surfels)
        self._place = np.empty((count, 3))
        self._axes = np.empty((2, count, 3), np.float32)
        half_axes = surfels.half_axes()
        for rows in _chunks(count):
            corner, basis = _bases(mesh, self._triangles[rows])
            inverse = np.linalg.inv(basis)
            offset = surfels.positions[rows] + (surfels.origin - corner)
            self._place[rows] = _times(inverse, offset)
            for axis, half_axis in zip(self._axes, half_axes, strict=True):
                axis[rows] = _times(inverse, half_axis[rows].astype(np.float64))
        self._weights = _weights(self._place)
        self.repaint(surfels)

    def repaint(self, surfels: Surfels):
        """Take over values that the samples were given anew."""
        self._surfels = surfels
        self._bends = self._bends_of(surfels)

    def arrays_on(self, mesh: TriangleMesh) -> tuple[dict[str, np.ndarray], np.ndarray, float]:
        """What of the surfels' arrays changes, their origin, and the share that is stretched too far."""
        rest, count = self._surfels, len(self._surfels)
        finite = np.isfinite(mesh.positions).all(axis=1)
        origin = rest.origin + (mesh.positions.mean(axis=0) - self._middle if finite.all() else 0.0)
        names = ("positions", "rotations", "scales", "normals", *(("uv_along_x", "uv_along_y") if rest.has_uvs else ()))
        out = {name: np.array(getattr(rest, name)) for name in names}
        stretched = 0
        for rows in _chunks(count):
            triangles = self._triangles[rows]
            corner, basis = _bases(mesh, triangles)
            p, q = (_times(basis, axis[rows]) for axis in self._axes)
            long, short, angle = _principal(p, q)
            normal = np.cross(long, short)
            lengths = [np.linalg.norm(a, axis=1) for a in (long, short, normal)]
            good = finite[mesh.triangles[triangles]].all(axis=1) & (lengths[2] > 0)
            long, short, normal = (a[good] / n[good, None] for a, n in zip((long, short, normal), lengths, strict=True))
            out["positions"][rows][good] = (corner + _times(basis, self._place[rows]) - origin)[good]
            out["rotations"][rows][good] = axes_quaternions(long, np.cross(normal, long), normal)
            sizes = np.stack(lengths[:2], axis=1)
            least = _LEAST_SHRINKING * rest.scales[rows].min(axis=1, keepdims=True)
            out["scales"][rows] = np.where(good[:, None], np.maximum(sizes, least), least)
            out["normals"][rows][good] = self._shading(mesh, rows, triangles, basis)[good]
            if rest.has_uvs:
                x, y, (cosine, sine) = rest.uv_along_x[rows], rest.uv_along_y[rows], angle
                out["uv_along_x"][rows], out["uv_along_y"][rows] = x * cosine + y * sine, y * cosine - x * sine
            stretched += int(np.count_nonzero(_stretch(p, q, rest.scales[rows]) > LARGEST_STRETCH))
        return out, origin, stretched / max(count, 1)

    def _bends_of(self, surfels: Surfels) -> np.ndarray | None:
        """(n, 3) what a normal map adds to each interpolated normal, in its triangle's frame; None for nothing."""
        bends = np.zeros((len(surfels), 3), np.float32)
        for rows in _chunks(len(surfels)):
            triangles = self._triangles[rows]
            _, basis = _bases(self._mesh, triangles)
            smooth = _interpolated(self._mesh, triangles, self._weights[rows], basis)
            bends[rows] = _times(np.swapaxes(_frames(basis), 1, 2), surfels.normals[rows] - smooth)
        return bends if np.abs(bends).max(initial=0) > _BENT else None

    def _shading(self, mesh: TriangleMesh, rows: slice, triangles: np.ndarray, basis: np.ndarray) -> np.ndarray:
        normals = _interpolated(mesh, triangles, self._weights[rows], basis)
        return normals if self._bends is None else _unit(normals + _times(_frames(basis), self._bends[rows]), normals)


def _chunks(count: int):
    return (slice(start, min(start + _CHUNK, count)) for start in range(0, count, _CHUNK))


def _times(matrices: np.ndarray, vectors: np.ndarray) -> np.ndarray:
    """(n, 3) products of (n, 3, 3) matrices and (n, 3) vectors."""
    return np.einsum("nij,nj->ni", matrices, vectors)


def _bases(mesh: TriangleMesh, triangles: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(n, 3) first corners, and (n, 3, 3) whose columns are both edges from there and the scaled normal."""
    a, b, c = (mesh.positions[mesh.triangles[triangles, k]] for k in range(3))
    normal = np.cross(b - a, c - a)
    length = np.linalg.norm(normal, axis=1, keepdims=True)
    normal = np.divide(normal, np.sqrt(length), out=np.zeros_like(normal), where=length > 0)
    return a, np.stack([b - a, c - a, normal], axis=2)


def _frames(basis: np.ndarray) -> np.ndarray:
    """(n, 3, 3) orthonormal frames as columns: along the first edge, across it, the normal."""
    x, z = _unit(basis[:, :, 0]), _unit(basis[:, :, 2])
    return np.stack([x, np.cross(z, x), z], axis=2)


def _unit(vectors: np.ndarray, fallback: np.ndarray | float = 0.0) -> np.ndarray:
    """Rows of unit length, the fallback where there is no length."""
    length = np.linalg.norm(vectors, axis=1, keepdims=True)
    usable = (length > 0) & np.isfinite(length)
    return np.where(usable, vectors / np.where(usable, length, 1), fallback)


def _weights(place: np.ndarray) -> np.ndarray:
    """(n, 3) barycentric weights, 0 to 1, of places in their triangles' coordinates."""
    weights = np.clip(np.stack([1 - place[:, 0] - place[:, 1], place[:, 0], place[:, 1]], axis=1), 0, 1)
    return weights / weights.sum(axis=1, keepdims=True)


def _interpolated(mesh: TriangleMesh, triangles: np.ndarray, weights: np.ndarray, basis: np.ndarray) -> np.ndarray:
    """(n, 3) unit shading normals; the triangle's own where the corners have none."""
    own = _unit(basis[:, :, 2])
    if mesh.corner_normals is None:
        return own
    return _unit(np.einsum("nk,nkj->nj", weights, np.asarray(mesh.corner_normals[triangles], np.float64)), own)


def _principal(p: np.ndarray, q: np.ndarray) -> tuple[np.ndarray, np.ndarray, tuple[np.ndarray, np.ndarray]]:
    """Principal half-axes of the ellipses with conjugate half-diameters p and q, (n, 3) each, and (n, 1) cos t, sin t.

    They are p cos t + q sin t and q cos t - p sin t where tan 2t = 2 p.q / (p.p - q.q).
    """
    pp, qq, pq = (np.einsum("ij,ij->i", a, b)[:, None] for a, b in ((p, p), (q, q), (p, q)))
    angle = np.arctan2(2 * pq, pp - qq) / 2
    # Axes that are still at right angles, as after a rotation, stay the axes, whichever is longer.
    angle[np.abs(pq) < 1e-6 * np.sqrt(pp * qq)] = 0
    cosine, sine = np.cos(angle), np.sin(angle)
    return p * cosine + q * sine, q * cosine - p * sine, (cosine, sine)


def _stretch(p: np.ndarray, q: np.ndarray, sizes: np.ndarray) -> np.ndarray:
    """(n,) largest factor by which a direction of each ellipse's plane has grown.

    p, q: (n, 3) images of the half-axes, which were `sizes`, (n, 2), long.
    """
    p, q = p / sizes[:, :1], q / sizes[:, 1:]
    pp, qq, pq = (np.einsum("ij,ij->i", a, b) for a, b in ((p, p), (q, q), (p, q)))
    return np.sqrt((pp + qq) / 2 + np.hypot((pp - qq) / 2, pq))
