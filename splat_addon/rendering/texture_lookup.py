# SPDX-License-Identifier: GPL-3.0-or-later
"""The numpy twin of shaders/common/texture_lookup.glsl: a texture's colour under a footprint, in float64."""

from __future__ import annotations

import numpy as np

from .atlas import Atlas

MAX_PROBES = 24
PROBES_PER_DEVIATION = 3.0
LEVEL_SHARE = 0.25
LONGEST = 32.0
LARGEST = 1e12
AXIS_BIAS = 1e-3

#: of Gaussian weights at the middles of n parts of -1 .. 1
PROBE_VARIANCES = {2: 0.25, 3: 0.2005}
MANY_PROBES_VARIANCE = 0.1945


def texture_colors(atlas: Atlas, slot: int, uvs: np.ndarray, variances: np.ndarray) -> np.ndarray:
    """(n, 3) colours, not premultiplied, of a slot that has a texture.

    uvs: (n, 2) middles of the Gaussian footprints. variances: (n, 2, 2) their covariance matrices.
    """
    return np.array([_color(atlas, slot, uv, v) for uv, v in zip(uvs, variances, strict=True)])


def _color(atlas: Atlas, slot: int, uv: np.ndarray, variance: np.ndarray) -> np.ndarray:
    row = atlas.table[slot].astype(np.float64)
    factor, count, size = row[0, :3], int(row[0, 3]), row[1, 2:]
    along, across, axis = _along_and_across(variance * np.outer(size, size))
    level = min(int(0.5 * np.log2(1 + 4 * LEVEL_SHARE * across)), count - 1)
    spreads = np.sqrt(np.maximum(np.array([along, across]) - (4.0**level - 1) / 4, 0))
    places = []
    for spread, direction in zip(spreads, (axis, np.array([-axis[1], axis[0]])), strict=True):
        probes = min(int(1.5 + PROBES_PER_DEVIATION * spread / 2.0**level), MAX_PROBES)
        reach = spread / np.sqrt(PROBE_VARIANCES.get(probes, MANY_PROBES_VARIANCE)) if probes > 1 else 0.0
        steps = (2 * np.arange(probes) + 1) / probes - 1
        places.append([(np.exp(-2 * step**2), direction * reach * step / size) for step in steps])
    total, weights = np.zeros(4), 0.0
    for weight_along, along_ in places[0]:
        for weight_across, across_ in places[1]:
            total += weight_along * weight_across * _level_color(atlas, slot, level, uv + along_ + across_)
            weights += weight_along * weight_across
    return factor * total[:3] / (total[3] if total[3] > 0 else weights)


def _along_and_across(variance: np.ndarray) -> tuple[float, float, np.ndarray]:
    """Along the footprint's long axis and across it, texels squared, and the unit axis; bounded as MAX_PROBES need."""
    if not np.trace(variance) < LARGEST:
        return LARGEST, LARGEST, np.array([1.0, 0.0])
    across, along = np.linalg.eigvalsh(variance)
    _, axes = np.linalg.eigh(variance + np.diag([2 * AXIS_BIAS * np.trace(variance), 0]))
    return along, max(across, 0.0, (along - LONGEST) / (2 * LONGEST)), axes[:, 1]


def _level_color(atlas: Atlas, slot: int, level: int, uv: np.ndarray) -> np.ndarray:
    row = atlas.table[slot]
    x, y, width, height = row[2 + level].astype(int)
    extension, is_closest = EXTENSION_RULES[int(row[1, 0])], row[1, 1] > 0.5 and level == 0
    color = np.zeros(4)
    for j, weight_y in _taps(uv[1] * height, is_closest):
        for i, weight_x in _taps(uv[0] * width, is_closest):
            column, row_ = extension(i, width), extension(j, height)
            if column is not None and row_ is not None:
                color += weight_x * weight_y * atlas.texels[y + row_, x + column].astype(np.float64)
    return color


def _taps(position: float, is_closest: bool):
    if is_closest:
        return ((int(np.floor(position)), 1.0),)
    low = np.floor(position - 0.5)
    share = position - 0.5 - low
    return ((int(low), 1 - share), (int(low) + 1, share))


#: by number of the extension: a texel's index inside the image, None for transparent black
EXTENSION_RULES = (
    lambda i, n: i % n,
    lambda i, n: min(max(i, 0), n - 1),
    lambda i, n: i if 0 <= i < n else None,
    lambda i, n: min(i % (2 * n), 2 * n - 1 - i % (2 * n)),
)
