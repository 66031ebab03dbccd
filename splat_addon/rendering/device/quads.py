# SPDX-License-Identifier: GPL-3.0-or-later
"""The index buffer that both devices share: every splat is a quad of two triangles."""

from __future__ import annotations

import numpy as np


def capacity(quads: int) -> int:
    """The next power of two: the shared index buffer then grows only a few times."""
    return 1 << max(quads - 1, 1023).bit_length()


def quad_indices(quads: int) -> np.ndarray:
    """(2 quads, 3) uint32: the two triangles of every quad; a fixed order, since another diagonal changes pixels."""
    corners = np.array([[0, 1, 2], [2, 1, 3]], np.uint32)
    return (np.arange(quads, dtype=np.uint32)[:, None, None] * 4 + corners).reshape(-1, 3)
