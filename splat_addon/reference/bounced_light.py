# SPDX-License-Identifier: GPL-3.0-or-later
"""Bounced light looked up at a point, in float64; the twin of shaders/features/bounced_light.glsl."""

from __future__ import annotations

import numpy as np

from ..rendering.bounced.light import BouncedLight
from ..rendering.bounced.sides import SIDES

#: What a side counts for at least.
LEAST = 1e-4


def bounced_at(light: BouncedLight, places: np.ndarray, normals: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(n, 3) irradiance over pi and (n,) share of the world at places (n, 3) with unit normals (n, 3), world; of any
    side where none that is faced is near, and NaN where nothing is."""
    known = {
        (*cell, side): row
        for row, (cell, side) in enumerate(zip(light.cells.tolist(), light.sides.tolist(), strict=True))
    }
    values = np.concatenate([light.irradiance, light.open[:, None]], axis=1)
    at = (places - light.low) / light.cell - 0.5
    linked = None
    if light.linked is not None:
        pairs = np.stack(light.linked, axis=1)
        linked = set(map(tuple, np.concatenate([pairs, pairs[:, ::-1]]).tolist()))
    total, weights = np.zeros((len(places), 4)), np.zeros(len(places))
    for row, (point, normal) in enumerate(zip(at, normals, strict=True)):
        facing = [(2 * axis + int(normal[axis] < 0), max(normal[axis] ** 2, LEAST)) for axis in range(3)]
        for counted in (facing, [(side, 1.0) for side in range(SIDES)]):
            if not weights[row]:
                total[row], weights[row] = _around(known, linked, values, point, counted)
    with np.errstate(invalid="ignore"):
        mean = total / weights[:, None]
    return mean[:, :3], mean[:, 3]


def _around(
    known: dict, linked: set | None, values: np.ndarray, point: np.ndarray, counted: list
) -> tuple[np.ndarray, float]:
    """The sum of values around a point, in cells, and of their weights. linked: pairs of rows that share their light.
    counted: pairs of a side and its weight."""
    middle = np.floor(point + 0.5).astype(int).tolist()
    low = np.floor(point).astype(int)
    total, weights = np.zeros(4), 0.0
    for corner in np.ndindex(2, 2, 2):
        near = np.prod(np.where(corner, point - low, 1 - (point - low)))
        for side, facing in counted:
            found = known.get((*(low + corner).tolist(), side))
            own = known.get((*middle, side))
            is_linked = linked is None or own is None or own == found or (own, found) in linked
            if found is not None and is_linked:
                total += near * facing * values[found]
                weights += near * facing
    return total, weights
