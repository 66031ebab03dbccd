# SPDX-License-Identifier: GPL-3.0-or-later
"""Convex bodies with eight corners: boxes of objects, and the visible part of space.

The bits of a corner's number tell on which of two opposite sides it is, in each of three directions.
"""

from __future__ import annotations

import numpy as np

#: Three corners of each face.
FACES = np.array([(0, 1, 2), (4, 5, 6), (0, 1, 4), (2, 3, 6), (0, 2, 4), (1, 3, 5)])
#: Two corners of each edge, and the two faces that meet there.
EDGES = np.array(
    [
        (0, 1, 0, 2), (2, 3, 0, 3), (0, 2, 0, 4), (1, 3, 0, 5), (4, 5, 1, 2), (6, 7, 1, 3),
        (4, 6, 1, 4), (5, 7, 1, 5), (0, 4, 2, 4), (1, 5, 2, 5), (2, 6, 3, 4), (3, 7, 3, 5),
    ]
)  # fmt: skip
#: The edges of a square pyramid with its apex at 0, which is one deep and one wide to each side.
_RAYS = np.array([(x, y, -1.0) for x in (-1, 1) for y in (-1, 1)])
#: Normals of its sides that point inward.
_SIDES = np.array([(1, 0, -1.0), (-1, 0, -1.0), (0, 1, -1.0), (0, -1, -1.0)])
#: Both ends of each edge and of each ray.
_PLACES = 2 * (len(EDGES) + len(_RAYS))


def planes(normals: np.ndarray, through: np.ndarray, middle: np.ndarray) -> np.ndarray:
    """(..., 4) planes with unit normals (..., 3) that point to the side of a middle, through points; zeros where a
    normal is zero. Products with a place and 1 are distances."""
    lengths = np.linalg.norm(normals, axis=-1, keepdims=True)
    unit = np.divide(normals, lengths, out=np.zeros_like(normals), where=lengths > 0)
    found = np.concatenate([unit, -np.sum(unit * through, axis=-1, keepdims=True)], axis=-1)
    inward = np.sum(unit * (middle - through), axis=-1, keepdims=True)
    return np.where(inward < 0, -found, found)


def face_planes(corners: np.ndarray) -> np.ndarray:
    """(..., 6, 4) of bodies with (..., 8, 3) corners."""
    first, second, third = (corners[..., FACES[:, k], :] for k in range(3))
    return planes(np.cross(second - first, third - first), first, corners.mean(axis=-2)[..., None, :])


def places_in_pyramid(corners: np.ndarray, half: float, reach: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(n, k, 3) places whose convex hull holds what lies in a view of each body, and (n, k) which of them count.

    corners: (n, 8, 3) in a view along -Z from 0. half: its window is a square of so much to each side, on the plane at
    distance 1. reach: (n,) the view is widened by this length in all directions.
    """
    back = np.zeros((len(corners), 1, 3))
    back[:, 0, 2] = reach * np.hypot(1, half) / half
    moved = corners - back
    sides = (moved * (1, 1, half)) @ _SIDES.T
    # of many bodies, most are beyond one side
    near = np.flatnonzero((sides >= 0).any(axis=1).all(axis=1))
    places, are_places = np.zeros((len(corners), _PLACES, 3)), np.zeros((len(corners), _PLACES), bool)
    found, are_places[near] = _met(moved[near], sides[near], half, reach[near])
    places[near] = found + back[near]
    return places, are_places


def _met(moved: np.ndarray, sides: np.ndarray, half: float, reach: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The same of bodies in the view of the widened pyramid, from the distances of their corners on the inner side of
    its sides."""
    start, end = EDGES[:, 0], EDGES[:, 1]
    of_edges, are_edges = _clipped(moved[:, start], moved[:, end], sides[:, start], sides[:, end])
    rays = _RAYS * (half, half, 1.0) * np.maximum(-moved[..., 2].min(axis=1), 0.0)[:, None, None]
    faces = face_planes(moved)
    begins = np.broadcast_to((faces[..., 3] + reach[:, None])[:, None], (len(moved), 4, 6))
    ends = begins + rays @ faces[..., :3].transpose(0, 2, 1)
    of_rays, are_rays = _clipped(np.zeros_like(rays), rays, begins, ends)
    return np.concatenate([of_edges, of_rays], axis=1), np.concatenate([are_edges, are_rays], axis=1)


def _clipped(start, end, start_inside, end_inside) -> tuple[np.ndarray, np.ndarray]:
    """The ends of (n, m, 3) segments where they are on the inner sides of all planes (Cyrus and Beck 1978), and which
    of them are there at all. start_inside, end_inside: (n, m, p) distances of their ends on the inner side."""
    with np.errstate(divide="ignore", invalid="ignore"):
        crossing = start_inside / (start_inside - end_inside)
    enters, leaves = (start_inside < 0) & (end_inside >= 0), (start_inside >= 0) & (end_inside < 0)
    first = np.where(enters, crossing, 0.0).max(axis=2)
    last = np.where(leaves, crossing, 1.0).min(axis=2)
    is_there = (first <= last) & ~((start_inside < 0) & (end_inside < 0)).any(axis=2)
    along = end - start
    places = np.concatenate([start + first[..., None] * along, start + last[..., None] * along], axis=1)
    return places, np.concatenate([is_there, is_there], axis=1)
