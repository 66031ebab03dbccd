# SPDX-License-Identifier: GPL-3.0-or-later
"""The camera's view, prepared for float32: camera-relative, scaled and culled, all in float64.

The camera's position is subtracted before anything is rounded, and the view is scaled by a power of two (exact in
floating point) so that the median depth is about 1. The clip range is narrowed to the visible objects.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from .scene import Instance, Placed, PolygonInstance, Scene
from .scene.camera import Camera

#: The clip range extends beyond the bounds by this fraction of its ends (for a parallel camera, of its length or
#: window), so that rounding clips nothing.
_MARGIN = 1e-3

#: Visibility moves every splat back by at least this many steps of the depth buffer: rounding in the rasteriser's
#: interpolation is one or two steps.
_LEAST_STEPS = 16

#: Splats of a split object overlap its polygons by this many radii of the largest splat: one less has full weights.
SPLIT_OVERLAP = 1.5


@dataclass(frozen=True, eq=False)
class DrawItem:
    """model_view: (4, 4) float64, positions (without origin) to scaled view space.
    normal_matrix: (3, 3) float64, its inverse transpose up to a positive factor.
    hides_backs: splats or polygons that face away are skipped.
    is_whole: the camera sees all of it, judged from a sample.
    overlap: of polygons, how far behind them splats still count, view units.
    setback: minimum distance by which a visibility pass moves it back, beside `View.least_offset` and in its unit.
    split_distance: of polygons the farthest distance, of splats the least of their centres, view units; 0: no limit.
    """

    instance: Placed
    model_view: np.ndarray
    normal_matrix: np.ndarray
    hides_backs: bool
    is_whole: bool
    overlap: float = 0.0
    split_distance: float = 0.0
    setback: float = 0.0


@dataclass(frozen=True, eq=False)
class View:
    """scale: world to view units, a power of two. near: the camera's, scaled; the clip range may be narrower.
    first, far: the clip range, scaled.
    projection: (4, 4) float64 for scaled view space. outside: instances that cannot touch the picture.
    degenerate: instances whose matrix flattens space, so that they have no normals.
    depth_span: how many times the resolution of float32 the hardware's depth resolves at its farthest: far / near, of
        an orthographic camera far - near in view units.
    polygons: draw items of polygons. contact: maximum depth of polygons behind splats of the same surface.
    """

    scale: float
    near: float
    first: float
    far: float
    projection: np.ndarray
    placed: tuple[DrawItem, ...]
    outside: int
    degenerate: int
    depth_span: float
    polygons: tuple[DrawItem, ...] = ()
    contact: float = 0.0

    def least_offset(self, linear_depth: bool) -> float:
        """The offset that moves a splat back by a few steps of the depth buffer: a fraction of its distance, or for an
        orthographic camera a length in view units."""
        return _LEAST_STEPS / 2**24 * (1.0 if linear_depth else self.depth_span)


class ClipRange(NamedTuple):
    """near, far: stored range of depths, world units. scale: factor applied to depths first."""

    near: float
    far: float
    scale: float


def clip_range(scene: Scene, camera: Camera, epsilon: float) -> ClipRange:
    """The clip range of everything that the camera sees."""
    return _clipped(camera, _seen(scene, camera)[0], epsilon)


def _clipped(camera: Camera, seen, epsilon: float) -> ClipRange:
    near, far = _clip_range(camera, seen, epsilon)
    return ClipRange(near, far, _power_of_two_scale(camera, seen, near))


def build_view(scene: Scene, camera: Camera, epsilon: float, whole: ClipRange | None = None) -> View:
    """The scene's instances as seen by this camera. epsilon: how far visibility moves splats back, in radii.

    whole: clip range of the camera that this one is cropped from, if any, so that depths are rounded alike in all parts
        of a picture.
    """
    seen, outside, degenerate = _seen(scene, camera)
    near, far, scale = whole or _clipped(camera, seen, epsilon)
    radii = overlapping_radii(scene)
    placed = {Instance: [], PolygonInstance: []}
    for instance, _, _ in seen:
        model_view = instance.model_view(camera)
        normal_matrix = np.linalg.inv(model_view[:3, :3]).T
        normal_matrix /= np.abs(normal_matrix).max()
        model_view[:3] *= scale
        overlap = epsilon * radii.get(instance, 0.0) * scale
        of_kind = placed[type(instance)]
        hides_backs, limit = instance.hides_backs(camera), _split_distance(instance) * scale
        is_whole = not _beyond(instance.some_places(camera), camera).any()
        of_kind.append(DrawItem(instance, model_view, normal_matrix, hides_backs, is_whole, overlap, limit))
    return View(
        scale=scale,
        near=camera.near * scale,
        first=near * scale,
        far=far * scale,
        projection=scaled_projection(camera, near, far, scale),
        placed=tuple(placed[Instance]),
        outside=outside,
        degenerate=degenerate,
        depth_span=(far - near) * scale if camera.is_orthographic else far / near,
        polygons=tuple(placed[PolygonInstance]),
        contact=(1 + 4 * epsilon) * max(radii.values(), default=0.0) * scale,
    )


def _split_distance(instance: Placed) -> float:
    """Where the instance begins or ends, world units. Splats begin before polygons end: their weights then sum to 1 and
    more where polygons end (Guennebaud et al. 2006, section 5.1).
    """
    if instance.split_distance is None or instance.shape.is_transparent:
        return 0.0
    return max(instance.split_distance - SPLIT_OVERLAP * instance.radius, 0.0)


def overlapping_radii(scene: Scene) -> dict[PolygonInstance, float]:
    """For polygons whose box touches that of surfels: the largest radius of these surfels, in world units."""
    if not scene.polygons or not scene.surfels:
        return {}
    splats = [(*_world_box(instance), instance.radius) for instance in scene.surfels if len(instance.surfels)]
    radii = {}
    for instance in scene.polygons:
        if len(instance.polygons):
            low, high = _world_box(instance)
            touching = [r for first, last, r in splats if (first <= high).all() and (low <= last).all()]
            if touching:
                radii[instance] = max(touching)
    return radii


def _world_box(instance: Placed) -> tuple[np.ndarray, np.ndarray]:
    corners = instance.world_corners()
    return corners.min(axis=0), corners.max(axis=0)


def sees_any(scene: Scene, camera: Camera) -> bool:
    """Whether any instance may be in the camera's picture."""
    return bool(_seen(scene, camera)[0])


def visible_corners(scene: Scene, camera: Camera) -> tuple[np.ndarray, np.ndarray] | None:
    """World corners (n, 3) of the boxes of visible objects, and (8, 3) corners of the visible part of space."""
    seen, _, _ = _seen(scene, camera)
    if not seen:
        return None
    near, far = _clip_range(camera, seen, 0.0)
    left, right, bottom, top = camera.window
    spread = (1.0, 1.0) if camera.is_orthographic else (near, far)
    eye = [
        (x * s, y * s, -d)
        for d, s in zip((near, far), spread, strict=True)
        for x in (left, right)
        for y in (bottom, top)
    ]
    space = np.array(eye) @ camera.matrix_world[:3, :3].T + camera.matrix_world[:3, 3]
    return np.concatenate([instance.world_corners() for instance, *_ in seen]), space


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
    seen, _, _ = _seen(scene, camera)
    near, far = _clip_range(camera, seen, epsilon)
    radius = max((radius for *_, radius in seen), default=0.0)
    # Add a radius, because a method may lengthen the shorter half-axis.
    reaches_near = any(float(depths.min()) - reach <= camera.near for _, depths, reach in seen if reach)
    left, right, bottom, top = camera.window
    unit, length = (max(right - left, top - bottom), far - near) if camera.is_orthographic else (near, far)
    nearest = min((float(depths.min()) for _, depths, _ in seen), default=near)
    return DepthExtent(near, far, length / unit, radius / unit, reaches_near, max(nearest, camera.near) > 0)


def scaled_projection(camera: Camera, near: float, far: float, scale: float) -> np.ndarray:
    """(4, 4) float64 projection of view space times `scale`."""
    matrix = camera.projection(near, far)
    if camera.is_orthographic:
        matrix[:3, :3] /= scale
    else:
        matrix[2, 3] *= scale
    return matrix


def _seen(scene: Scene, camera: Camera) -> tuple[list, int, int]:
    """(instance, depths of its box's corners, radius of its largest splat) for objects that may be in the picture; and
    the numbers of instances that are not, and of those that flatten space."""
    shown = scene.shown
    firm = [instance for instance in shown if not instance.is_flattened]
    if not firm:
        return [], 0, len(shown)
    corners = np.stack([instance.corners(camera) for instance in firm])
    inside = ~_beyond(corners.reshape(-1, 3), camera).reshape(6, *corners.shape[:2]).all(axis=2).any(axis=0)
    kept = zip(firm, -corners[..., 2], inside.tolist(), strict=True)
    seen = [(instance, depths, instance.radius) for instance, depths, is_inside in kept if is_inside]
    return seen, len(firm) - len(seen), len(shown) - len(firm)


def _beyond(corners: np.ndarray, camera: Camera) -> np.ndarray:
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
