# SPDX-License-Identifier: GPL-3.0-or-later
"""Restores frames of surfels whose centres were moved alone, as Blender's Apply, edit mode, Mirror, Array and Join do.

Surfels that moved together moved by one affine map. The map is estimated from the old and new centres and then applied
to the whole ellipses. Several maps are found one after another, each as the one that most of the remaining surfels
agree on (RANSAC: Fischler and Bolles 1981).
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ..surfels import Surfels
from .placement import transformed

#: Rounding error of float32 and a few products, as a fraction of the largest coordinate.
_ROUNDING = 4e-6

#: Tolerance of a map that was found from four rows alone, as a fraction of the largest coordinate.
_NEAR = 1e-3

#: Maximum number of maps; surfels that follow none of them keep their frames.
MAX_MAPS = 64

#: Sets of four rows tried per map, and rows on which each candidate is tested.
_TRIALS, _JURY = 256, 512

#: Each set is drawn from a window of this many consecutive rows: rows that moved together are usually stored together.
_WINDOWS = (8, 64, 1024, 1 << 40)

#: A map must explain at least this fraction of the remaining rows; otherwise the search stops.
_LEAST_SHARE = 0.01

#: Minimum number of rows that must agree, because any four rows fit some map.
_FEWEST = 6

#: Rows used for the final fit of a map.
_FITTED = 20_000

#: If the smallest of three singular values is below this fraction of the largest, the points lie in a plane or on a
#: line.
_FLAT = 1e-4


def followed(surfels: Surfels, rest: np.ndarray) -> tuple[Surfels, int]:
    """The surfels with frames, sizes and normals moved as their centres were, and the number of centres that were moved
    individually, whose frames are left alone.

    surfels: as they are stored. Their origin, which was not moved with the centres, is moved in their positions.
    rest: (N, 3) the centres at the time when the frames were right, relative to the same origin.
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
    # If one map explains everything, it also moves surfels whose centres stayed put, as on the axis of a rotation.
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
    """(n,) bool, which rows the best map explains, and the (4, 4) map; None if no map explains enough rows."""
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
    # Rows that agree exactly may be fewer than those that nearly agreed.
    for _ in range(3):
        if not inliers.any():
            return None
        affine = _fitted(before[inliers], now[inliers])
        if affine is None:
            return None
        inliers = _distances(affine, before, now) <= _ROUNDING * size
    return (inliers, affine) if inliers.sum() >= max(_LEAST_SHARE * count, _FEWEST) else None


def _minimal_maps(before, now, random) -> np.ndarray:
    """(trials, 4, 3) affine maps, each through four rows; the minimum-norm map if the rows lie in a plane."""
    count = len(before)
    windows = np.minimum(np.resize(_WINDOWS, _TRIALS), count)
    starts = (random.random(_TRIALS) * (count - windows + 1)).astype(np.int64)
    rows = starts[:, None] + (random.random((_TRIALS, 4)) * windows[:, None]).astype(np.int64)
    # relative to a middle, so that the minimum-norm map of a plane far from the origin keeps the plane together
    middle = before[rows].mean(axis=1, keepdims=True)
    local = np.concatenate([before[rows] - middle, np.ones((_TRIALS, 4, 1))], axis=2)
    maps = np.linalg.pinv(local, rcond=1e-6) @ now[rows]
    maps[:, 3] -= np.einsum("ti,tij->tj", middle[:, 0], maps[:, :3])
    return maps


def _fitted(before, now) -> np.ndarray | None:
    """The (4, 4) least-squares map. For points in a plane it preserves volume ratio and handedness across the plane.
    None for a map that flattens."""
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
    """Apply the linear part of a map to these rows; their centres are already in place."""
    linear = np.eye(4)
    linear[:3, :3] = affine[:3, :3]
    if np.abs(linear - np.eye(4)).max() <= 1e-6:
        return
    part = Surfels(**{name: values[rows] for name, values in surfels.arrays().items()})
    moved = transformed(part, linear).arrays()
    for name, values in arrays.items():
        if name != "positions":
            values[rows] = moved[name]
    arrays["positions"][rows] += (linear[:3, :3] @ surfels.origin - surfels.origin).astype(np.float32)
