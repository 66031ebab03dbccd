# SPDX-License-Identifier: GPL-3.0-or-later
"""The ways of light through surfaces of glass, in float64: every ray against every triangle and disc.

The twin of shaders/features/glass.glsl, which walks a tree of boxes instead; its header names the sources. Discs that
overlap are not averaged here: the nearest counts.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ..rendering.scene.glass_surfaces import GlassSurfaces
from .brdf import dot, unit

#: Surfaces that a ray crosses or is reflected by, at most.
CROSSINGS = 10
#: Rays towards a lamp, the surfaces that each meets at most, the width of their lobe, and the most that each counts.
LAMP_TAPS, LAMP_CROSSINGS, LAMP_SPREAD, LAMP_MOST = 6, 8, 0.35, 8.0
#: GGX alpha of all glass that lamps shine through, and what a crossing loses if that is not its own roughness.
LAMP_ALPHA, LAMP_LOSS, LAMP_GRAZING = 0.44, 0.06, (0.46, 0.72)
_GOLDEN_TURN = np.pi * (3 - 5**0.5)
_CLEAR_IOR = 1.001
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


def lamp_radiance(left: Left, to_lamp, irradiance: float) -> np.ndarray:
    """(n, 3) what rays that have left rough glass see of a small far lamp. to_lamp: (3,) its direction."""
    cosine = left.directions @ to_lamp / np.linalg.norm(to_lamp)
    found = _lobe(1 / np.maximum(cosine, 1e-3) ** 2 - 1, left.spread**2)
    return left.share * (irradiance * np.where(cosine > 0, found, 0.0))[:, None]


def lamp_share(surfaces: GlassSurfaces, places, normals, to_lamp, is_far: bool, turn) -> np.ndarray:
    """(n, 3) what glass leaves of a lamp's light, of the picture's first sample. places: (n, 3), relative to the
    origin. normals: (n, 3) of matt surfaces there. to_lamp: (n, 3). is_far: whether that is only a direction. turn:
    (n,) radians, by which the rays of each place are turned."""
    straight, distance = unit(to_lamp), np.linalg.norm(to_lamp, axis=1)
    lamp, facing = places + to_lamp, dot(normals, straight)
    ray = _to_lamp(surfaces, places, straight, lamp, is_far, bends=False)
    light = np.where(ray.is_bent[:, None], 0.0, ray.share)
    spread = np.full(len(places), LAMP_SPREAD)
    if not is_far:
        spread *= np.clip(1 - np.where(ray.is_bent, ray.crossed, distance / 2) / distance, 0.01, 1)
    aside = np.where(np.abs(straight[:, 2:]) < 0.7, (0.0, 0, 1), (1.0, 0, 0))
    u = unit(np.cross(aside, straight))
    v = np.cross(straight, u)
    for tap in range(LAMP_TAPS):
        within = (tap + 0.5) / LAMP_TAPS
        slope2, angle = spread**2 * within / (1 - within), (turn + tap * _GOLDEN_TURN)[:, None]
        along = unit(straight + np.sqrt(slope2)[:, None] * (u * np.cos(angle) + v * np.sin(angle)))
        weight = np.maximum(dot(along, normals), 0) / np.maximum(facing * _lobe(slope2, spread**2), 1e-30)
        ray = _to_lamp(surfaces, places, along, lamp, is_far, bends=True)
        there, rest = (
            (straight, 1.0) if is_far else (unit(lamp - ray.places), dot(lamp - ray.places, lamp - ray.places))
        )
        cosine, nearer = dot(ray.directions, there), 1.0 if is_far else distance**2 / rest
        found = _lobe(1 / np.maximum(cosine, 1e-3) ** 2 - 1, np.maximum(ray.spread2, 1e-6))
        counts = ray.is_bent & ray.is_outside & (cosine > 0)
        light += np.where(counts, np.minimum(weight * found * nearer, LAMP_MOST) / LAMP_TAPS, 0.0)[:, None] * ray.share
    return np.where((facing > 0)[:, None], light, 0.0)


def _lobe(slope2, width2):
    return width2 / (np.pi * (slope2 + width2) ** 2) * (1 + slope2) ** 1.5


class _ToLamp(NamedTuple):
    """Where rays end, in which direction, with which share of light and squared spread, whether anything bent them,
    how far from their start, and whether they are outside of glass."""

    places: np.ndarray
    directions: np.ndarray
    share: np.ndarray
    spread2: np.ndarray
    is_bent: np.ndarray
    crossed: np.ndarray
    is_outside: np.ndarray


def _to_lamp(surfaces: GlassSurfaces, places, directions, lamp, is_far: bool, bends: bool) -> _ToLamp:
    count = len(places)
    at, along, side, share = np.array(places, np.float64), np.array(directions), -np.ones(count), np.ones((count, 3))
    spread2, crossed, bent, goes = np.zeros(count), np.zeros(count), np.zeros(count, bool), np.ones(count, bool)
    for _ in range(LAMP_CROSSINGS):
        met, away, normal = met_first(surfaces, at, along, side)
        goes &= (met >= 0) & (away < (np.inf if is_far else np.linalg.norm(lamp - at, axis=1)))
        if not goes.any():
            break
        rows = np.flatnonzero(goes)
        of, one, rough = met[rows], surfaces.iors[met[rows]], surfaces.roughness[met[rows]]
        at[rows] += along[rows] * away[rows, None]
        is_clear = one <= _CLEAR_IOR
        casts, leaves = surfaces.cast[of], side[rows] > 0
        against = normal[rows] * -np.sign(dot(normal[rows], along[rows])[:, None])
        ratio, cosine = np.where(leaves, 1 / one, one), np.clip(-dot(against, along[rows]), 0, 1)
        turns = casts & ~is_clear & bends
        lost = np.where(turns, fresnel(cosine, ratio), 0.0)
        crosses = lost < 1
        own, cosine2 = np.minimum(rough**2 / LAMP_ALPHA, 1) ** 2, np.maximum(cosine**2, 1e-4)
        masking = 2 / (1 + np.sqrt(1 + LAMP_ALPHA**2 * (1 - cosine2) / cosine2))
        kept = np.where(turns, (1 - lost) * (masking * (1 - LAMP_LOSS) * (1 - own) + own), 1.0)
        kept *= np.where(turns, np.minimum(LAMP_GRAZING[0] + LAMP_GRAZING[1] * cosine, 1), 1)
        tints = np.where((casts & (turns | is_clear) & crosses)[:, None], surfaces.tints[of], 1.0)
        share[rows] *= np.where(crosses, kept, 1.0)[:, None] * tints
        width2 = (LAMP_ALPHA * (one - 1)) ** 2 / np.where(leaves, 1.0, ratio**2)
        after = np.where(crosses, spread2[rows] / ratio**2 + width2, spread2[rows] + 4 * LAMP_ALPHA**2)
        spread2[rows] = np.where(turns, after, spread2[rows])
        along[rows] = np.where(turns[:, None], unit(refracted(along[rows], against, ratio)), along[rows])
        bent[rows] |= casts & ~is_clear
        crossed[rows] = np.linalg.norm(at[rows] - places[rows], axis=1)
        side[rows] *= np.where(crosses, -1, 1)
    else:
        side[goes] = 1.0
    return _ToLamp(at, along, share, spread2, bent, crossed, side < 0)
