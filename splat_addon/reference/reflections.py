# SPDX-License-Identifier: GPL-3.0-or-later
"""What rays meet among the things that the camera or a probe sees, in float64, by small steps.

The twin of shaders/features/reflections.glsl, which finds the place by halving (McGuire and Mara 2014; Szirmay-Kalos et
al. 2005), and takes what a probe does not see behind something to be as what is beside that; here it is what hides it.
"""

from __future__ import annotations

import numpy as np

from ..rendering.frame import EMPTY_DEPTH, Frame
from ..rendering.scene.camera import Camera

#: Steps along the angle that a ray's points turn through at the probe, or along the ray's line in the picture.
STEPS = 2000
#: How far behind what begins to hide it a ray may be and still meet it, as a share of the depth, and how far behind it
#: may begin.
BEHIND, TOUCHES = 0.05, 0.005


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


def met_in_picture(camera: Camera, depth: np.ndarray, places: np.ndarray, directions: np.ndarray) -> np.ndarray:
    """(n, 2) where rays meet what a perspective camera sees, in its pixels; not a number where they do not.

    depth: (h, w). places, directions: (n, 3), world.
    """
    to_view = camera.world_to_view()
    start, along = places @ to_view[:3, :3].T + to_view[:3, 3], directions @ to_view[:3, :3].T
    nearer = along[:, 2] > 0
    reach = np.where(nearer, 0.99 * -start[:, 2] / np.where(nearer, along[:, 2], 1.0), 1e6)
    left, right, bottom, top = camera.window
    per_unit = np.array(camera.size) / (right - left, top - bottom)

    def in_pixels(view: np.ndarray) -> np.ndarray:
        seen = (view[:, :2] / -view[:, 2:] - (left, bottom)) * per_unit
        return np.concatenate([seen, -1 / view[:, 2:]], axis=1)

    first, last = in_pixels(start), in_pixels(start + along * reach[:, None])
    found = np.full((len(places), 2), np.nan)
    before = np.zeros(len(places))
    for share in np.arange(STEPS + 1) / STEPS:
        at = first + (last - first) * share
        column, row = np.floor(at[:, :2]).astype(int).T
        inside = (column >= 0) & (row >= 0) & (column < camera.size[0]) & (row < camera.size[1])
        seen = depth[np.where(inside, row, 0), np.where(inside, column, 0)]
        behind = np.where(inside, 1 / at[:, 2] - seen, np.nan)
        if share == 0:
            behind = np.where(behind < TOUCHES * seen, np.minimum(behind, 0), behind)
        meets = (before <= 0) & (behind > 0) & (behind < BEHIND * seen) & np.isnan(found[:, 0]) & (share > 0)
        found[meets] = at[meets, :2]
        before = behind
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
