# SPDX-License-Identifier: GPL-3.0-or-later
"""The numpy twin of shaders/common/texture_lookup.glsl: a texture's colour under a footprint, in float64."""

from __future__ import annotations

import numpy as np

from .atlas import Atlas

MAX_PROBES = 16
PROBES_PER_DEVIATION = 3.8
LONGEST = 16.0
LARGEST = 1e12

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
    width2 = 1 + 4 * across
    level = min(int(0.5 * np.log2(width2)), count - 1)
    share = np.clip((width2 * 4.0**-level - 1) / 3, 0, 1)
    spread = np.sqrt(max(along - across, 0))
    probes = min(1 + int(PROBES_PER_DEVIATION * spread / np.sqrt(width2) + 0.3), MAX_PROBES)
    reach = axis * spread / np.sqrt(PROBE_VARIANCES.get(probes, MANY_PROBES_VARIANCE)) if probes > 1 else 0.0
    total, weights = np.zeros(4), 0.0
    for place in (2 * np.arange(probes) + 1) / probes - 1:
        at, weight = uv + reach * place / size, np.exp(-2 * place**2)
        colors = [_level_color(atlas, slot, min(k, count - 1), at, k == 0) for k in (level, level + 1)]
        total += weight * ((1 - share) * colors[0] + share * colors[1])
        weights += weight
    return factor * total[:3] / (total[3] if total[3] > 0 else weights)


def _along_and_across(variance: np.ndarray) -> tuple[float, float, np.ndarray]:
    """Along the footprint's long axis and across it, texels squared, and the unit axis; bounded as MAX_PROBES need."""
    if not np.trace(variance) < LARGEST:
        return LARGEST, LARGEST, np.array([1.0, 0.0])
    (across, along), axes = np.linalg.eigh(variance)
    return along, max(across, 0.0, (along - LONGEST) / (1 + 4 * LONGEST)), axes[:, 1]


def _level_color(atlas: Atlas, slot: int, level: int, uv: np.ndarray, may_be_closest: bool) -> np.ndarray:
    row = atlas.table[slot]
    x, y, width, height = row[2 + level].astype(int)
    extension, is_closest = EXTENSION_RULES[int(row[1, 0])], may_be_closest and row[1, 1] > 0.5
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
