# SPDX-License-Identifier: GPL-3.0-or-later
"""Binds surfels to their triangles, so that they can be rebuilt after the triangles have moved.

Each surfel stores its triangle, and its position and two half-axes in terms of the triangle's edges and normal. Within
a triangle a deformation is an affine map, which maps ellipses to ellipses.
"""

from __future__ import annotations

import numpy as np

from ...clip_lines import CLIP_FIELDS, turned
from ...normal_fields import NORMAL_FIELDS, fields_of
from ...quaternions import axes_columns, axes_quaternions
from ...surfels import Surfels, field_values
from ..mesh.triangle_mesh import TriangleMesh, doubled_areas, gather_corners, triangle_chunks
from ..sample import Sampling

#: Surfels whose longer axis has grown beyond this factor show less detail than requested.
LARGEST_STRETCH = 2.5

#: A half-axis shrinks at most to this share of its original length, never to nothing.
_LEAST_SHRINKING = 1e-3

#: Stands in for the area of a mesh that has none.
_LEAST_AREA = 1e-300

#: A shading normal that differs this much from the interpolated one comes from a normal map.
_BENT = 1e-3


class Binding:
    """Each surfel in the coordinates of its triangle.

    The basis is (edge 1, edge 2, normal divided by the root of its length), so that all three scale alike. Samples of
    one triangle and one axis are consecutive and share an ellipse. Values shared by such a *run* are computed once per
    run, in float64.
    """

    def __init__(self, mesh: TriangleMesh, sampling: Sampling):
        surfels = sampling.surfels
        self._middle = mesh.positions.mean(axis=0)
        triangles = sampling.triangles
        is_new = np.ones(len(triangles) + 1, bool)
        is_new[1:-1] = triangles[1:] != triangles[:-1]
        for shared in (surfels.rotations, surfels.scales):
            is_new[1:-1] |= (shared[1:] != shared[:-1]).any(axis=1)
        self._starts = np.flatnonzero(is_new)
        self._triangles = triangles[self._starts[:-1]]
        runs, count = len(self._triangles), len(surfels)
        self._place, self._axes = np.empty((3, count), np.float32), np.empty((2, 3, runs))
        half_axes = surfels.half_axes()
        for chunk in triangle_chunks(runs):
            rows, of_run = self._rows(chunk)
            basis = _Basis(mesh, self._triangles[chunk])
            corner = (basis.corner - surfels.origin[:, None]).take(of_run, axis=1)
            inverse = basis.inverse()
            for component, row in enumerate(inverse.take(of_run, axis=2)):
                self._place[component, rows] = _dot(row, surfels.positions[rows].T - corner)
            for axis, half_axis in zip(self._axes, half_axes, strict=True):
                vectors = half_axis[self._starts[:-1][chunk]].T.astype(np.float64)
                axis[:, chunk] = [_dot(row, vectors) for row in inverse]
        self._areas = _areas(mesh)
        self.count = count
        self.repaint(mesh, surfels)

    def repaint(self, mesh: TriangleMesh, surfels: Surfels):
        """Take over newly sampled attributes of the same samples."""
        self._surfels = surfels
        self._bends = self._bends_of(mesh, surfels)

    def arrays_on(self, mesh: TriangleMesh) -> tuple[dict[str, np.ndarray], np.ndarray, float]:
        """The arrays that change, their origin, and the share of the surfels, or of the area if that is larger, that
        grew too far."""
        rest, finite = self._surfels, np.isfinite(mesh.positions).all(axis=1)
        shift = mesh.positions.mean(axis=0) - self._middle
        origin = rest.origin + np.where(np.isfinite(shift), shift, 0.0)
        uv_fields = [name for name in ("uv_along_x", "uv_along_y", "uv_border") if getattr(rest, name) is not None]
        clip_fields = [name for name in CLIP_FIELDS if getattr(rest, name) is not None]
        normal_fields = NORMAL_FIELDS if rest.normals_change else ()
        names = ("positions", "rotations", "scales", "normals", *uv_fields, *clip_fields, *normal_fields)
        out, stretched = {name: np.array(field_values(rest, name)) for name in names}, 0
        for chunk in triangle_chunks(len(self._triangles)):
            rows, of_run = self._rows(chunk)
            here = {name: array[rows] for name, array in out.items()}
            triangles, sizes = self._triangles[chunk], rest.scales[self._starts[:-1][chunk]]
            basis = _Basis(mesh, triangles)
            p, q = (basis.times(axis[:, chunk]) for axis in self._axes)
            ellipse = _Ellipse(p, q, sizes.min(axis=1))
            good = finite[mesh.triangles[triangles]].all(axis=1) & ellipse.has_plane
            keep = np.flatnonzero(good.take(of_run))
            moved, run = slice(None) if len(keep) == len(of_run) else keep, of_run[keep]
            here["positions"][moved] = self._positions(basis, origin, rows, of_run).T[moved]
            here["rotations"][moved] = ellipse.rotations(np.flatnonzero(good))[(np.cumsum(good) - 1)[run]]
            here["scales"][...] = np.where(good[:, None], ellipse.sizes, ellipse.least)[of_run]
            here["normals"][moved] = self._normals(mesh, basis, triangles, rows, of_run).T[moved]
            if rest.normals_change and mesh.corner_normals is not None:
                turned_along = self._changes(mesh, chunk, ellipse)
                axes = axes_columns(here["rotations"], 0, 1, 2)
                along = [of.take(of_run, axis=1) for of in turned_along]
                for name, values in fields_of(here["normals"].T, along, axes).items():
                    here[name][moved] = values[moved]
            if rest.has_uvs:
                cosine, sine = ellipse.cosine[of_run, None], ellipse.sine[of_run, None]
                x, y = rest.uv_along_x[rows], rest.uv_along_y[rows]
                here["uv_along_x"][...], here["uv_along_y"][...] = x * cosine + y * sine, y * cosine - x * sine
                if rest.uv_border is not None:
                    across, up = rest.uv_border[rows, :1], rest.uv_border[rows, 1:]
                    columns = across * cosine + up * sine, up * cosine - across * sine
                    here["uv_border"][...] = np.concatenate(columns, axis=1)
            here_lines = {name: out[name][rows] if name in out else None for name in CLIP_FIELDS}
            lines = turned(here_lines, np.nan_to_num(np.arctan2(ellipse.sine, ellipse.cosine))[of_run])
            for name, values in lines.items():
                here[name][...] = values
            too_far = _stretch(p, q, sizes) > LARGEST_STRETCH
            stretched += int(np.count_nonzero(too_far.take(of_run)))
        return out, origin, max(stretched / max(len(rest), 1), self._grown_share(mesh))

    def _grown_share(self, mesh: TriangleMesh) -> float:
        """Share of the current area on triangles that have grown too much; triangles that grew from nothing have no
        surfels."""
        areas = _areas(mesh)
        return float(areas[areas > LARGEST_STRETCH**2 * self._areas].sum() / max(areas.sum(), _LEAST_AREA))

    def _rows(self, chunk: slice) -> tuple[slice, np.ndarray]:
        """The rows of the surfels in a chunk of runs, and the run that each belongs to."""
        starts = self._starts[chunk.start : chunk.stop + 1]
        return slice(starts[0], starts[-1]), np.repeat(np.arange(len(starts) - 1), np.diff(starts))

    def _positions(self, basis: _Basis, origin: np.ndarray, rows: slice, of_run: np.ndarray) -> np.ndarray:
        """(3, n) float32 relative to `origin`."""
        corner = (basis.corner - origin[:, None]).astype(np.float32)
        columns = basis.columns.astype(np.float32)
        return np.stack(
            [
                corner[k].take(of_run) + _dot([c[k].take(of_run) for c in columns], self._place[:, rows])
                for k in range(3)
            ]
        )

    def _normals(self, mesh, basis: _Basis, triangles, rows: slice, of_run: np.ndarray) -> np.ndarray:
        """(3, n) float32 unit shading normals, including the detail of a normal map."""
        normals = _interpolated(mesh, basis, triangles, self._place[:2, rows], of_run)
        if self._bends is None:
            return normals
        frame, bends = basis.frame().astype(np.float32), self._bends[:, rows]
        added = np.stack([_dot([axis[k].take(of_run) for axis in frame], bends) for k in range(3)])
        return _unit_columns(normals + added, normals)

    def _changes(self, mesh: TriangleMesh, chunk: slice, ellipse: _Ellipse) -> list[np.ndarray]:
        """Two (3, r) changes of the interpolated normals along the new half-axes of r runs."""
        first, second, third = _corner_normals(mesh, self._triangles[chunk])
        edges = second - first, third - first
        along_x, along_y = ((edges[0] * axis[0, chunk] + edges[1] * axis[1, chunk]) for axis in self._axes)
        cosine, sine = ellipse.cosine, ellipse.sine
        return [along_x * cosine + along_y * sine, along_y * cosine - along_x * sine]

    def _bends_of(self, mesh: TriangleMesh, surfels: Surfels) -> np.ndarray | None:
        """(3, n) what a normal map adds to each interpolated normal, in the triangle's frame; None if it adds
        nothing."""
        bends = np.zeros((3, len(surfels)), np.float32)
        for chunk in triangle_chunks(len(self._triangles)):
            rows, of_run = self._rows(chunk)
            basis = _Basis(mesh, self._triangles[chunk])
            smooth = _interpolated(mesh, basis, self._triangles[chunk], self._place[:2, rows], of_run)
            added = surfels.normals[rows].T - smooth
            bends[:, rows] = [_dot(axis.take(of_run, axis=1), added) for axis in basis.frame()]
        return bends if np.abs(bends).max(initial=0) > _BENT else None


def _areas(mesh: TriangleMesh) -> np.ndarray:
    """(T,) twice the area of each triangle; 0 if it is not finite."""
    components, areas = np.ascontiguousarray(mesh.positions.T), np.empty(len(mesh))
    for chunk in triangle_chunks(len(mesh)):
        normals = doubled_areas(gather_corners(components, mesh.triangles[chunk]))
        areas[chunk] = np.sqrt(_dot(normals, normals))
    return np.nan_to_num(areas, nan=0.0, posinf=0.0)


class _Basis:
    """Bases of r triangles.

    corner: (3, r) first corners. columns: (3, 3, r) both edges from there, and the normal.
    """

    def __init__(self, mesh: TriangleMesh, triangles: np.ndarray):
        components = np.ascontiguousarray(mesh.positions.T)
        corners = gather_corners(components, mesh.triangles[triangles])
        self.corner = np.ascontiguousarray(corners[:, 0])
        normal = doubled_areas(corners)
        length = np.sqrt(_dot(normal, normal))
        scaled = np.divide(normal, np.sqrt(length), out=np.zeros_like(normal), where=length > 0)
        self.columns = np.stack([corners[:, 1] - self.corner, corners[:, 2] - self.corner, scaled])

    def times(self, coordinates: np.ndarray) -> np.ndarray:
        """(3, r) vectors from (3, r) coordinates in the basis."""
        return sum(column * coordinate for column, coordinate in zip(self.columns, coordinates, strict=True))

    def inverse(self) -> np.ndarray:
        """(3, 3, r): the rows of the inverse basis."""
        a, b, c = self.columns
        rows = np.stack([_cross(b, c), _cross(c, a), _cross(a, b)])
        return rows / _dot(a, rows[0])

    def frame(self) -> np.ndarray:
        """(3, 3, r) orthonormal axes: along the first edge, across it, the normal; 0 for degenerate triangles."""
        x, z = _unit_columns(self.columns[0]), _unit_columns(self.columns[2])
        return np.stack([x, _cross(z, x), z])


class _Ellipse:
    """r ellipses with the conjugate half-diameters p and q, (3, r) each.

    Principal half-axes are p cos t + q sin t and q cos t - p sin t where tan 2t = 2 p.q / (p.p - q.q). sizes: (r, 2)
    their lengths, at least `least`, (r, 1). sized: the original lengths, which shrinking is relative to.
    """

    def __init__(self, p: np.ndarray, q: np.ndarray, sized: np.ndarray):
        pp, qq, pq = _dot(p, p), _dot(q, q), _dot(p, q)
        angle = np.arctan2(2 * pq, pp - qq) / 2
        # Axes that are still at right angles, as after a rotation, are kept in their order, whichever is longer.
        angle[np.abs(pq) < 1e-6 * np.sqrt(pp * qq)] = 0
        self.cosine, self.sine = np.cos(angle), np.sin(angle)
        long = p * self.cosine + q * self.sine
        self._long, self._normal = long, _cross(long, q * self.cosine - p * self.sine)
        lengths = np.sqrt(_dot(long, long)), np.sqrt(np.maximum(pp + qq - _dot(long, long), 0))
        self.least = (_LEAST_SHRINKING * sized)[:, None]
        self.sizes = np.maximum(np.stack(lengths, axis=1), self.least)
        self.has_plane = _dot(self._normal, self._normal) > 0

    def rotations(self, which: np.ndarray) -> np.ndarray:
        """(w, 4) unit quaternions of the ellipses that have a plane."""
        x, z = _unit_columns(self._long[:, which]), _unit_columns(self._normal[:, which])
        return axes_quaternions(x.T, _cross(z, x).T, z.T)


def _dot(a, b) -> np.ndarray:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def _cross(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    return np.stack([a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]])


def _unit_columns(vectors: np.ndarray, fallback: np.ndarray | float = 0.0) -> np.ndarray:
    """(3, n) unit vectors; the fallback for vectors without length."""
    length = np.sqrt(_dot(vectors, vectors))
    usable = (length > 0) & np.isfinite(length)
    if usable.all():
        return vectors / length
    return np.where(usable, vectors / np.where(usable, length, 1), fallback)


def _interpolated(mesh: TriangleMesh, basis: _Basis, triangles, place: np.ndarray, of_run: np.ndarray) -> np.ndarray:
    """(3, n) float32 unit shading normals at (2, n) coordinates; the triangle's own normal if the corners have none."""
    own = _unit_columns(basis.columns[2]).astype(np.float32)
    if mesh.corner_normals is None:
        return own.take(of_run, axis=1)
    # clamped into the triangle, as for samples on its outline
    second, third = np.clip(place, 0, 1)
    third = np.minimum(third, 1 - second)
    corners = _corner_normals(mesh, triangles)
    weights = 1 - second - third, second, third
    normals = np.stack([_dot([c[k].take(of_run) for c in corners], weights) for k in range(3)])
    return _unit_columns(normals, own.take(of_run, axis=1))


def _corner_normals(mesh: TriangleMesh, triangles: np.ndarray) -> np.ndarray:
    """(3, 3, r) float32: by corner and component."""
    return np.ascontiguousarray(np.moveaxis(mesh.corner_normals[triangles], 0, 2), np.float32)


def _stretch(p: np.ndarray, q: np.ndarray, sizes: np.ndarray) -> np.ndarray:
    """(r,) largest factor by which any direction in each ellipse's plane has grown.

    p, q: (3, r) images of the half-axes, whose lengths were `sizes`, (r, 2).
    """
    p, q = p / sizes[:, 0], q / sizes[:, 1]
    pp, qq, pq = _dot(p, p), _dot(q, q), _dot(p, q)
    return np.sqrt((pp + qq) / 2 + np.hypot((pp - qq) / 2, pq))
