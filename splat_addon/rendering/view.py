# SPDX-License-Identifier: GPL-3.0-or-later
"""The camera's view, prepared for float32: camera-relative, scaled and culled, all in float64.

The camera's position is subtracted before anything is rounded, and the view is scaled by a power of two (exact in
floating point) so that the median depth is about 1. The clip range is narrowed to the visible objects.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .depth_range import ClipRange, clipped, picture_bounds, seen_by
from .scene import Instance, Placed, PolygonInstance, Scene
from .scene.camera import Camera

#: Visibility moves every splat back by at least this many steps of the depth buffer: rounding in the rasterizer's
#: interpolation is one or two steps.
_LEAST_STEPS = 16

#: Splats of a split object overlap its polygons by this many radii of the largest splat: one less has full weights.
SPLIT_OVERLAP = 1.5


@dataclass(frozen=True, eq=False)
class DrawItem:
    """model_view: (4, 4) float64, positions (without origin) to scaled view space.
    normal_matrix: (3, 3) float64, its inverse transpose up to a positive factor.
    hides_backs: splats or polygons that face away are skipped.
    overlap: of polygons, how far behind them splats still count, view units.
    setback: minimum distance by which a visibility pass moves it back, beside `View.least_offset` and in its unit.
    split_distance: of polygons the farthest distance, of splats the least of their centres, view units; 0: no limit.
    part: of the storage, for a draw call.
    """

    instance: Placed
    model_view: np.ndarray
    normal_matrix: np.ndarray
    hides_backs: bool
    overlap: float = 0.0
    split_distance: float = 0.0
    setback: float = 0.0
    part: int = 0


@dataclass(frozen=True, eq=False)
class View:
    """scale: world to view units, a power of two. near: the camera's, scaled; the clip range may be narrower.
    first, far: the clip range, scaled.
    projection: (4, 4) float64 for scaled view space. outside: instances that cannot touch the picture.
    degenerate: instances whose matrix flattens space, so that they have no normals.
    depth_span: how many times the resolution of float32 the hardware's depth resolves at its farthest: far / near, of
        an orthographic camera far - near in view units.
    bounds: left, bottom, right, top in pixels outside of which nothing is; None if that is not known.
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
    bounds: tuple[float, float, float, float] | None = None
    polygons: tuple[DrawItem, ...] = ()
    contact: float = 0.0

    def least_offset(self, linear_depth: bool) -> float:
        """The offset that moves a splat back by a few steps of the depth buffer: a fraction of its distance, or for an
        orthographic camera a length in view units."""
        return _LEAST_STEPS / 2**24 * (1.0 if linear_depth else self.depth_span)


def build_view(
    scene: Scene, camera: Camera, epsilon: float, whole: ClipRange | None = None, are_split: bool = True
) -> View:
    """The scene's instances as seen by this camera. epsilon: how far visibility moves splats back, in radii.

    whole: clip range of the camera that this one is cropped from, if any, so that depths are rounded alike in all parts
        of a picture.
    are_split: whether split objects are polygons near this camera and surfels beyond; they cast shadows as both.
    """
    seen, outside, degenerate = seen_by(scene, camera)
    near, far, scale = whole or clipped(camera, seen, epsilon)
    radii = overlapping_radii(scene)
    placed = {Instance: [], PolygonInstance: []}
    for instance, _, _ in seen:
        model_view = instance.model_view(camera)
        normal_matrix = np.linalg.inv(model_view[:3, :3]).T
        normal_matrix /= np.abs(normal_matrix).max()
        model_view[:3] *= scale
        overlap = epsilon * radii.get(instance, 0.0) * scale
        of_kind = placed[type(instance)]
        hides_backs, limit = instance.hides_backs(camera), _split_distance(instance, camera) if are_split else 0.0
        if limit is None:
            continue
        of_kind.append(DrawItem(instance, model_view, normal_matrix, hides_backs, overlap, limit * scale))
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
        bounds=picture_bounds(seen, camera),
        polygons=tuple(placed[PolygonInstance]),
        contact=(1 + 4 * epsilon) * max(radii.values(), default=0.0) * scale,
    )


def _split_distance(instance: Placed, camera: Camera) -> float | None:
    """The distance at which the instance begins or ends, world units; 0 if it is seen everywhere, None if nowhere.

    Splats begin before polygons end, so that their weights sum to 1 or more where polygons end (Guennebaud et al. 2006,
    section 5.1).
    """
    if not instance.is_split or instance.shape.is_transparent:
        return 0.0
    end, (nearest, farthest) = instance.polygons_end(camera), instance.distances(camera)
    if isinstance(instance, PolygonInstance):
        return None if nearest > end or not end else end if farthest > end else 0.0
    begin = max(end - SPLIT_OVERLAP * instance.radius, 0.0)
    return None if farthest < begin else begin if nearest < end else 0.0


def split_distances(placed: DrawItem, view: View) -> tuple[float, float] | None:
    """Where the surfels of a split object begin, and where its polygons end, world units; None if all are shown."""
    if not placed.split_distance:
        return None
    begin = placed.split_distance / view.scale
    return begin, begin + SPLIT_OVERLAP * placed.instance.radius


def overlapping_radii(scene: Scene) -> dict[PolygonInstance, float]:
    """For polygons whose box touches that of surfels: the largest grain of these surfels, in world units."""
    if not scene.polygons or not scene.surfels:
        return {}
    splats = [(*_world_box(instance), instance.grain) for instance in scene.surfels if len(instance.surfels)]
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


def scaled_projection(camera: Camera, near: float, far: float, scale: float) -> np.ndarray:
    """(4, 4) float64 projection of view space times `scale`."""
    matrix = camera.projection(near, far)
    if camera.is_orthographic:
        matrix[:3, :3] /= scale
    else:
        matrix[2, 3] *= scale
    return matrix
