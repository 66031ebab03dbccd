# SPDX-License-Identifier: GPL-3.0-or-later
"""Finds vertices at the same position by hashing: importers repeat vertices at seams."""

from __future__ import annotations

import numpy as np

#: Vertices per batch, few enough for temporaries to stay in the processor's cache.
_CHUNK = 16384


def vertex_hashes(positions: np.ndarray) -> np.ndarray:
    """(V,) uint64 hashes, equal for equal positions; adding 0.0 turns -0.0 into 0.0."""
    keys = np.empty(len(positions), np.uint64)
    for start in range(0, len(keys), _CHUNK):
        rows = positions[start : start + _CHUNK]
        part = np.zeros(len(rows), np.uint64)
        for column in rows.T:
            part ^= np.add(column, 0.0, order="C").view(np.uint64)
            part *= np.uint64(0x9E3779B97F4A7C15)
            part ^= part >> np.uint64(32)
        part *= np.uint64(0xBF58476D1CE4E5B9)
        part ^= part >> np.uint64(29)
        keys[start : start + _CHUNK] = part
    return keys
