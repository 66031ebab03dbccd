# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfels whose centres were moved without their frames, as Blender's Apply, edit mode, Mirror, Array and Join do it.

What was moved together was moved by one affine map, which is found from where the centres were and where they are, and
then moves the whole ellipses. Several maps are found one after another, each by the consensus of most that is left
(RANSAC: Fischler and Bolles 1981).
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ..surfels import Surfels
from .placement import transformed

#: Of the largest coordinate: what float32 and a few products of it lose.
_ROUNDING = 4e-6

#: How near a map from four rows alone must come to others, of the largest coordinate.
_NEAR = 1e-3

#: Maps at most; what follows none of them keeps its frame.
MAX_MAPS = 64

#: Sets of four rows that are tried for each map, and rows on which each is tried.
_TRIALS, _JURY = 256, 512

#: Each set is taken from so many rows in a row: what is moved together mostly stands together.
_WINDOWS = (8, 64, 1024, 1 << 40)

#: A map must explain this share of what is left, or there are none to be found.
_LEAST_SHARE = 0.01

#: Rows that must agree: any four do with some map.
_FEWEST = 6

#: Rows that a map is fitted to in the end.
_FITTED = 20_000

#: Where the least of three singular values is below this share of the largest, points lie in a plane or on a line.
_FLAT = 1e-4


def followed(surfels: Surfels, rest: np.ndarray) -> tuple[Surfels, int]:
    """The surfels with their frames, sizes and normals moved as their centres were, and how many centres were moved one
    by one, whose frames are left alone.

    surfels: as they are stored, with an origin of 0. rest: (N, 3) where their centres were when the frames were right.
    """
    if np.array_equal(surfels.positions, rest):
        return surfels, 0
    now, before = surfels.positions.astype(np.float64), np.asarray(rest, np.float64)
    usable = np.isfinite(before).all(axis=1)
    size = max(np.abs(now).max(initial=0), np.abs(before[usable]).max(initial=0))
    waiting = np.flatnonzero(usable & (np.abs(now - np.where(usable[:, None], before, now)).max(axis=1) > 0))
    if not len(waiting) or np.abs(now - before)[waiting].max() <= _ROUNDING * size:
        return surfels, 0
    arrays = {name: np.array(values) for name, values in surfels.arrays().items()}
    random = np.random.default_rng(0)
    # One map for all moves those as well that happen to be where they were, as on the axis of a rotation.
    whole = _fitted(before[usable], now[usable])
    if (
        len(before) >= _FEWEST
        and whole is not None
        and (_distances(whole, before[usable], now[usable]) <= _ROUNDING * size).all()
    ):
        _move(arrays, surfels, np.flatnonzero(usable), whole)
        waiting = waiting[:0]
    for _ in range(MAX_MAPS):
        if not len(waiting):
            break
        found = _consensus(before[waiting], now[waiting], size, random)
        if found is None:
            break
        inliers, affine = found
        _move(arrays, surfels, waiting[inliers], affine)
        waiting = waiting[~inliers]
    return replace(surfels, **arrays), len(waiting)


def _consensus(before, now, size: float, random) -> tuple[np.ndarray, np.ndarray] | None:
    """(n,) which rows the best map explains, and the (4, 4) map; None where none explains enough of them."""
    count = len(before)
    jury = random.choice(count, min(count, _JURY), replace=False)
    maps = _minimal_maps(before, now, random)
    ones = np.concatenate([before[jury], np.ones((len(jury), 1))], axis=1)
    off = np.abs(ones @ maps - now[jury]).max(axis=2)  # (trials, jury)
    agreeing = (off <= _NEAR * size).sum(axis=1)
    best = maps[agreeing.argmax()]
    if agreeing.max() < max(_LEAST_SHARE * len(jury), min(len(jury), 2)):
        return None
    near = np.abs(np.concatenate([before, np.ones((count, 1))], axis=1) @ best - now).max(axis=1) <= _NEAR * size
    affine = _fitted(before[near], now[near])
    if affine is None:
        return None
    inliers = _distances(affine, before, now) <= _ROUNDING * size
    # Of rows that were only nearly together, those that are so exactly may be fewer.
    for _ in range(3):
        if not inliers.any():
            return None
        affine = _fitted(before[inliers], now[inliers])
        if affine is None:
            return None
        inliers = _distances(affine, before, now) <= _ROUNDING * size
    return (inliers, affine) if inliers.sum() >= max(_LEAST_SHARE * count, _FEWEST) else None


def _minimal_maps(before, now, random) -> np.ndarray:
    """(trials, 4, 3) affine maps, each through four rows; the least of those that are possible in a plane."""
    count = len(before)
    windows = np.minimum(np.resize(_WINDOWS, _TRIALS), count)
    starts = (random.random(_TRIALS) * (count - windows + 1)).astype(np.int64)
    rows = starts[:, None] + (random.random((_TRIALS, 4)) * windows[:, None]).astype(np.int64)
    # around a middle, so that the least map of a plane far from the origin is one that keeps it together
    middle = before[rows].mean(axis=1, keepdims=True)
    local = np.concatenate([before[rows] - middle, np.ones((_TRIALS, 4, 1))], axis=2)
    maps = np.linalg.pinv(local, rcond=1e-6) @ now[rows]
    maps[:, 3] -= np.einsum("ti,tij->tj", middle[:, 0], maps[:, :3])
    return maps


def _fitted(before, now) -> np.ndarray | None:
    """The (4, 4) map by least squares; across a plane it keeps the volume's share, and right-handedness. None for a
    map that flattens."""
    step = max(len(before) // _FITTED, 1)
    before, now = before[::step], now[::step]
    middle, target = before.mean(axis=0), now.mean(axis=0)
    u, values, axes = np.linalg.svd(before - middle, full_matrices=False)
    rank = int((values > _FLAT * values[0]).sum()) if len(values) and values[0] > 0 else 0
    linear = np.eye(3)
    if rank >= 2:
        images = (u[:, :rank].T @ (now - target)) / values[:rank, None]  # of the first axes
        if rank == 2:
            across = np.cross(*images)
            area = np.linalg.norm(across)
            if not area > 0:
                return None
            side = np.linalg.det(axes) or 1.0
            images = np.concatenate([images, [side * across / np.sqrt(area)]])
        linear = (axes.T @ images).T
    if not abs(np.linalg.det(linear)) > 1e-12:
        return None
    made = np.eye(4)
    made[:3, :3], made[:3, 3] = linear, target - linear @ middle
    return made


def _distances(affine: np.ndarray, before, now) -> np.ndarray:
    return np.abs(before @ affine[:3, :3].T + affine[:3, 3] - now).max(axis=1)


def _move(arrays: dict, surfels: Surfels, rows: np.ndarray, affine: np.ndarray) -> None:
    """These rows by the linear part of a map; their centres are where they are already."""
    linear = np.eye(4)
    linear[:3, :3] = affine[:3, :3]
    if np.abs(linear - np.eye(4)).max() <= 1e-6:
        return
    part = Surfels(**{name: values[rows] for name, values in surfels.arrays().items()})
    moved = transformed(part, linear).arrays()
    for name, values in arrays.items():
        if name != "positions":
            values[rows] = moved[name]
