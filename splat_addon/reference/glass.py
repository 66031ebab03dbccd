# SPDX-License-Identifier: GPL-3.0-or-later
"""The ways of light through surfaces of glass, in float64: every ray against every triangle and disc.

The twin of shaders/features/glass.glsl, which walks a tree of boxes instead. Discs that overlap are not averaged here:
the nearest counts.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ..rendering.scene.glass_surfaces import GlassSurfaces
from .brdf import dot, unit

#: Surfaces that a ray crosses or is reflected by, at most.
CROSSINGS = 10
#: Pairs of a ray and a primitive that are looked at together.
_PAIRS = 1 << 20


class Left(NamedTuple):
    """Where n rays leave the glass, relative to its origin, in which direction, and the share of light that comes along
    them. spread: radians, of the directions, by which rough surfaces part them."""

    places: np.ndarray
    directions: np.ndarray
    share: np.ndarray
    spread: np.ndarray


def fresnel(cosine: np.ndarray, ratio: np.ndarray) -> np.ndarray:
    """Reflectance of a dielectric. ratio: of the indices of refraction, behind the surface over before it."""
    square = (1 - cosine**2) / ratio**2
    behind = np.sqrt(np.maximum(1 - square, 0))
    across = (cosine - ratio * behind) / (cosine + ratio * behind)
    along = (ratio * cosine - behind) / (ratio * cosine + behind)
    return np.where(square >= 1, 1.0, (across**2 + along**2) / 2)


def refracted(along: np.ndarray, normal: np.ndarray, ratio: np.ndarray) -> np.ndarray:
    """(n, 3) directions behind a surface that faces the rays; what is reflected totally is mirrored."""
    cosine = -dot(normal, along)
    square = (1 - cosine**2) / ratio**2
    through = along / ratio[:, None] + (cosine / ratio - np.sqrt(np.maximum(1 - square, 0)))[:, None] * normal
    return np.where((square < 1)[:, None], through, along + 2 * cosine[:, None] * normal)


def through_glass(surfaces: GlassSurfaces, places, directions, normals, tint, ior: float, roughness: float) -> Left:
    """Follow rays that enter glass at (n, 3) places, relative to the origin. normals: (n, 3), towards the rays. tint,
    ior, roughness: of the surface there."""
    count, rough = len(places), roughness**2
    ratio = np.full(count, float(ior))
    along, from_, side = refracted(directions, normals, ratio), np.array(places, np.float64), np.ones(count)
    share = np.tile(np.asarray(tint, np.float64), (count, 1))
    spread = np.full(count, (rough * (ior - 1) / ior) ** 2)
    goes = np.ones(count, bool)
    for _ in range(CROSSINGS):
        met, away, normal = met_first(surfaces, from_, along, side)
        goes &= met >= 0
        if not goes.any():
            break
        met, one = met[goes], surfaces.iors[met[goes]]
        from_[goes] += along[goes] * away[goes, None]
        against = normal[goes] * -np.sign(dot(normal, along)[goes, None])
        ratio, cosine = np.where(side[goes] > 0, 1 / one, one), np.clip(-dot(against, along[goes]), 0, 1)
        lost, rough = fresnel(cosine, ratio), surfaces.roughness[met] ** 2
        crosses = lost < 1
        along[goes] = unit(refracted(along[goes], against, ratio))
        bends = (rough * (one - 1)) ** 2 / np.where(side[goes] > 0, 1.0, ratio**2)
        spread[goes] = np.where(crosses, spread[goes] / ratio**2 + bends, spread[goes] + 4 * rough**2)
        share[goes] *= np.where(crosses[:, None], (1 - lost)[:, None] * surfaces.tints[met], 1.0)
        side[goes] *= np.where(crosses, -1, 1)
    return Left(from_, along, share, np.sqrt(spread))


def met_first(surfaces: GlassSurfaces, places, directions, side) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """For n rays, the number of the primitive that each meets first, -1 for none, how far away, and its normal there.

    side: (n,) 1 for surfaces at which a ray leaves glass, -1 for those at which it enters.
    """
    corners, count = surfaces.corners, len(places)
    are_discs, first = surfaces.are_discs, surfaces.normals[:, 0]
    u = np.where(are_discs[:, None], corners[:, 1], corners[:, 1] - corners[:, 0])
    v = np.where(are_discs[:, None], corners[:, 2], corners[:, 2] - corners[:, 0])
    flat = np.cross(u, v)
    flat *= np.where(are_discs, np.sign(dot(flat, first)), 1.0)[:, None]
    uu, vv, uv = dot(u, u), dot(v, v), dot(u, v)
    found, away, normals = np.full(count, -1), np.full(count, np.inf), np.zeros((count, 3))
    step = max(_PAIRS // max(len(corners), 1), 1)
    for start in range(0, count, step):
        some = slice(start, start + step)
        facing = directions[some] @ flat.T
        with np.errstate(divide="ignore", invalid="ignore"):
            distance = (dot(flat, corners[:, 0]) - places[some] @ flat.T) / facing
            at = places[some, None] + distance[..., None] * directions[some, None] - corners[:, 0]
            au, av = (at * u).sum(axis=2), (at * v).sum(axis=2)
            area = uu * vv - uv**2
            x, y = (vv * au - uv * av) / area, (uu * av - uv * au) / area
            within = np.where(are_discs, x**2 + y**2 <= 1, np.minimum(np.minimum(x, y), 1 - x - y) >= -1e-5)
        meets = within & (distance > 0) & (facing * side[some, None] > 0)
        distance = np.where(meets, distance, np.inf)
        nearest = distance.argmin(axis=1)
        rows = np.arange(len(nearest))
        away[some] = distance[rows, nearest]
        found[some] = np.where(np.isfinite(away[some]), nearest, -1)
        x, y = x[rows, nearest, None], y[rows, nearest, None]
        of = surfaces.normals[nearest]
        smooth = of[:, 0] * (1 - x - y) + of[:, 1] * x + of[:, 2] * y
        with np.errstate(invalid="ignore"):
            normals[some] = unit(np.where(are_discs[nearest, None], of[:, 0], smooth))
    return found, away, normals
