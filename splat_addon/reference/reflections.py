# SPDX-License-Identifier: GPL-3.0-or-later
"""What rays meet among the things that a probe sees, in float64, by small steps.

The twin of shaders/features/reflections.glsl, which finds the place by halving (Szirmay-Kalos et al. 2005), and takes
what is hidden behind something to be as what is beside that; here it is what hides it.
"""

from __future__ import annotations

import numpy as np

from ..rendering.frame import EMPTY_DEPTH, Frame

#: Steps along the angle that a ray's points turn through at the probe.
STEPS = 2000


def met_directions(seen: Frame, places: np.ndarray, directions: np.ndarray) -> np.ndarray:
    """(n, 3) unit directions from the probe in which rays meet what it sees; the rays' own where they meet nothing.

    seen: an octahedral map with its border, of colours and distances. places: (n, 3) where the rays begin, relative to
    the probe. directions: (n, 3), unit.
    """
    inverse = np.where(seen.depth < EMPTY_DEPTH, 1 / seen.depth, 0.0)
    length = np.linalg.norm(places, axis=1, keepdims=True)
    start = places / length
    cosine = (start * directions).sum(axis=1, keepdims=True)
    side = directions - start * cosine
    sine = np.linalg.norm(side, axis=1, keepdims=True)
    side /= np.maximum(sine, 1e-12)
    turn = np.arctan2(sine, cosine)
    found, was_before, is_met = directions.copy(), np.zeros(len(places), bool), np.zeros(len(places), bool)
    for share in np.arange(STEPS + 1) / STEPS:
        angle = turn * share
        toward = start * np.cos(angle) + side * np.sin(angle)
        own = np.sin(turn - angle)[:, 0] / np.maximum(length * sine, 1e-30)[:, 0]
        is_before = map_at(inverse[..., None], toward)[:, 0] < own
        meets = was_before & ~is_before & ~is_met
        found[meets] = toward[meets]
        is_met |= meets
        was_before = is_before
    return found


def map_at(texels: np.ndarray, directions: np.ndarray) -> np.ndarray:
    """(n, c) values in (n, 3) directions, interpolated in an octahedral map (side + 2, side + 2, c) with its border."""
    side, d = len(texels) - 2, directions / np.abs(directions).sum(axis=1, keepdims=True)
    folded = np.where(d[:, :2] >= 0, 1, -1) * (1 - np.abs(d[:, 1::-1]))
    at = (np.where(d[:, 2:] < 0, folded, d[:, :2]) * 0.5 + 0.5) * side + 0.5
    low = np.clip(np.floor(at).astype(int), 0, side)
    share, (column, row) = at - low, low.T
    rows = [texels[row + k, column] * (1 - share[:, :1]) + texels[row + k, column + 1] * share[:, :1] for k in (0, 1)]
    return rows[0] * (1 - share[:, 1:]) + rows[1] * share[:, 1:]
