# SPDX-License-Identifier: GPL-3.0-or-later
"""Resampling kernels of clipped splats in `render_ewa`: how much of a splat a pixel sees, and what hides it.

The twin of shaders/features/clip_lines.glsl, for many splats at once and for rays.
"""

from __future__ import annotations

import numpy as np

from .methods.clip_lines import clipped_share, there
from .rays import RayGrid
from .splats import Splats

#: Pixels past a line, up to which a sample's area is at most partly beyond it.
TO_WITHIN = 0.75


def kernel_ends(splats: Splats, grid: RayGrid, ray: np.ndarray, splat: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(M,) share of each kernel that its lines keep, and (M,) the ray on which it is seen or hidden: its own, or where
    its lines have ended it there, the nearest on which they have not.

    ray, splat: (M,) numbers.
    """
    share, nearest = np.ones(len(ray)), ray.copy()
    rows = np.flatnonzero((splats.clip[splat, :, 2] < 1).any(axis=1))
    if not len(rows):
        return share, nearest
    of, lines, reflex = splat[rows], there(splats.clip[splat[rows]]), splats.reflex[splat[rows]]
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        place, change = _places(splats, grid, ray[rows], of)
        share[rows] = clipped_share(place, change, lines, reflex)
        gradient = np.einsum("nli,nij->nlj", lines[..., :2], change)
        length = np.maximum(np.linalg.norm(gradient, axis=2), 1e-20)
        inside = (np.einsum("nli,ni->nl", lines[..., :2], place) + lines[..., 2]) / length
        first = np.where(reflex, inside[:, 0] > inside[:, 1], inside[:, 0] < inside[:, 1])
        one = np.arange(len(rows)), np.where(first, 0, 1)
        back = (TO_WITHIN - inside[one])[:, None] * gradient[one] / length[one][:, None]
    ended = np.flatnonzero((inside[one] < 0) & np.isfinite(back).all(axis=1))
    row, column = np.divmod(ray[rows[ended]], grid.shape[1])
    x, y = (np.floor(np.stack([column, row], axis=1) + 0.5 + back[ended])).T
    nearest[rows[ended]] = np.clip(y, 0, grid.shape[0] - 1) * grid.shape[1] + np.clip(x, 0, grid.shape[1] - 1)
    return share, nearest


def _places(splats: Splats, grid: RayGrid, ray: np.ndarray, splat: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(M, 2) where rays meet planes, in half-axes, infinite where they do not; (M, 2, 2) their change by a pixel."""
    origin, direction = grid.rays(ray)
    across = origin if grid.camera.is_orthographic else direction
    steps = np.array([grid.camera.window[1] - grid.camera.window[0], grid.camera.window[3] - grid.camera.window[2]])
    steps /= np.array(grid.camera.size) * grid.samples
    place, ends = _met(splats, splat, origin, direction), []
    for axis in (0, 1):
        for step in (-0.5, 1.0):
            across[:, axis] += step * steps[axis]
            ends.append(_met(splats, splat, origin, direction))
        across[:, axis] -= 0.5 * steps[axis]
    return place, np.stack([ends[1] - ends[0], ends[3] - ends[2]], axis=2)


def _met(splats: Splats, splat: np.ndarray, origin: np.ndarray, direction: np.ndarray) -> np.ndarray:
    plane, u, v, center = (a[splat] for a in (splats.plane, splats.u, splats.v, splats.center))
    depth = np.einsum("ij,ij->i", plane, center - origin) / np.einsum("ij,ij->i", plane, direction)
    offset = origin + depth[:, None] * direction - center
    square = np.einsum("ij,ij->i", plane, plane)
    place = np.stack(
        [np.einsum("ij,ij->i", offset, dual) / square for dual in (np.cross(v, plane), np.cross(plane, u))], axis=1
    )
    return np.where(depth[:, None] > 0, place, np.inf)
