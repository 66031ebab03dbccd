# SPDX-License-Identifier: GPL-3.0-or-later
"""Ambient occlusion of a picture in float64, from all surrounding pixels.

The twin of shaders/features/ambient_occlusion.glsl, which samples some of them (Jimenez et al. 2016).
"""

from __future__ import annotations

import math

import numpy as np

from ..rendering.frame import EMPTY_DEPTH, Frame
from ..rendering.scene.camera import Camera
from ..vectors import unit

#: Slices run along whole steps of up to this many pixels; there are 16 of them.
MOST_STEP = 4
#: Minimum cosine to the viewer: a mean normal may face away although the surface is visible.
LEAST_FACING = 0.2


def open_share(frame: Frame, camera: Camera, distance: float) -> np.ndarray:
    """(h, w) unoccluded share of the half-space around the normal, weighted by the cosine; 1 where nothing is visible.

    frame: its depth and normal are used. distance: occluders count fully up to half of it, and not at all beyond it.
    """
    position = np.where((frame.depth < EMPTY_DEPTH)[..., None], camera.points_at(frame.depth), np.nan)
    normal = frame.normal / np.maximum(np.linalg.norm(frame.normal, axis=2, keepdims=True), 1e-30)
    turned = camera.matrix_world[:3, :3]
    to_eye = turned[:, 2] if camera.is_orthographic else unit(camera.matrix_world[:3, 3] - position)
    left, right, bottom, top = camera.window
    pixel = np.array(((right - left) / camera.size[0], (top - bottom) / camera.size[1]))
    facing = np.maximum((normal * to_eye).sum(axis=2), LEAST_FACING)
    total, unhidden = np.zeros(facing.shape), np.zeros(facing.shape)
    for along, width in _slices():
        across = turned[:, :2] @ (pixel * along) + np.zeros_like(position)
        across = unit(across - to_eye * (across * to_eye).sum(axis=2, keepdims=True))
        aside = (normal * across).sum(axis=2)
        size, tilt = np.hypot(facing, aside), np.arctan2(aside, facing)
        after = np.arccos(_horizon(position, to_eye, along, distance, -aside / size))
        before = -np.arccos(_horizon(position, to_eye, -along, distance, aside / size))
        total += width * size * (_arc(before, tilt) + _arc(after, tilt))
        unhidden += width * (facing + tilt * aside)
    return np.nan_to_num(total / unhidden, nan=1.0)


def _slices():
    """((2,) whole steps, angle that they stand for) for directions over half a turn."""
    steps = range(-MOST_STEP, MOST_STEP + 1)
    found = [(x, y) for x in steps for y in steps if math.gcd(x, y) == 1 and (y > 0 or (y == 0 and x > 0))]
    found.sort(key=lambda along: math.atan2(along[1], along[0]))
    angles = np.array([math.atan2(y, x) for x, y in found])
    widths = (np.append(angles[1:], angles[0] + np.pi) - np.append(angles[-1] - np.pi, angles[:-1])) / 2
    return zip(np.array(found), widths, strict=True)


def _horizon(position, to_eye, along, distance: float, lowest) -> np.ndarray:
    """Cosine between the direction to the viewer and the highest horizon along a direction."""
    highest, (height, width) = lowest.copy(), lowest.shape
    for step in range(1, max(height, width)):
        x, y = step * along
        here = np.s_[max(-y, 0) : height - max(y, 0), max(-x, 0) : width - max(x, 0)]
        there = np.s_[max(y, 0) : height + min(y, 0), max(x, 0) : width + min(x, 0)]
        if abs(x) >= width or abs(y) >= height:
            break
        toward = position[there] - position[here]
        away = np.linalg.norm(toward, axis=2)
        cosine = (toward * (to_eye[here] if to_eye.ndim == 3 else to_eye)).sum(axis=2) / away
        weight = np.clip(2 - 2 * away / distance, 0, 1)
        highest[here] = np.fmax(highest[here], lowest[here] + weight * (cosine - lowest[here]))
    return np.clip(highest, -1, 1)


def _arc(angle, tilt) -> np.ndarray:
    return (np.cos(tilt) - np.cos(2 * angle - tilt) + 2 * angle * np.sin(tilt)) / 4
