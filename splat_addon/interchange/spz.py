# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads SPZ (Niantic) 1 to 3: Gaussians in few bits, packed by gzip.

The format fixes its axes, x right, y up, z back; here they are turned so that z is up, as in Blender.

| array | bytes of each | meaning |
|---|---|---|
| positions | 9, in version 1 6 | x y z as integers with a number of fractional bits, or as 16-bit floats |
| opacities | 1 | 0 to 1 |
| colours | 3 | the spherical harmonic of degree 0, in steps of 1 / (255 * 0.15) around 0 |
| scales | 3 | logarithms of sigma, in sixteenths from -10 |
| rotations | 3, in version 3 4 | x y z, from -1 to 1; or which of x y z w is the largest, and the others |
| harmonics | 9, 24 or 45 | what changes with the view |
"""

from __future__ import annotations

import os
import struct
import zlib

import numpy as np

from .gaussians import DEFAULT_FLATNESS, Gaussians, flat_gaussians, harmonic_colors

_GZIP, _MAGIC = b"\x1f\x8b", 0x5053474E
_HEADER = struct.Struct("<IIIBBBB")
_VERSIONS = (1, 2, 3)
#: degree -> bytes of further harmonics
_HARMONICS = {0: 0, 1: 9, 2: 24, 3: 45}
_COLOR_SCALE = 0.15
#: gzip packs at most so many bytes into one.
_MOST_RATIO = 1032
#: Bytes that may follow the Gaussians, such as extensions.
_MORE = 1 << 20
#: Quaternion, w first, of a quarter of a turn about x, which takes y up to z up.
_UP = np.float32([0.5**0.5, 0.5**0.5, 0, 0])


def is_this(head: bytes) -> bool:
    return head.startswith(_GZIP) and _unpacked(head, 4) == _MAGIC.to_bytes(4, "little")


def read_spz(path: str | os.PathLike, flatness: float = DEFAULT_FLATNESS) -> Gaussians:
    """The Gaussians of the file: see `flat_gaussians`. Raises ValueError with a sentence, OSError."""
    with open(path, "rb") as stream:
        return spz_gaussians(stream.read(), flatness)


def spz_gaussians(packed: bytes, flatness: float = DEFAULT_FLATNESS) -> Gaussians:
    """The Gaussians in the bytes of a file. Raises ValueError with a sentence."""
    size = len(packed)
    head = _unpacked(packed, _HEADER.size)
    if len(head) < _HEADER.size:
        raise ValueError("The SPZ file ends in its header; it is cut off.")
    _, version, count, degree, fraction, _, _ = _HEADER.unpack(head)
    if version not in _VERSIONS or degree not in _HARMONICS:
        raise ValueError(f"The SPZ file has version {version} and degree {degree}; versions 1 to 3 can be read.")
    widths = (6 if version == 1 else 9, 1, 3, 3, 4 if version == 3 else 3)
    whole = _HEADER.size + count * (sum(widths) + _HARMONICS[degree])
    data = _checked(packed, whole) if whole <= _MOST_RATIO * size else b""
    if len(data) < whole:
        raise ValueError(
            f"The SPZ file says that it has {count:,} Gaussians, but its {size:,} bytes are no whole gzip of these; it "
            "is cut off or damaged; copy it again."
        )
    columns, start = [], _HEADER.size
    for width in widths:
        columns.append(np.frombuffer(data, np.uint8, count * width, start).reshape(count, width))
        start += count * width
    places, opacities, colors, scales, turns = columns
    positions, rotations = z_up(_positions(places, version, fraction), _quaternions(turns, version))
    said = (f"Took {count:,} Gaussians from a compressed file, which rounds places, sizes and colours",)
    return flat_gaussians(
        positions,
        np.exp(scales / 16.0 - 10.0),
        rotations,
        harmonic_colors((colors / 255.0 - 0.5) / _COLOR_SCALE),
        opacities[:, 0] / 255.0,
        view_dependent=_HARMONICS[degree],
        said=said,
        flatness=flatness,
    )


def _unpacked(packed: bytes, size: int) -> bytes:
    """The first bytes of what gzip packed, fewer if it is damaged."""
    try:
        return zlib.decompressobj(wbits=31).decompress(packed, size)
    except zlib.error:
        return b""


def _checked(packed: bytes, size: int) -> bytes:
    """The first bytes of what gzip packed, none if its checksum is wrong, or far more follow."""
    unpacker = zlib.decompressobj(wbits=31)
    try:
        data = unpacker.decompress(packed, size)
        unpacker.decompress(unpacker.unconsumed_tail, _MORE)
    except zlib.error:
        return b""
    return data if unpacker.eof else b""


def _positions(packed: np.ndarray, version: int, fraction: int) -> np.ndarray:
    """(N, 3) float64."""
    if version == 1:
        return packed.copy().view("<f2").astype(np.float64)
    parts = packed.reshape(-1, 3, 3).astype(np.int32)
    whole = parts[..., 0] | parts[..., 1] << 8 | parts[..., 2] << 16
    return (whole - ((whole & 0x800000) << 1)) / 2.0**fraction


def _quaternions(packed: np.ndarray, version: int) -> np.ndarray:
    """(N, 4) w x y z."""
    if version < 3:
        xyz = packed / 127.5 - 1.0
        return np.column_stack([np.sqrt(np.maximum(0, 1 - (xyz**2).sum(axis=1))), xyz])
    words, made = packed.copy().view("<u4")[:, 0], np.zeros((len(packed), 4))
    largest, rows = (words >> np.uint32(30)).astype(np.intp), np.arange(len(packed))
    # the last component is in the lowest bits: nine of size and one of sign
    shift = np.zeros(len(packed), np.uint32)
    for place in (3, 2, 1, 0):
        piece = words >> shift
        size = (piece & np.uint32(511)) / 511 * 0.5**0.5
        value = np.where(piece >> np.uint32(9) & np.uint32(1), -size, size)
        made[:, place] = np.where(largest == place, 0, value)
        shift += np.where(largest == place, 0, 10).astype(np.uint32)
    made[rows, largest] = np.sqrt(np.maximum(0, 1 - (made**2).sum(axis=1)))
    return made[:, [3, 0, 1, 2]]


def z_up(positions: np.ndarray, quaternions: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(N, 3) places and (N, 4) float32 quaternions w x y z, turned so that z is up where y was."""
    x, y, z = positions.T
    places = np.stack([x, -z, y], axis=1)
    (aw, ax), (w, x, y, z) = _UP[:2], quaternions.T
    made = [aw * w - ax * x, aw * x + ax * w, aw * y - ax * z, aw * z + ax * y]
    return places, np.stack(made, axis=1).astype(np.float32)
