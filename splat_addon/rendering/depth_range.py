# SPDX-License-Identifier: GPL-3.0-or-later
"""Which objects may be in a camera's picture, and the range of their depths; in float64, in world units.

The clip range is narrowed to the visible objects, and the view is scaled so that its median depth is about 1.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from .scene import Placed, Scene
from .scene.camera import Camera

#: The clip range extends beyond the bounds by this fraction of its ends (for a parallel camera, of its length or
#: window), so that rounding clips nothing.
_MARGIN = 1e-3


class ClipRange(NamedTuple):
    """near, far: stored range of depths, world units. scale: factor applied to depths first."""

    near: float
    far: float
    scale: float


def clip_range(scene: Scene, camera: Camera, epsilon: float) -> ClipRange:
    """The clip range of everything that the camera sees."""
    return clipped(camera, seen_by(scene, camera)[0], epsilon)


def clipped(camera: Camera, seen, epsilon: float) -> ClipRange:
    """The clip range of what `seen_by` found."""
    near, far = _clip_range(camera, seen, epsilon)
    return ClipRange(near, far, _power_of_two_scale(camera, seen, near))


def visible_space(camera: Camera, seen) -> tuple[float, float, np.ndarray]:
    """The least and greatest depth of what `seen_by` found, and (8, 3) world corners of the visible space between."""
    near, far = _clip_range(camera, seen, 0.0)
    left, right, bottom, top = camera.window
    spread = (1.0, 1.0) if camera.is_orthographic else (near, far)
    eye = [
        (x * s, y * s, -d)
        for d, s in zip((near, far), spread, strict=True)
        for x in (left, right)
        for y in (bottom, top)
    ]
    return near, far, np.array(eye) @ camera.matrix_world[:3, :3].T + camera.matrix_world[:3, 3]


@dataclass(frozen=True)
class DepthExtent:
    """near, far: depths of what a camera sees, world units. ratio: of the farthest to the nearest; of an orthographic
        camera, the length between them over its window's longer edge.
    radius: the largest splat's, over the nearest depth, or that edge.
    reaches_near: some splat may touch the near plane. is_ahead: all depths are above 0.
    """

    near: float
    far: float
    ratio: float
    radius: float
    reaches_near: bool
    is_ahead: bool


def depth_extent(scene: Scene, camera: Camera, epsilon: float) -> DepthExtent:
    """The depth extent of objects that may be in the picture."""
    seen, _, _ = seen_by(scene, camera)
    near, far = _clip_range(camera, seen, epsilon)
    radius = max((radius for *_, radius in seen), default=0.0)
    # Add a radius, because a method may lengthen the shorter half-axis.
    reaches_near = any(float(depths.min()) - reach <= camera.near for _, depths, reach in seen if reach)
    left, right, bottom, top = camera.window
    unit, length = (max(right - left, top - bottom), far - near) if camera.is_orthographic else (near, far)
    nearest = min((float(depths.min()) for _, depths, _ in seen), default=near)
    return DepthExtent(near, far, length / unit, radius / unit, reaches_near, max(nearest, camera.near) > 0)


def seen_by(scene: Scene, camera: Camera) -> tuple[list, int, int]:
    """The instances that may be in the picture, the number of those outside it, and of those that are flattened.

    Each of the first is (instance, depths of its box's corners, radius of its largest splat).
    """
    shown = scene.shown
    firm = [instance for instance in shown if not instance.is_flattened]
    if not firm:
        return [], 0, len(shown)
    corners = np.stack([instance.corners(camera) for instance in firm])
    inside = ~beyond(corners.reshape(-1, 3), camera).reshape(6, *corners.shape[:2]).all(axis=2).any(axis=0)
    kept = zip(firm, -corners[..., 2], inside.tolist(), strict=True)
    seen = [(instance, depths, instance.radius) for instance, depths, is_inside in kept if is_inside]
    return seen, len(firm) - len(seen), len(shown) - len(firm)


def beyond(corners: np.ndarray, camera: Camera) -> np.ndarray:
    """(6, n) for each plane of the camera's view volume, which of n points in view space are beyond it."""
    x, y, depth = corners[:, 0], corners[:, 1], -corners[:, 2]
    left, right, bottom, top = camera.window
    spread = 1.0 if camera.is_orthographic else depth
    return np.array(
        [
            depth < camera.near,
            depth > camera.far,
            x < left * spread,
            x > right * spread,
            y < bottom * spread,
            y > top * spread,
        ]
    )


def picture_bounds(seen, camera: Camera) -> tuple[float, float, float, float] | None:
    """Left, bottom, right and top in pixels of everything that `seen_by` found; None if any of it is not wholly in
    front of the camera, or there is nothing."""
    if not seen:
        return None
    places = np.concatenate([instance.hull(camera) for instance, *_ in seen])
    if not (-places[:, 2] >= camera.near).all():
        return None
    pixels = camera.pixels_of(places)
    return (*pixels.min(axis=0).tolist(), *pixels.max(axis=0).tolist())


def _clip_range(camera: Camera, seen, epsilon: float) -> tuple[float, float]:
    if not seen:
        return camera.near, camera.far
    nearest = min(float(depths.min()) for _, depths, _ in seen)
    farthest = max(float(depths.max()) + epsilon * radius for _, depths, radius in seen)
    before, behind = abs(nearest), abs(farthest)
    if camera.is_orthographic:
        left, right, bottom, top = camera.window
        before = behind = max(farthest - nearest, right - left, top - bottom)
    near = max(camera.near, nearest - _MARGIN * before)
    far = min(camera.far, farthest + _MARGIN * behind)
    return near, max(far, near + max(abs(near) * _MARGIN, 1e-300))


def _power_of_two_scale(camera: Camera, seen, near: float) -> float:
    """The factor 2^-k that brings the median depth, weighted by surfel count, into 0.7 to 1.4."""
    if not seen:
        return 1.0
    depths = np.array([_median_depth(instance, camera, near) for instance, *_ in seen])
    if camera.is_orthographic:
        left, right, bottom, top = camera.window
        depths = np.maximum(np.abs(depths), max(right - left, top - bottom))
    counts = np.array([len(instance.shape) for instance, *_ in seen])
    order = np.argsort(depths)
    half = np.searchsorted(np.cumsum(counts[order]), counts.sum() / 2)
    return math.ldexp(1.0, -round(math.log2(depths[order][min(half, len(order) - 1)])))


def _median_depth(instance: Placed, camera: Camera, near: float) -> float:
    """The median depth of a sample between the clip planes; distant outliers count no more than others."""
    depths = -instance.some_places(camera)[:, 2]
    depths = depths[(depths > near) & (depths < camera.far)]
    return float(np.median(depths)) if len(depths) else near
