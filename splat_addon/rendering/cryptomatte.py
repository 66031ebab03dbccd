# SPDX-License-Identifier: GPL-3.0-or-later
"""Cryptomattes, the coverage of each pixel by object: Friedman and Jones, "Fully Automatic ID Mattes with Support for
Motion Blur and Transparency", 2015, and the Cryptomatte specification 1.2.0 (hashing of names, and metadata in
files)."""

from __future__ import annotations

import json
from dataclasses import dataclass

import numpy as np

_MASK = 0xFFFFFFFF


def murmur3_32(data: bytes) -> int:
    """MurmurHash3_x86_32 with seed 0 (Appleby, 2011)."""
    value, length = 0, len(data)
    for start in range(0, length, 4):
        word = int.from_bytes(data[start : start + 4], "little")
        word = _rotated(word * 0xCC9E2D51 & _MASK, 15) * 0x1B873593 & _MASK
        value ^= word
        if start + 4 <= length:
            value = (_rotated(value, 13) * 5 + 0xE6546B64) & _MASK
    value ^= length
    value = (value ^ value >> 16) * 0x85EBCA6B & _MASK
    value = (value ^ value >> 13) * 0xC2B2AE35 & _MASK
    return value ^ value >> 16


def _rotated(value: int, bits: int) -> int:
    return (value << bits | value >> (32 - bits)) & _MASK


def name_hash(name: str) -> int:
    """The bits of the float32 that represents a name; never zero, denormal, infinite or NaN."""
    bits = murmur3_32(name.encode("utf-8"))
    return bits ^ 1 << 23 if bits >> 23 & 0xFF in (0, 0xFF) else bits


@dataclass(frozen=True, eq=False)
class Cryptomatte:
    """The coverage of each pixel by name; uncovered parts are omitted.

    size: width, height. keys: (n,) uint64, sorted: pixel (row by row from the bottom left) times 2^32 plus hash of the
        name. shares: (n,) float64. names: all names that may occur -> their hashes.
    """

    size: tuple[int, int]
    keys: np.ndarray
    shares: np.ndarray
    names: dict[str, int]

    def plus(self, other: Cryptomatte) -> Cryptomatte:
        """The sum of two mattes of the same size."""
        keys, shares = added_up(np.concatenate([self.keys, other.keys]), np.concatenate([self.shares, other.shares]))
        return Cryptomatte(self.size, keys, shares, self.names | other.names)

    def looked_up(self, size: tuple[int, int], pixels: np.ndarray, sources: np.ndarray) -> Cryptomatte:
        """A matte of another size, whose `pixels` (n,), by number, get the contents of `sources` (n,) of this one."""
        own = (self.keys >> np.uint64(32)).astype(np.int64)
        first = np.searchsorted(own, sources, "left")
        counts = np.searchsorted(own, sources, "right") - first
        entry = np.repeat(first - np.cumsum(counts) + counts, counts) + np.arange(counts.sum())
        keys = np.repeat(pixels, counts).astype(np.uint64) << np.uint64(32) | self.keys[entry] & np.uint64(_MASK)
        order = np.argsort(keys, kind="stable")
        return Cryptomatte(size, keys[order], self.shares[entry][order], self.names)

    def over(self, count: int) -> Cryptomatte:
        """All shares divided by a number."""
        return Cryptomatte(self.size, self.keys, self.shares / count, self.names)

    def ranks(self, count: int) -> np.ndarray:
        """(h, w, count, 2) float32: hash (as the bits of a float) and share of the `count` largest in each pixel, the
        largest first; unused entries are 0, 0."""
        width, height = self.size
        pixels = (self.keys >> np.uint64(32)).astype(np.int64)
        order = np.lexsort((-self.shares, pixels))
        pixels = pixels[order]
        starts = np.flatnonzero(np.diff(pixels, prepend=-1))
        rank = np.arange(len(pixels)) - np.repeat(starts, np.diff(starts, append=len(pixels)))
        kept = rank < count
        ranks = np.zeros((height * width, count, 2), np.float32)
        hashes = (self.keys[order] & np.uint64(_MASK)).astype(np.uint32).view(np.float32)
        ranks[pixels[kept], rank[kept], 0], ranks[pixels[kept], rank[kept], 1] = hashes[kept], self.shares[order][kept]
        return ranks.reshape(height, width, count, 2)

    def share_of(self, name: str) -> np.ndarray:
        """(h, w) float64: the matte of one name."""
        matte = np.zeros(self.size[0] * self.size[1])
        is_its = (self.keys & np.uint64(_MASK)) == np.uint64(name_hash(name))
        matte[(self.keys[is_its] >> np.uint64(32)).astype(np.int64)] = self.shares[is_its]
        return matte.reshape(self.size[::-1])

    def metadata(self, layer: str) -> dict[str, str]:
        """File metadata for the matte. layer: name of the channels before the numbers."""
        prefix = f"cryptomatte/{murmur3_32(layer.encode('utf-8')):08x}"[:19]
        manifest = {name: f"{bits:08x}" for name, bits in self.names.items()}
        return {
            f"{prefix}/name": layer,
            f"{prefix}/hash": "MurmurHash3_32",
            f"{prefix}/conversion": "uint32_to_float32",
            f"{prefix}/manifest": json.dumps(manifest, separators=(",", ":"), ensure_ascii=False),
        }


def added_up(keys: np.ndarray, shares: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Sorted unique keys, and the sums of their shares."""
    order = np.argsort(keys, kind="stable")
    keys = keys[order]
    starts = np.flatnonzero(np.concatenate([[True], keys[1:] != keys[:-1]])) if len(keys) else np.zeros(0, np.int64)
    return keys[starts], np.add.reduceat(shares[order], starts) if len(keys) else shares
