# SPDX-License-Identifier: GPL-3.0-or-later
"""The normals of bare points on their sides, and what the planes through their neighbours tell besides: which points
are noisy, lie on no surface, or lie beside one."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from .cleanup import off_surface
from .noise import NOISY, noise_levels, of_surroundings, smoothed_normals, spacings
from .normals import local_planes
from .orientation import consistent_signs, facing_outward, facing_scanners, facing_viewpoint, scanned_sides
from .outside import seen_sides


@dataclass(frozen=True, eq=False)
class EstimatedNormals:
    """normals: (N, 3) float64 unit. parts: number of connected parts that were oriented; 0 where scanners tell sides.
    off: lie off the surface. is_noisy: have normals from wider neighbourhoods. is_untrusted: lie on no surface, and
    have the direction of their surroundings: (N,) bool each.
    shifts: (N, 3) from the points to their planes, 0 where they are not noisy; None if none is.
    """

    normals: np.ndarray
    parts: int
    off: np.ndarray
    is_noisy: np.ndarray
    is_untrusted: np.ndarray
    shifts: np.ndarray | None = None

    def with_known(self, rows: np.ndarray, normals: np.ndarray) -> EstimatedNormals:
        """The same, but for points whose normals are known."""
        made = {name: getattr(self, name).copy() for name in ("normals", "off", "is_noisy", "is_untrusted")}
        made["normals"][rows] = normals
        for name in ("off", "is_noisy", "is_untrusted"):
            made[name][rows] = False
        return replace(self, **made)


def known_normals(normals: np.ndarray) -> EstimatedNormals:
    """(N, 3) unit normals, none of which was estimated."""
    return EstimatedNormals(normals, 0, *np.zeros((3, len(normals)), bool))


def estimated_normals(
    positions: np.ndarray,
    nearest: np.ndarray,
    distances: np.ndarray,
    neighbours: int,
    *,
    viewpoint: np.ndarray | None,
    scanners: np.ndarray | None,
    told: Callable[[float], None],
) -> EstimatedNormals:
    """positions: (N, 3) float64. nearest, distances: (N, k), nearest first; neighbours: how many of them give the
    normals of points without noise. viewpoint: (3,) that normals face, None: they face outward. scanners: (N, 3),
    NaN where unknown, or None. told: called with the finished share.
    """
    own = nearest[:, :neighbours]
    planes = local_planes(positions, own, report=lambda share: told(0.25 * share))
    noise, spacing = noise_levels(planes.roughness(), own), spacings(distances)
    normals, is_noisy = planes.normals, noise > NOISY * spacing
    is_untrusted, rows, shifts = np.zeros(len(positions), bool), np.flatnonzero(is_noisy), None
    if len(rows):
        wider = positions, planes, nearest, rows, lambda share: told(0.25 + 0.35 * share)
        normals[rows], middles, is_untrusted[rows] = smoothed_normals(*wider)
        shifts = np.zeros(positions.shape)
        shifts[rows] = normals[rows] * np.einsum("nc,nc->n", normals[rows], middles)[:, None]
    if scanners is not None and np.isfinite(scanners).all():
        signs, parts = scanned_sides(positions, normals, nearest, scanners), 0
    else:
        signs, parts = _signs(positions, normals, nearest, own, spacing, viewpoint, scanners, told)
    normals *= signs[:, None]
    rows = np.flatnonzero(is_untrusted)
    normals[rows] = of_surroundings(normals, nearest, rows)
    off = off_surface(planes.heights(), noise, spacing, nearest)
    return EstimatedNormals(normals, parts, off, is_noisy, is_untrusted, shifts)


def _signs(positions, normals, nearest, own, spacing, viewpoint, scanners, told) -> tuple[np.ndarray, int]:
    """(N,) signs where scanners are not known of every point, and the number of connected parts."""
    sides = seen_sides(positions, normals, own, spacing) if viewpoint is None else None
    signs, part, faces_outside = consistent_signs(
        positions, normals, nearest, sides, lambda share: told(0.6 + 0.4 * share)
    )
    normals = normals * signs[:, None]
    if viewpoint is None:
        turns = np.where(faces_outside, 1, facing_outward(positions, normals, part))
    else:
        turns = facing_viewpoint(positions, normals, part, viewpoint)
    if scanners is not None:
        turns = turns * facing_scanners(positions, normals * turns[:, None], scanners)
    return signs * turns, int(part.max()) + 1
