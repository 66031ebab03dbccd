# SPDX-License-Identifier: GPL-3.0-or-later
"""Random numbers of the cells of procedural textures.

Bob Jenkins' lookup3 (public domain), and of the cells of Voronoi textures the PCG hashes of Jarzynski and Olano, "Hash
Functions for GPU Rendering", 2020, as Blender uses them.
"""

from __future__ import annotations

import numpy as np

_START = 0xDEADBEEF + 13
#: Turns of the two loops of lookup3: "mix" and "final".
_MIX, _FINAL = (4, 6, 8, 16, 19, 4), (14, 11, 25, 16, 4, 14, 24)


def _turned(x: np.ndarray, bits: int) -> np.ndarray:
    result = x << np.uint32(bits)
    result |= x >> np.uint32(32 - bits)
    return result


def hashed(*words: np.ndarray) -> np.ndarray:
    """(n,) uint32 of one to four arrays of uint32."""
    with np.errstate(over="ignore"):
        start = np.uint32((_START + (len(words) << 2)) & 0xFFFFFFFF)
        a, b, c = (start + words[k] if k < min(len(words), 3) else start for k in range(3))
        a, b, c, *fourth = (np.array(x) for x in np.broadcast_arrays(a, b, c, *words[3:]))
        if fourth:
            for bits in _MIX:
                a -= c
                a ^= _turned(c, bits)
                c += b
                a, b, c = b, c, a
            a += fourth[0]
        for bits in _FINAL:
            c ^= b
            c -= _turned(b, bits)
            a, b, c = b, c, a
    return b


def random(*numbers: np.ndarray) -> np.ndarray:
    """(n,) float32, 0 to 1, of one to four arrays of float32, by their bits."""
    words = [np.ascontiguousarray(number, np.float32).view(np.uint32) for number in numbers]
    return hashed(*words).astype(np.float32) * np.float32(1 / 0xFFFFFFFF)


_MULTIPLIER, _INCREMENT = np.int32(1664525), np.int32(1013904223)

#: dimensions -> the two numbers, and in two dimensions a factor, whose product is added to each in turn
_PRODUCTS = {2: ((1, None), (0, None)), 3: ((1, 2), (2, 0), (0, 1)), 4: ((1, 3), (2, 0), (0, 1), (1, 2))}


def of_cell(cell: list[np.ndarray]) -> list[np.ndarray]:
    """Two to four random numbers, 0 to 1, of as many whole numbers."""
    with np.errstate(over="ignore"):
        words = [np.array(w, np.int32) for w in np.broadcast_arrays(*cell)]
        words = [word * _MULTIPLIER + _INCREMENT for word in words]
        for is_second in (False, True):
            if is_second:
                words = [word ^ (word >> np.int32(16)) for word in words]
            for k, (a, b) in enumerate(_PRODUCTS[len(words)]):
                words[k] = words[k] + words[a] * (_MULTIPLIER if b is None else words[b])
    return [(w & np.int32(0x7FFFFFFF)).astype(np.float32) * np.float32(1 / 0x7FFFFFFF) for w in words]
