# SPDX-License-Identifier: GPL-3.0-or-later
"""Unit quaternions and the orthonormal frames that they stand for."""

from __future__ import annotations

import numpy as np


def quaternion_axes(quaternions: np.ndarray, count: int = 3) -> tuple[np.ndarray, ...]:
    """Local x, y and z axes of unit quaternions.

    quaternions: (N, 4) w, x, y, z. Returns three (N, 3) arrays of the same dtype; with `count` below 3 the remaining
        ones are None, which saves time.
    """
    columns = axes_columns(quaternions, *range(count))
    return tuple(np.ascontiguousarray(columns[k].T) if k < count else None for k in range(3))


def axes_columns(quaternions: np.ndarray, *axes: int) -> np.ndarray:
    """(len(axes), 3, N) of (N, 4) unit quaternions: their local x (0), y (1) or z (2) axes, by component."""
    w, x, y, z = np.ascontiguousarray(quaternions.T)
    components = (
        lambda: (1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)),
        lambda: (2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)),
        lambda: (2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)),
    )
    columns = np.empty((len(axes), 3, len(quaternions)), quaternions.dtype)
    for k, axis in enumerate(axes):
        for j, values in enumerate(components[axis]()):
            columns[k, j] = values
    return columns


def axes_quaternions(x: np.ndarray, y: np.ndarray, z: np.ndarray) -> np.ndarray:
    """Unit quaternions (N, 4) w, x, y, z, w >= 0, of right-handed orthonormal frames given as three (N, 3) arrays.

    The trace and the diagonal give each component's square; the largest component is taken as the pivot (Shepperd
    1978), so no component is ever divided by a small number.
    """
    (m00, m10, m20), (m01, m11, m21), (m02, m12, m22) = (np.ascontiguousarray(a.T) for a in (x, y, z))
    candidates = np.stack([1 + m00 + m11 + m22, 1 + m00 - m11 - m22, 1 - m00 + m11 - m22, 1 - m00 - m11 + m22])
    pivot = candidates.argmax(axis=0)
    rows = np.empty((len(pivot), 4), x.dtype)
    off_diagonals = {(0, 1): m21 - m12, (0, 2): m02 - m20, (0, 3): m10 - m01,
                     (1, 2): m10 + m01, (1, 3): m02 + m20, (2, 3): m21 + m12}  # fmt: skip
    for p in range(4):
        at = np.flatnonzero(pivot == p)
        for c in range(4):
            rows[at, c] = candidates[p][at] if c == p else off_diagonals[min(c, p), max(c, p)][at]
    rows /= np.linalg.norm(rows, axis=1, keepdims=True)
    return np.where(rows[:, :1] < 0, -rows, rows)
