# SPDX-License-Identifier: GPL-3.0-or-later
"""The numpy twin of shaders/lib/texture_lookup.glsl: a texture's colour under a footprint, in float64."""

from __future__ import annotations

import numpy as np

from ..rendering.upload.atlas import CUT_OUT, Atlas

MAGNIFIED = 0.2
NARROWEST = 0.6
LONGEST = 64.0
LARGEST = 16.0
REACH2 = 8.0
MAX_PROBES = 24
PROBES_PER_DEVIATION = 3.0
AXIS_BIAS = 1e-3

#: Gaussian weights at the middles of n parts of -1 .. 1
PROBE_VARIANCES = {2: 0.25, 3: 0.2005}
MANY_PROBES_VARIANCE = 0.1945


def texture_colors(atlas: Atlas, slot: int, uvs: np.ndarray, variances: np.ndarray) -> np.ndarray:
    """(n, 3) colours, not premultiplied, of a slot that has a texture.

    uvs: (n, 2) middles of the Gaussian footprints. variances: (n, 2, 2) their covariance matrices.
    """
    factor = atlas.table[slot, 0, :3].astype(np.float64)
    sums = [_sum(atlas, slot, uv, variance) for uv, variance in zip(uvs, variances, strict=True)]
    return np.array([factor * total[:3] / (total[3] if total[3] > 0 else weights) for total, weights in sums])


def _sum(atlas: Atlas, slot: int, uv: np.ndarray, variance: np.ndarray) -> tuple[np.ndarray, float]:
    row = atlas.table[slot].astype(np.float64)
    count, size = int(row[0, 3]), row[1, 2:]
    variance = variance * np.outer(size, size)
    largest = LARGEST * 4.0 ** (count - 1)
    if not np.linalg.eigvalsh(np.nan_to_num(variance, nan=1e300, posinf=1e300)).max() < largest:
        variance = largest * np.eye(2)
    across, along = np.maximum(np.linalg.eigvalsh(variance), 0)
    axis = np.linalg.eigh(variance + np.diag([2 * AXIS_BIAS * np.trace(variance), 0]))[1][:, 1]
    blur = max(along / LONGEST - across, 0)
    if across + blur < MAGNIFIED:
        return _probe_sum(atlas, slot, uv, np.sqrt([along, across]), axis)
    level = int(0.5 * np.log2(max((across + blur + 0.25) / (NARROWEST + 1 / 12), 1)))
    level = min(level, count - 1)
    sideways = np.array([-axis[1], axis[0]])
    own = 0.25 - 4.0**level / 12
    weighed = (variance + blur * np.outer(sideways, sideways) + own * np.eye(2)) / 4.0**level
    return _ellipse_sum(atlas, slot, level, uv, weighed)


def _probe_sum(atlas: Atlas, slot: int, uv: np.ndarray, spreads: np.ndarray, axis: np.ndarray):
    size, places = atlas.table[slot, 1, 2:].astype(np.float64), []
    for spread, direction in zip(spreads, (axis, np.array([-axis[1], axis[0]])), strict=True):
        probes = min(int(1.5 + PROBES_PER_DEVIATION * spread), MAX_PROBES)
        reach = spread / np.sqrt(PROBE_VARIANCES.get(probes, MANY_PROBES_VARIANCE)) if probes > 1 else 0.0
        steps = (2 * np.arange(probes) + 1) / probes - 1
        places.append([(np.exp(-2 * step**2), direction * reach * step / size) for step in steps])
    total, weights = np.zeros(4), 0.0
    for weight_along, along in places[0]:
        for weight_across, across in places[1]:
            total += weight_along * weight_across * _point_color(atlas, slot, uv + along + across)
            weights += weight_along * weight_across
    return total, weights


def _ellipse_sum(atlas: Atlas, slot: int, level: int, uv: np.ndarray, variance: np.ndarray):
    middle = uv * atlas.table[slot, 2 + level, 2:] - 0.5
    reach = np.sqrt(REACH2 * np.diag(variance))
    first, last = np.ceil(middle - reach).astype(int), np.floor(middle + reach).astype(int)
    inverse = np.linalg.inv(variance) / REACH2
    total, weights = np.zeros(4), 0.0
    for y in range(first[1], last[1] + 1):
        for x in range(first[0], last[0] + 1):
            offset = (x, y) - middle
            weight = max(1 - offset @ inverse @ offset, 0) ** 2
            total += weight * _texel(atlas, slot, level, x, y)
            weights += weight
    return total, weights


def _point_color(atlas: Atlas, slot: int, uv: np.ndarray) -> np.ndarray:
    """Point sample of the image itself."""
    position = uv * atlas.table[slot, 2, 2:]
    if atlas.table[slot, 1, 1] > 0.5:
        return _texel(atlas, slot, 0, *np.floor(position).astype(int))
    low = np.floor(position - 0.5)
    (right, top), (x, y) = position - 0.5 - low, low.astype(int)
    bottom = (1 - right) * _texel(atlas, slot, 0, x, y) + right * _texel(atlas, slot, 0, x + 1, y)
    above = (1 - right) * _texel(atlas, slot, 0, x, y + 1) + right * _texel(atlas, slot, 0, x + 1, y + 1)
    return (1 - top) * bottom + top * above


def _texel(atlas: Atlas, slot: int, level: int, x: int, y: int) -> np.ndarray:
    left, bottom, width, height = atlas.table[slot, 2 + level].astype(int)
    extension = EXTENSION_RULES[int(atlas.table[slot, 1, 0]) % CUT_OUT]
    column, row = extension(x, width), extension(y, height)
    return (
        np.zeros(4) if column is None or row is None else atlas.texels[bottom + row, left + column].astype(np.float64)
    )


#: for each extension number: the index of a texel inside the image, None for transparent black
EXTENSION_RULES = (
    lambda i, n: i % n,
    lambda i, n: min(max(i, 0), n - 1),
    lambda i, n: i if 0 <= i < n else None,
    lambda i, n: min(i % (2 * n), 2 * n - 1 - i % (2 * n)),
)
