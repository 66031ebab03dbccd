# SPDX-License-Identifier: GPL-3.0-or-later
"""Bounced light looked up at a point, in float64; the twin of shaders/features/bounced_light.glsl."""

from __future__ import annotations

import numpy as np

from ..rendering.bounced.light import BouncedLight

#: What a side counts for at least.
LEAST = 1e-4


def bounced_at(light: BouncedLight, places: np.ndarray, normals: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(n, 3) irradiance over pi and (n,) share of the world at places (n, 3) with unit normals (n, 3), world; NaN where
    no surface is near."""
    known = {
        (*cell, side): row
        for row, (cell, side) in enumerate(zip(light.cells.tolist(), light.sides.tolist(), strict=True))
    }
    values = np.concatenate([light.irradiance, light.open[:, None]], axis=1)
    at = (places - light.low) / light.cell - 0.5
    total, weights = np.zeros((len(places), 4)), np.zeros(len(places))
    for row, (point, normal) in enumerate(zip(at, normals, strict=True)):
        low = np.floor(point).astype(int)
        share = point - low
        for corner in np.ndindex(2, 2, 2):
            near = np.prod(np.where(corner, share, 1 - share))
            for axis in range(3):
                found = known.get((*(low + corner).tolist(), 2 * axis + int(normal[axis] < 0)))
                if found is not None:
                    weight = near * max(normal[axis] ** 2, LEAST)
                    total[row] += weight * values[found]
                    weights[row] += weight
    with np.errstate(invalid="ignore"):
        mean = total / weights[:, None]
    return mean[:, :3], mean[:, 3]
