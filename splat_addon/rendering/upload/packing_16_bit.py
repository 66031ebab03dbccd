# SPDX-License-Identifier: GPL-3.0-or-later
"""Packs surfels as 16-bit numbers: 32 bytes each instead of 64, and a table of 48 bytes for every 512.

A splat is four texels of four 16-bit numbers (unsigned, normalised: the one 16-bit format that every graphics API fills
alike; drivers differ in how they round to float16):
    position.xyz, normal.x  |  rotation.xyz, normal.y  |  log length u, v, material, blend  |  color.rgb, opacity
The 512 splats of a row are neighbours, and numbers are relative to that block. Its row in the table is
    low corner, longest half-axis  |  size of the box, log2 of longest over shortest half-axis  |  brightest colour, 0

Maximum error of each value: position: 2^-17 of the block's box, along each axis. half-axes: 2^-17 log2(longest /
shortest of the block) octaves, below 2^-10 of themselves while that ratio is below 2^180; equal lengths are exact. The
axes turn by 2e-4 radians at most. normal: 5e-5 radians. colour: cube root of the share of the block's brightest in
steps of 2^-15, so 5e-5 of the brightest and 1e-3 of a colour a thousandth as bright. 0 is exact. opacity: 2^-17 within
0 to 1. material: none up to 65,535, beyond which it is refused. blend depth: what `not_blended` rounds, below
`BLEND_STEPS`, which is added for a surfel whose back is hidden.
"""

from __future__ import annotations

import numpy as np

from ...large_surfels import BLEND_STEPS
from ...surfels import HIDDEN, Surfels
from .packing import SPLATS_PER_ROW, TEXELS_PER_SPLAT, not_blended, octahedral, row_count

#: An error of this share of a splat's shorter half-axis is visible.
COARSE = 1 / 8

_STEPS = 65535
#: Steps from 0 to 1 of a signed number; one of the 65,536 values is unused so that 0 is exact.
_SIGNED_STEPS = 32767


def pack_16_bit(surfels: Surfels, order: np.ndarray) -> tuple[tuple[np.ndarray, np.ndarray], int]:
    """(rows, 2048, 4) float32 texels in 0 to 1, multiples of 1 / 65535, the (rows, 3, 4) float32 table, and how many
    surfels are coarse: their position may be off by more than `COARSE` of their shorter half-axis, because their block
    is that much larger than they are (a stray surfel far away widens the block that it falls into).

    order: (n,) numbers of the surfels in which they are stored, neighbours together.
    Raises ValueError for a material index above 65,535.
    """
    rows, count = row_count(len(order)), len(order)
    if len(surfels) and surfels.materials.max() > _STEPS:
        raise ValueError(
            f"16-bit storage numbers materials up to {_STEPS:,}, not {surfels.materials.max():,}; use float32 storage."
        )
    texels = np.zeros((rows, SPLATS_PER_ROW, TEXELS_PER_SPLAT, 4), np.float32)
    table = np.zeros((rows, 3, 4), np.float32)
    if not len(surfels):
        return (texels.reshape(rows, -1, 4), table), 0
    # the last row is filled up with its last splat, which widens no block
    order = np.pad(order, (0, rows * SPLATS_PER_ROW - count), "edge")

    def blocks(array):
        return array[order].reshape(rows, SPLATS_PER_ROW, *array.shape[1:])

    positions = blocks(surfels.positions).astype(np.float64)
    low = positions.min(axis=1)
    size = positions.max(axis=1) - low
    texels[:, :, 0, :3] = _steps((positions - low[:, None]) / _divisor(size)[:, None])
    table[:, 0, :3], table[:, 1, :3] = low, size

    octaves_down = np.log2(blocks(surfels.scales))
    octaves_down = octaves_down.max(axis=(1, 2), keepdims=True) - octaves_down
    octaves = octaves_down.max(axis=(1, 2))
    texels[:, :, 2, :2] = _steps(octaves_down / _divisor(octaves)[:, None, None])
    table[:, 0, 3], table[:, 1, 3] = blocks(surfels.scales).max(axis=(1, 2)), octaves

    texels[:, :, 1, :3] = _signed_steps(rotation_parameters(blocks(surfels.rotations)))
    normals = octahedral(surfels.normals[order]).reshape(2, rows, SPLATS_PER_ROW)
    texels[:, :, 0, 3], texels[:, :, 1, 3] = _signed_steps(normals)
    texels[:, :, 2, 2] = blocks(surfels.materials) / _STEPS
    if surfels.blend_depth is not None:
        texels[:, :, 2, 3] = blocks(not_blended(surfels.blend_depth)) / _STEPS
    if surfels.hidden_back is not None:
        texels[:, :, 2, 3] += blocks(surfels.hidden_back >= HIDDEN) * (BLEND_STEPS / _STEPS)

    colors = blocks(surfels.colors)
    brightest = np.abs(colors[..., :3]).max(axis=(1, 2))
    texels[:, :, 3, :3] = _signed_steps(np.cbrt(colors[..., :3] / _divisor(brightest)[:, None, None]))
    texels[:, :, 3, 3] = _steps(np.clip(colors[..., 3], 0, 1))
    table[:, 2, 0] = brightest
    is_coarse = blocks(surfels.scales).min(axis=2) * COARSE < size.max(axis=1, keepdims=True) / (2 * _STEPS)
    return (texels.reshape(rows, -1, 4), table), int(np.count_nonzero(is_coarse.ravel()[:count]))


def rotation_parameters(quaternions: np.ndarray) -> np.ndarray:
    """(..., 3) modified Rodrigues parameters, (x, y, z) / (1 + w), of (..., 4) unit quaternions w, x, y, z.

    A quaternion and its negative are the same rotation; choosing w >= 0 keeps the parameters within 1.
    """
    w = quaternions[..., :1]
    return quaternions[..., 1:] * np.copysign(1 / (1 + np.abs(w)), w)


def _divisor(size):
    """The size as a divisor: 1 in place of 0."""
    return np.where(size > 0, size, 1)


def _steps(share):
    """0 to 1, rounded to multiples of 1 / 65535."""
    return np.rint(share * _STEPS) / _STEPS


def _signed_steps(share):
    """-1 to 1 as 0 to 65534 / 65535."""
    return (np.rint(np.clip(share, -1, 1) * _SIGNED_STEPS) + _SIGNED_STEPS) / _STEPS
