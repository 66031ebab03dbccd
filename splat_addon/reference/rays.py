# SPDX-License-Identifier: GPL-3.0-or-later
"""Rays against splats: what each ray sees, as weighted averages over the splats that it hits.

Second step of `render_exact`. Two sweeps over the same candidates, as the engine has two passes: the
visibility sweep finds how deep a ray may look, the attribute sweep averages what lies before that depth.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass

import numpy as np

from ..clip_lines import kept
from ..rendering.scene.camera import Camera
from ..runs import expand
from .brdf import unit
from .splats import Splats
from .textures import point_colors

#: Splat-ray pairs per batch: about 100 bytes each.
CHUNK_PAIRS = 1_000_000

#: Splat-ray pairs whose hits are held for all sweeps, 64 bytes each; if there are more, each sweep finds its own.
HELD_PAIRS = 3_000_000

#: A mean of unit normals shorter than this is rounding error of normals that cancel; the surface then faces the viewer.
CANCELLED = 1e-6
TO_VIEWER = (0.0, 0.0, 1.0)


@dataclass(frozen=True, eq=False)
class RayGrid:
    """The rays of a rectangle of sub-samples, numbered row by row from the bottom left.

    first: column and row of its first sub-sample, counted from the picture's bottom left (may be negative).
    shape: rows, columns. Indices are the picture's own, so a ray does not depend on the rectangle.
    """

    camera: Camera
    samples: int
    first: tuple[int, int]
    shape: tuple[int, int]

    @classmethod
    def of_pixels(cls, camera: Camera, samples: int, x: int, y: int, width: int, height: int) -> RayGrid:
        """The rays of the pixels x..x+width, y..y+height."""
        return cls(camera, samples, (x * samples, y * samples), (height * samples, width * samples))

    @property
    def count(self) -> int:
        return self.shape[0] * self.shape[1]

    def rays(self, rays: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Origins and directions, two (n, 3) arrays in eye space; direction z is -1, so that a depth is a parameter."""
        return self.through(*self.columns_rows(rays))

    def columns_rows(self, rays: np.ndarray) -> np.ndarray:
        """(2, n) columns and rows of rays."""
        row, column = np.divmod(rays, self.shape[1])
        return np.stack([column, row])

    def numbers(self, column: np.ndarray, row: np.ndarray) -> np.ndarray:
        """(n,) numbers of the rays that are nearest to columns and rows, which may be outside the grid."""
        rows, columns = self.shape
        return (np.clip(row, 0, rows - 1) * columns + np.clip(column, 0, columns - 1)).astype(np.int64)

    def across(self, rays: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Two (n,) coordinates of rays in the window plane."""
        return self._across(*self.columns_rows(rays))

    def _across(self, column: np.ndarray, row: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        left, bottom = self._corner()
        step_x, step_y = self.steps()
        return left + (self.first[0] + column + 0.5) * step_x, bottom + (self.first[1] + row + 0.5) * step_y

    def through(self, column: np.ndarray, row: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """As `rays`, for n columns and rows, which may be outside the grid."""
        origin, direction = np.zeros((len(row), 3)), np.zeros((len(row), 3))
        across = origin if self.camera.is_orthographic else direction
        across[:, 0], across[:, 1] = self._across(column, row)
        direction[:, 2] = -1
        return origin, direction

    def boxes(self, low: np.ndarray, high: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Window-plane boxes (N, 2) as first and end (column, row) in this grid, two (N, 2) integer arrays."""
        limit = np.array(self.shape[::-1])
        first = np.ceil((low - self._corner()) / self.steps() - self.first - 0.5 - 1e-6)
        end = np.floor((high - self._corner()) / self.steps() - self.first - 0.5 + 1e-6) + 1
        return tuple(np.clip(edge, 0, limit).astype(np.int64) for edge in (first, end))

    def _corner(self) -> np.ndarray:
        return np.array([self.camera.window[0], self.camera.window[2]])

    def steps(self) -> np.ndarray:
        """(2,) from a ray to the next, as a length at depth 1."""
        left, right, bottom, top = self.camera.window
        return np.array([right - left, top - bottom]) / np.array(self.camera.size) / self.samples


@dataclass(frozen=True, eq=False)
class Surface:
    """What the n rays that hit something see, averaged over the splats with their weights, eye space.

    rays: (n,) numbers in the grid. color: (n, 3). normal: (n, 3) unit. depth: (n,).
    roughness, metallic, f0: (n,). emission: (n, 3). light_set: (n, 4) the share of each set of objects. finish: (n, F)
        the numbers of a `Finish`, none if the scene has no finishes.
    weight: (n,) sum of the splats' weights. count: (n,) of splats.
    opacity: (n,); the splats' own weigh their colours, too.
    """

    rays: np.ndarray
    color: np.ndarray
    normal: np.ndarray
    depth: np.ndarray
    roughness: np.ndarray
    metallic: np.ndarray
    f0: np.ndarray
    emission: np.ndarray
    light_set: np.ndarray
    finish: np.ndarray
    weight: np.ndarray
    count: np.ndarray
    opacity: np.ndarray


@dataclass(frozen=True, eq=False)
class Hits:
    """M meetings of a ray with a splat: their numbers, the place (M, 2) in the ellipse and its rho^2, the depth along
    -Z, the direction's length, and how far the ray leaves the plane while the depth grows by 1."""

    ray: np.ndarray
    splat: np.ndarray
    place: np.ndarray
    rho2: np.ndarray
    depth: np.ndarray
    stretch: np.ndarray
    facing: np.ndarray


def visible_surface(splats: Splats, bounds, grid: RayGrid, epsilon: float, limit=np.inf) -> Surface:
    """The surfaces that the rays of the grid see. bounds: `projected_bounds` of the splats. epsilon: in radii of each
    splat.

    limit: (count,) depth beyond which something else hides splats.
    """
    splats, boxes = splats_in(splats, bounds, grid)
    sweep = _sweep(splats, boxes, grid)
    seen = np.minimum(_visible_depth(splats, grid, sweep(), epsilon), limit)
    return average(splats, grid, _seen(splats, grid, sweep(), seen))


def visible_depth(splats: Splats, boxes, grid: RayGrid, epsilon: float) -> np.ndarray:
    """(count,) depth up to which each ray sees: that of its nearest hit, with each splat moved back by its epsilon."""
    return _visible_depth(splats, grid, _hits(splats, boxes, grid), epsilon)


def _visible_depth(
    splats: Splats, grid: RayGrid, found: Iterable[Hits], epsilon: float, after=-np.inf, until=np.inf
) -> np.ndarray:
    """As `visible_depth`, of hits that were found. after, until: depths, or (count,) of them; only hits beyond `after`
    and not beyond `until` count.
    """
    push, blend = splats.push(epsilon), splats.blend_depth()
    visibility = np.full(grid.count, np.inf)
    for hits in found:
        between = _between(hits, grid, after, until)
        # A point e moved back to e (1 + push / |e|) gains push / |direction| in depth, as |e| = depth |direction|.
        moved = hits.depth + np.minimum(push[hits.splat] / hits.stretch, blend[hits.splat] / hits.facing)
        np.minimum.at(visibility, hits.ray[between], moved[between])
    return visibility


def layer_surfaces(splats: Splats, bounds, grid: RayGrid, epsilon: float, opaque: np.ndarray) -> Iterator[Surface]:
    """The surfaces that every ray sees in each transparent layer, nearest first (Guennebaud et al. 2006, section 6).

    A layer contains the hits beyond the previous layer's depth, up to its own depth, which is that of the nearest of
    these hits, moved back. opaque: (count,) depth up to which each ray sees opaque splats.
    """
    splats, boxes = splats_in(splats, bounds, grid)
    sweep = _sweep(splats, boxes, grid)
    peeled = np.full(grid.count, -np.inf)
    while True:
        depth = _visible_depth(splats, grid, sweep(), epsilon, peeled, opaque)
        if not np.isfinite(depth).any():
            return
        yield average(splats, grid, _seen(splats, grid, sweep(), np.minimum(depth, opaque), peeled))
        peeled = depth


def _between(hits: Hits, grid: RayGrid, after, until) -> np.ndarray:
    """Numbers of the hits beyond `after` and not beyond `until`."""
    after, until = (np.broadcast_to(limit, grid.count)[hits.ray] for limit in (after, until))
    return np.flatnonzero((hits.depth > after) & (hits.depth <= until))


def _seen(splats: Splats, grid: RayGrid, found: Iterable[Hits], visibility: np.ndarray, after=-np.inf):
    side = splats.side_weight() * ~splats.is_holdout
    for hits in found:
        seen = _between(hits, grid, after, visibility)
        splat = hits.splat[seen]
        yield hits.ray[seen], splat, np.exp(-2 * hits.rho2[seen]) * side[splat], hits.depth[seen], hits.place[seen]


def average(splats: Splats, grid: RayGrid, contributions) -> Surface:
    """Means weighted by the splats' weights. contributions: chunks of rays, splats, weights and depths, each
    (m,), and places (m, 2).
    """
    attributes = np.concatenate([splats.color, splats.normal, splats.surface], axis=1).T
    alike = [False] * 6 + [len(row) > 0 and (row == row[0]).all() for row in attributes[6:]]
    sums, count = np.zeros((3 + len(attributes), grid.count)), np.zeros(grid.count)
    for ray, splat, weight, depth, place in contributions:
        count += np.bincount(ray, minlength=grid.count)
        weights = np.bincount(ray, weight, grid.count)
        sums[0] += weights
        sums[1] += np.bincount(ray, weight * depth, grid.count)
        colors, shown = attributes[:3, splat], weight * splats.opacity[splat]
        sums[-1] += np.bincount(ray, shown, grid.count)
        _look_textures_up(splats, splat, place, colors)
        normals = _normals_at(splats, splat, place)
        for total, row in zip(sums[2:5], colors, strict=True):
            total += np.bincount(ray, shown * row, grid.count)
        for total, row in zip(sums[5:8], normals, strict=True):
            total += np.bincount(ray, weight * row, grid.count)
        for total, row, is_alike in zip(sums[8:-1], attributes[6:], alike[6:], strict=True):
            total += weights * row[0] if is_alike else np.bincount(ray, weight * row[splat], grid.count)
    return _averages(sums, count)


def _look_textures_up(splats: Splats, splat: np.ndarray, place: np.ndarray, colors: np.ndarray):
    """Put the textures' colours at (m, 2) places of m hit splats into (3, m) colours, where there are textures."""
    for texture in set(splats.texture) - {None}:
        at = np.flatnonzero(splats.texture[splat] == texture)
        q, border = place[at], splats.uv_border[splat[at]]
        beyond = np.maximum(np.einsum("nk,nk->n", q, border) - 1, 0) / np.maximum((border**2).sum(axis=1), 1e-300)
        uvs = splats.uv[splat[at]] + np.einsum("nk,nkc->nc", q - border * beyond[:, None], splats.uv_along[splat[at]])
        colors[:, at] = point_colors(texture, uvs)[:, :3].T


def _normals_at(splats: Splats, splat: np.ndarray, place: np.ndarray) -> np.ndarray:
    """(3, m) unit normals at (m, 2) places of m hit splats."""
    if not splats.normal_along.any():
        return splats.normal[splat].T
    change = np.einsum("nk,nkc->nc", place, splats.normal_along[splat])
    return unit(splats.normal[splat] + change).T


def _averages(sums: np.ndarray, count: np.ndarray) -> Surface:
    rays = np.flatnonzero(sums[0] > 0)
    depth, *columns = sums[1:-1, rays] / sums[0, rays]
    columns[:3] = sums[2:5, rays] / sums[-1, rays]
    color, normal = np.stack(columns[:3], axis=1), np.stack(columns[3:6], axis=1)
    length = np.linalg.norm(normal, axis=1, keepdims=True)
    normal = np.where(length > CANCELLED, normal / np.maximum(length, CANCELLED), TO_VIEWER)
    emission, light_set, finish = np.split(np.stack(columns[9:], axis=1), (3, 7), axis=1)
    weight, opacity = sums[0, rays], sums[-1, rays] / sums[0, rays]
    roughness, metallic, f0 = columns[6:9]
    return Surface(
        rays, color, normal, depth, roughness, metallic, f0, emission, light_set, finish, weight, count[rays], opacity
    )


def splats_in(splats: Splats, bounds, grid: RayGrid):
    """The splats that may touch the grid, and their boxes in it."""
    first, end = grid.boxes(*bounds)
    rows = np.flatnonzero((first < end).all(axis=1))
    return splats.take(rows), (first[rows], end[rows])


def _sweep(splats: Splats, boxes, grid: RayGrid) -> Callable[[], Iterable[Hits]]:
    """What gives the hits of the grid for one sweep after another."""
    first, end = boxes
    if (end - first).prod(axis=1).sum() > HELD_PAIRS:
        return lambda: _hits(splats, boxes, grid)
    held = list(_hits(splats, boxes, grid))
    return lambda: held


def _hits(splats: Splats, boxes, grid: RayGrid) -> Iterator[Hits]:
    """Every hit in the grid, in chunks."""
    rows = np.arange(len(splats))
    for ray, splat in candidates(rows, *boxes, grid):
        yield _intersections(splats, ray, splat, grid)


def candidates(rows: np.ndarray, first: np.ndarray, end: np.ndarray, grid: RayGrid):
    """Ray and splat numbers of all pairs of a splat with a ray in its box, two (M,) arrays, in chunks.

    rows: (n,) numbers of splats. first, end: (n, 2) their boxes in the grid.
    """
    pairs = (end - first).prod(axis=1)
    chunk = np.cumsum(pairs) // CHUNK_PAIRS
    for part in np.split(np.arange(len(pairs)), np.flatnonzero(np.diff(chunk)) + 1):
        count, low, width = pairs[part], first[part], (end - first)[part, 0]
        owner, within = expand(count)
        row, column = np.divmod(within, width[owner])
        ray = (row + low[owner, 1]) * grid.shape[1] + column + low[owner, 0]
        yield ray, rows[part][owner]


def _intersections(splats: Splats, ray, splat, grid: RayGrid) -> Hits:
    """Ray and plane; the ellipse's coordinates by the dual basis of u and v; NaN (a ray in the plane) never hits.

    All of these are linear in the ray's place in the window, divided by a linear function for a perspective camera, so
    that their coefficients are found once for each splat.
    """
    first = splat[0] if len(splat) else 0
    chunk, local = splats.take(np.arange(first, splat[-1] + 1 if len(splat) else 0)), splat - first
    x, y = grid.across(ray)
    square = np.einsum("ij,ij->i", chunk.plane, chunk.plane)[:, None]
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        duals = np.cross(chunk.v, chunk.plane) / square, np.cross(chunk.plane, chunk.u) / square
        plane, *duals = (
            _Form(vector, np.einsum("ij,ij->i", vector, chunk.center), local) for vector in (chunk.plane, *duals)
        )
        if grid.camera.is_orthographic:
            depth, cosine = (plane.across(x, y) - plane.at_center) / plane.z, np.abs(plane.z)
            a, b = (dual.across(x, y) - depth * dual.z - dual.at_center for dual in duals)
        else:
            facing = plane.across(x, y) - plane.z
            depth, cosine = plane.at_center / facing, np.abs(facing)
            a, b = (depth * (dual.across(x, y) - dual.z) - dual.at_center for dual in duals)
        rho2 = a * a + b * b
        hit = np.flatnonzero((rho2 <= 1) & (depth >= grid.camera.near) & (depth <= grid.camera.far))
    place = np.stack([a[hit], b[hit]], axis=1)
    if chunk.is_clipped:
        inside = np.flatnonzero(kept(place, chunk.clip[local[hit]], chunk.reflex[local[hit]]))
        hit, place = hit[inside], place[inside]
    stretch = np.ones(len(hit)) if grid.camera.is_orthographic else np.sqrt(x[hit] ** 2 + y[hit] ** 2 + 1)
    facing = cosine[hit] / np.sqrt(square[:, 0])[local[hit]]
    return Hits(ray[hit], splat[hit], place, rho2[hit], depth[hit], stretch, facing)


class _Form:
    """A vector of each splat, by whose product with a point something is measured, for pairs with rays."""

    def __init__(self, vectors: np.ndarray, at_center: np.ndarray, splat: np.ndarray):
        self.x, self.y, self.z = (vectors[:, k][splat] for k in range(3))
        self.at_center = at_center[splat]

    def across(self, x: np.ndarray, y: np.ndarray) -> np.ndarray:
        return self.x * x + self.y * y
