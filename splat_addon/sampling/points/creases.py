# SPDX-License-Identifier: GPL-3.0-or-later
"""Finds creases among bare points: where a point's neighbours lie on two or three planes instead of one surface.

A crease is believed if planes fit the neighbours much better than a quadric does, which distinguishes an edge from a
bend. The point's own plane then gives a normal that no other side has blurred, and the line where another plane meets
it is a clip line (`clip_lines`) if the points of the own plane end there. Limits: noise of a quarter of the spacing
hides creases; edges closer to each other than the neighbours reach, about three spacings, are not told apart; splats
at reflex corners, where the surface goes on beyond two lines, are not clipped.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, fields

import numpy as np

from ...clip_lines import CLIP_FIELDS, pack_lines
from .plane_fits import Planes, fitted_planes, quadric_roughness

#: Radians; planes that meet at less are taken for a bend, of which smooth scans are full.
DEFAULT_CREASE_ANGLE = math.radians(40)

#: Neighbours that planes are fitted to. With 16 instead, an eighth of a cube's edges is missed without any noise.
CREASE_NEIGHBOURS = 32

#: Points per batch: their temporaries stay in the processor's cache.
_CHUNK = 1024

#: Each plane needs at least this many points: one through three fits any noise.
_FEWEST = 4

#: The points' root mean square distance from their planes, in spacings, beyond which there is noise instead of an edge.
_ROUGHEST = 0.15

#: Planes must fit this many times better than a quadric, and three planes this many times better than two.
_BETTER = 1.5

#: Of this many nearest neighbours, those within a spacing of a line must confirm it: at least this share of them must
#: have a line of their own within this cosine of its direction. Bends have lines as well, but each another one.
_CONFIRMING, _LEAST_CONFIRMED, _ALIKE = 16, 0.3, 0.9

#: Points of the own plane that lie beyond a line by more than this, in spacings, contradict it.
_BEYOND = 0.25


@dataclass(frozen=True, eq=False)
class Creases:
    """What was found at n of the points.

    points: (n,) ascending. normals: (n, 3) unit, of each point's own side, with the sign of the normals given.
    inward: (n, 2, 3) unit vectors in that side's plane, across each line, 0 where there is none. distances: (n, 2) of
    the point from each line, object units; negative beyond it, infinite where there is none. Where there are two, both
    end the surface. spacings: (n,) of all points around each one, object units. cosine: of the angle that makes a
    crease.
    """

    points: np.ndarray
    normals: np.ndarray
    inward: np.ndarray
    distances: np.ndarray
    spacings: np.ndarray
    cosine: float


def find_creases(
    positions: np.ndarray,
    normals: np.ndarray,
    neighbours: np.ndarray,
    distances: np.ndarray,
    angle: float,
    report: Callable[[float], None] = lambda share: None,
) -> Creases:
    """The creases near N points, where planes meet at more than an angle in radians.

    positions, normals: (N, 3) float64, normals unit. neighbours, distances: (N, k) nearest first. report: called with
    the finished share.
    """
    columns, normal_columns = (np.ascontiguousarray(of.T) for of in (positions, normals))
    uneven = _uneven_points(normal_columns, neighbours, np.cos(angle / 2))
    found = []
    for start in range(0, len(uneven), _CHUNK):
        points = uneven[start : start + _CHUNK]
        members = np.concatenate([points[None], neighbours[points].T])
        size = distances[points, -1].astype(np.float64)
        places = np.stack([(column[members] - column[points]) / size for column in columns])
        directions = np.stack([column[members] for column in normal_columns])
        found += _creases_of(points, places, directions, size, np.cos(angle))
        report((start + len(points)) / len(uneven))
    return _confirmed(_joined(found, np.cos(angle)), columns, neighbours)


def clip_fields(creases: Creases, axes: np.ndarray, normals: np.ndarray, scales: np.ndarray) -> dict[str, np.ndarray]:
    """The fields among `CLIP_FIELDS` that any of N surfels needs. axes: (N, 3) the longer axes, unit. normals: (N, 3)
    unit, across the ellipses. scales: (N, 2) half-axes."""
    x, z = axes[creases.points], normals[creases.points]
    half_axes = [axis * scales[creases.points, k, None] for k, axis in enumerate((x, np.cross(z, x)))]
    along = [np.einsum("nlc,nc->nl", creases.inward, axis) for axis in half_axes]
    is_line = np.isfinite(creases.distances)
    lines = np.stack([*along, np.where(is_line, creases.distances, 1)], axis=2)
    # A turn to the left from the first line to the second makes a convex corner.
    turn = along[0][:, 0] * along[1][:, 1] - along[0][:, 1] * along[1][:, 0]
    swap = turn < 0
    lines[swap] = lines[swap][:, ::-1]
    packed = np.stack([pack_lines(line) for line in lines.swapaxes(0, 1)])
    packed[~is_line.T] = 0
    cuts = packed[..., 1] > 0
    first_misses = ~cuts[0] & cuts[1]
    packed[:, first_misses] = packed[::-1, first_misses]
    result = {name: np.zeros((len(scales), 2), np.int16) for name in CLIP_FIELDS}
    for values, found in zip(result.values(), packed, strict=True):
        values[creases.points] = found
    return {name: values for name, values in result.items() if values[:, 1].any()}


def _uneven_points(normals: np.ndarray, neighbours: np.ndarray, least: float) -> np.ndarray:
    """The points with a neighbour whose normal, or its opposite, differs by more than a cosine. normals: (3, N)."""
    uneven = np.zeros(len(neighbours), bool)
    for start in range(0, len(neighbours), _CHUNK):
        part = slice(start, start + _CHUNK)
        cosines = sum(column[neighbours[part]] * column[part, None] for column in normals)
        uneven[part] = (np.abs(cosines) < least).any(axis=1)
    return np.flatnonzero(uneven)


def _creases_of(points, places: np.ndarray, directions: np.ndarray, size: np.ndarray, cosine: float) -> list[Creases]:
    """The creases of n points; places, in units of size, (n,), and directions: (3, m, n) of each one and its
    neighbours."""
    every, spacing = np.arange(len(points)), np.sqrt(np.pi / places.shape[1])
    # Planes begin at the members whose normals differ most: those are farthest from the crease, and blurred least.
    unlike, seeds = [], [0]
    for _ in range(3):
        seed = directions[:, seeds[-1], every]
        unlike.append(np.abs(np.einsum("cn,cmn->mn", seed, directions)))
        seeds.append(np.maximum.reduce(unlike[1:] or unlike).argmin(axis=0))
    centres, normals = (np.stack([of[:, seed, every] for seed in seeds[1:]]) for of in (places, directions))
    two, three = (fitted_planes(places, centres[:count], normals[:count]) for count in (2, 3))
    is_corner = (three.roughness * _BETTER < two.roughness) & (three.counts.min(axis=0) >= _FEWEST)
    bend, found = quadric_roughness(places), []
    for planes, chosen in ((two, ~is_corner), (three, is_corner)):
        good = chosen & (planes.counts.min(axis=0) >= _FEWEST) & (planes.roughness < _ROUGHEST * spacing)
        rows = np.flatnonzero(good & (planes.roughness * _BETTER < bend))
        found.append(_meeting(planes.take(rows), points[rows], directions[:, 0, rows], size[rows], spacing, cosine))
    return found


def _meeting(planes: Planes, points, directions, size, spacing: float, cosine: float) -> Creases:
    """The creases of n points on planes that fit.

    directions: (3, n) that their own planes' normals shall agree with.
    """
    every, mine = np.arange(len(points)), planes.group[0]
    normals, own_heights = planes.normals[mine, :, every].T, planes.heights[mine, :, every].T
    is_own = planes.group == mine
    inward, distances = np.zeros((2, 3, len(points))), np.full((2, len(points)), np.inf)
    for line in range(len(planes.normals) - 1):
        other = (mine + 1 + line) % len(planes.normals)
        towards, heights = planes.normals[other, :, every].T, planes.heights[other, :, every].T
        dot = (towards * normals).sum(axis=0)
        sine = np.sqrt(np.maximum(1 - dot * dot, 1e-12))
        # How far the members' feet in the own plane are from the line where the other plane meets it.
        away = (heights - own_heights * dot) / sine
        side = np.where((away * is_own).sum(axis=0) < 0, -1, 1)
        goes_on = (is_own & (away * side < -_BEYOND * spacing)).any(axis=0)
        meets = (np.abs(dot) < cosine) & ~goes_on
        inward[line] = np.where(meets, (towards - dot * normals) / sine * side, 0)
        distances[line] = np.where(meets, away[0] * side * size, np.inf)
    good = np.flatnonzero(np.isfinite(distances).any(axis=0))
    sign = np.where((normals * directions).sum(axis=0) < 0, -1, 1)
    return Creases(
        points[good],
        (normals * sign).T[good],
        inward.transpose(2, 0, 1)[good],
        distances.T[good],
        spacing * size[good],
        cosine,
    )


def _confirmed(creases: Creases, columns: np.ndarray, neighbours: np.ndarray) -> Creases:
    """The creases whose lines their neighbours confirm. columns: (3, N) positions."""
    points, has_line = creases.points, np.isfinite(creases.distances)
    directions = np.zeros((len(neighbours), 2, 3), np.float32)
    directions[points] = np.cross(creases.normals[:, None], creases.inward)
    keeps = np.zeros_like(has_line)
    for start in range(0, len(points), _CHUNK):
        part = slice(start, start + _CHUNK)
        near = neighbours[points[part], :_CONFIRMING]
        away = np.stack([column[near] - column[points[part], None] for column in columns], axis=2)
        theirs = directions[near]
        for line in range(2):
            to_line = np.where(has_line[part, line], creases.distances[part, line], 0)[:, None]
            along = directions[points[part], line]
            off = away + (to_line * creases.inward[part, line])[:, None]
            off -= np.einsum("nkc,nc->nk", off, along)[:, :, None] * along[:, None]
            is_near = np.einsum("nkc,nkc->nk", off, off) < np.square(creases.spacings[part])[:, None]
            agrees = (np.abs(np.einsum("nkjc,nc->nkj", theirs, along)) > _ALIKE).any(axis=2)
            keeps[part, line] = (is_near & agrees).sum(axis=1) >= _LEAST_CONFIRMED * is_near.sum(axis=1)
    keeps &= has_line
    good = np.flatnonzero(keeps.any(axis=1))
    return Creases(
        points[good],
        creases.normals[good],
        np.where(keeps[good][:, :, None], creases.inward[good], 0),
        np.where(keeps[good], creases.distances[good], np.inf),
        creases.spacings[good],
        creases.cosine,
    )


def _joined(parts: list[Creases], cosine: float) -> Creases:
    """All creases, by point."""
    none = np.empty(0, np.intp)
    nothing = Creases(none, *(np.empty((0, *s)) for s in ((3,), (2, 3), (2,), ())), cosine)
    order = np.argsort(np.concatenate([part.points for part in (nothing, *parts)]))
    names = [field.name for field in fields(Creases)[:-1]]
    return Creases(*(np.concatenate([getattr(part, n) for part in (nothing, *parts)])[order] for n in names), cosine)
