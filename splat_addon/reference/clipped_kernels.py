# SPDX-License-Identifier: GPL-3.0-or-later
"""Resampling kernels of clipped splats in `render_ewa`: how much of a splat a pixel sees, and what hides it.

The twin of shaders/features/clip_lines.glsl, for many splats at once and for rays.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from .methods.clip_lines import clipped_share, there
from .rays import RayGrid
from .splats import Splats

#: Pixels past a line, up to which a sample's area is at most partly beyond it.
TO_WITHIN = 0.75

#: Pixels by which the distance to a line may be wrong; and where a splat is narrower than a pixel.
TO_LINE, TO_NARROW = 0.25, 0.1

#: How many times as steep one surface may be on one side of a line as on the other.
STEEPER = 3.0

#: Pixels, as a length at the splat, by which a face beyond a concave crease may be nearer than the radius allows.
NEARER_PIXELS = 4.0


def kernel_ends(
    splats: Splats, grid: RayGrid, ray: np.ndarray, splat: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """(M,) share of each kernel that its lines keep, (M,) how far in pixels rays have passed the nearest line, -inf if
    there is none, and (M, 2) the unit vector from it to where splats are kept.

    ray, splat: (M,) numbers.
    """
    share, past, way = np.ones(len(ray)), np.full(len(ray), -np.inf), np.zeros((len(ray), 2))
    rows = np.flatnonzero((splats.clip[splat, :, 2] < 1).any(axis=1))
    if not len(rows):
        return share, past, way
    of, lines, reflex = splat[rows], there(splats.clip[splat[rows]]), splats.reflex[splat[rows]]
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        place, change = _places(splats, grid, ray[rows], of)
        share[rows] = clipped_share(place, change, lines, reflex)
        gradient = np.einsum("nli,nij->nlj", lines[..., :2], change)
        length = np.maximum(np.linalg.norm(gradient, axis=2), 1e-20)
        inside = (np.einsum("nli,ni->nl", lines[..., :2], place) + lines[..., 2]) / length
        first = np.where(reflex, inside[:, 0] > inside[:, 1], inside[:, 0] < inside[:, 1])
        one = np.arange(len(rows)), np.where(first, 0, 1)
        direction = gradient[one] / length[one][:, None]
    told = np.flatnonzero(np.isfinite(inside[one]) & np.isfinite(direction).all(axis=1))
    past[rows[told]], way[rows[told]] = -inside[one][told], direction[told]
    return share, past, way


def seen_near_lines(
    splats: Splats, grid: RayGrid, ray: np.ndarray, splat: np.ndarray, past: np.ndarray, way: np.ndarray,
    visibility: np.ndarray, depth_on: Callable[[np.ndarray, np.ndarray], np.ndarray], epsilon: float,
) -> np.ndarray:  # fmt: skip
    """(M,) bool: whether one of their lines lets splats be seen on rays that have passed it, or are within TO_LINE.

    Past it, they are seen if they are seen before the line and only the face beyond it hides them, which meets their
    plane there. If the ray before the line is past another one, because the splat is narrow, the same must hold there.
    Before it, they are seen unless a wall goes through that their face ends at the back of.
    ray, splat: (M,) numbers. past, way: of `kernel_ends`. visibility: (count,) depth up to which each ray sees.
    depth_on(splat, ray): (M,) depths of planes on rays, held near the splats. epsilon: in radii.
    """
    before = grid.numbers(*np.floor(grid.columns_rows(ray) + 0.5 + ((TO_WITHIN + past)[:, None] * way).T))
    nearer_before = depth_on(splat, before) - visibility[before]
    _, past_other, other_way = kernel_ends(splats, grid, before, splat)
    nearer, apart = depth_on(splat, ray) - visibility[ray], (1 + 4 * epsilon) * splats.radius()[splat]
    depth = np.ones(len(splat)) if grid.camera.is_orthographic else -splats.center[splat, 2]
    is_narrow, most_before = past_other > 0, np.zeros(len(ray))
    some = np.flatnonzero(is_narrow)
    of = before[some], splat[some], other_way[some], visibility, nearer_before[some]
    with np.errstate(divide="ignore", invalid="ignore"):
        most_before[some] = _growth(splats, grid, *of) * (past_other[some] + TO_NARROW)
        growth = _growth(splats, grid, ray, splat, way, visibility, nearer)
        most = np.minimum(
            apart + NEARER_PIXELS * depth * grid.steps()[0], growth * (past + np.where(is_narrow, TO_NARROW, TO_LINE))
        )
        farther = growth * past_other
        is_through = (nearer_before > 0) & (nearer_before < STEEPER * farther) & (farther < STEEPER * nearer_before)
    is_seen = (nearer_before <= np.maximum(most_before, 0)) & (
        nearer <= np.maximum(np.where(is_narrow, 0, apart), most)
    )
    return np.where(past > 0, is_seen, (nearer <= 0) & ~is_through)


def _growth(splats: Splats, grid: RayGrid, ray, splat, way: np.ndarray, visibility, nearer) -> np.ndarray:
    """(M,) by how much per pixel the visible surface comes nearer than the plane, from the ray to the next away from
    the line; -inf if that ray sees nothing.

    nearer: (M,) by how much it is nearer on the ray.
    """
    at = grid.columns_rows(ray)
    beyond = np.floor(at + 0.5 - way.T)
    origin, direction = grid.through(*beyond)
    further = _depth(splats, splat, origin, direction) - visibility[grid.numbers(*beyond)]
    return (further - nearer) / np.einsum("in,ni->n", at - beyond, way)


def _places(splats: Splats, grid: RayGrid, ray: np.ndarray, splat: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(M, 2) where rays meet planes, in half-axes, infinite where they do not; (M, 2, 2) their change by a pixel."""
    origin, direction = grid.rays(ray)
    across = origin if grid.camera.is_orthographic else direction
    steps = grid.steps()
    place, ends = _met(splats, splat, origin, direction), []
    for axis in (0, 1):
        for step in (-0.5, 1.0):
            across[:, axis] += step * steps[axis]
            ends.append(_met(splats, splat, origin, direction))
        across[:, axis] -= 0.5 * steps[axis]
    return place, np.stack([ends[1] - ends[0], ends[3] - ends[2]], axis=2)


def _met(splats: Splats, splat: np.ndarray, origin: np.ndarray, direction: np.ndarray) -> np.ndarray:
    plane, u, v, center = (a[splat] for a in (splats.plane, splats.u, splats.v, splats.center))
    depth = _depth(splats, splat, origin, direction)
    offset = origin + depth[:, None] * direction - center
    square = np.einsum("ij,ij->i", plane, plane)
    place = np.stack(
        [np.einsum("ij,ij->i", offset, dual) / square for dual in (np.cross(v, plane), np.cross(plane, u))], axis=1
    )
    return np.where(depth[:, None] > 0, place, np.inf)


def _depth(splats: Splats, splat: np.ndarray, origin: np.ndarray, direction: np.ndarray) -> np.ndarray:
    """(M,) depth at which rays meet planes, negative behind the eye."""
    plane = splats.plane[splat]
    across = np.einsum("ij,ij->i", plane, splats.center[splat] - origin)
    return across / np.einsum("ij,ij->i", plane, direction)
