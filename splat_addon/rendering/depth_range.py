# SPDX-License-Identifier: GPL-3.0-or-later
"""Which objects may be in a camera's picture, and the range of their depths; in float64, in world units.

The clip range is narrowed to the visible objects, and the view is scaled so that its median depth is about 1.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ..surfels import Surfels
from .scene.boxes import CORNERS, corner_by_corner, joined
from .scene.camera import Camera
from .scene.far_reaching import box_corners, seen_places
from .scene.from_eye import FromEye
from .scene.table import InstanceTable

#: The clip range extends beyond the bounds by this fraction of its ends (for a parallel camera, of its length or
#: window), so that rounding clips nothing.
_MARGIN = 1e-3


#: The median depth of a view with more instances than this is taken from the middles of their boxes.
_MOST_SAMPLED = 64

#: Surfels or corners of an instance of which the median depth is taken.
_SOME = 256

#: Of more places than this, the bounds of the picture are those of boxes.
_MOST_PLACES = 1 << 14


class ClipRange(NamedTuple):
    """near, far: stored range of depths, world units. scale: factor applied to depths first."""

    near: float
    far: float
    scale: float


class Seen(NamedTuple):
    """The instances that may be in a camera's picture. outside: number of others. degenerate: of flattened ones."""

    table: InstanceTable
    from_eye: FromEye
    outside: int
    degenerate: int

    @property
    def depths(self) -> np.ndarray:
        """(n, 8) depths of the corners of their boxes."""
        return -self.from_eye.corners[..., 2]


def clip_range(table: InstanceTable, camera: Camera, epsilon: float, epsilon_length: float = 0.0) -> ClipRange:
    """The clip range of everything that the camera sees."""
    return clipped(camera, seen_by(table, camera), epsilon, epsilon_length)


def clipped(camera: Camera, seen: Seen, epsilon: float, epsilon_length: float = 0.0) -> ClipRange:
    """The clip range of what `seen_by` found."""
    near, far = _clip_range(camera, seen, epsilon, epsilon_length)
    return ClipRange(near, far, _power_of_two_scale(camera, seen, near))


def visible_space(camera: Camera, seen: Seen) -> tuple[float, float, np.ndarray]:
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


def depth_extent(table: InstanceTable, camera: Camera, epsilon: float, epsilon_length: float = 0.0) -> DepthExtent:
    """The depth extent of objects that may be in the picture."""
    seen = seen_by(table, camera)
    near, far = _clip_range(camera, seen, epsilon, epsilon_length)
    radii, nearest = seen.table.radii, seen.depths.min(axis=1)
    # Add a radius, because a method may lengthen the shorter half-axis.
    reaches_near = bool((nearest - radii <= camera.near)[radii > 0].any())
    left, right, bottom, top = camera.window
    unit, length = (max(right - left, top - bottom), far - near) if camera.is_orthographic else (near, far)
    radius = float(radii.max(initial=0.0))
    is_ahead = max(float(nearest.min(initial=np.inf)) if len(nearest) else near, camera.near) > 0
    return DepthExtent(near, far, length / unit, radius / unit, reaches_near, is_ahead)


def seen_by(table: InstanceTable, camera: Camera) -> Seen:
    """The instances that may be in the picture. Of far-reaching triangles, the boxes are those of what is in the view
    volume."""
    firm, found = table.firm, []
    for part in firm.parts():
        corners = part.from_eye(camera).corners
        inside = ~are_outside(corners, camera)
        for row in part.reaching.tolist():
            places = seen_places(part.placed[row], camera)
            inside[row] = len(places) > 0
            if len(places):
                corners[row] = box_corners(places)
        found.append((inside, corners if inside.all() else corner_by_corner(corners, inside)))
    inside, corners = zip(*found, strict=True)
    inside = np.concatenate(inside)
    seen, outside = firm.taken(inside), len(firm) - int(inside.sum())
    return Seen(seen, FromEye(seen, camera, joined(corners)), outside, len(table) - len(firm))


def are_outside(corners: np.ndarray, camera: Camera) -> np.ndarray:
    """(n,) bool: whether (n, 8, 3) corners of a box, in view space, are all beyond one plane of the view volume."""
    return np.logical_or.reduce([are.all(axis=1) for are in beyond(corners, camera)])


def beyond(places: np.ndarray, camera: Camera) -> tuple[np.ndarray, ...]:
    """For each plane of the camera's view volume, (...) bool: which of (..., 3) places in view space are beyond it."""
    x, y, depth = places[..., 0], places[..., 1], -places[..., 2]
    left, right, bottom, top = camera.window
    spread = 1.0 if camera.is_orthographic else depth
    return (
        depth < camera.near,
        depth > camera.far,
        x < left * spread,
        x > right * spread,
        y < bottom * spread,
        y > top * spread,
    )


def picture_bounds(seen: Seen, camera: Camera) -> tuple[float, float, float, float] | None:
    """Left, bottom, right and top in pixels of everything that `seen_by` found; None if any of it is not wholly in
    front of the camera, or there is nothing."""
    if not len(seen.table):
        return None
    places = _hulls(seen)
    if not (-places[:, 2] >= camera.near).all():
        return None
    pixels = camera.pixels_of(places)
    return (*pixels.min(axis=0).tolist(), *pixels.max(axis=0).tolist())


def _hulls(seen: Seen) -> np.ndarray:
    """(n, 3) places in view space whose convex hull holds everything."""
    table, corners = seen.table, seen.from_eye.corners
    rows = np.flatnonzero(table.of_kinds(lambda placed: isinstance(placed.shape, Surfels)))
    if len(rows) > _MOST_PLACES // len(CORNERS):
        return corners.reshape(-1, 3)
    shapes = table.shapes
    hulls = [shapes[shape].local_hull for shape in table.shape_of[rows].tolist()]
    if sum(map(len, hulls)) > _MOST_PLACES:
        return corners.reshape(-1, 3)
    matrices = seen.from_eye.model_views[rows]
    places = [hull @ matrix[:3, :3].T + matrix[:3, 3] for hull, matrix in zip(hulls, matrices, strict=True)]
    return np.concatenate([np.delete(corners, rows, axis=0).reshape(-1, 3), *places])


def _clip_range(camera: Camera, seen: Seen, epsilon: float, epsilon_length: float = 0.0) -> tuple[float, float]:
    if not len(seen.table):
        return camera.near, camera.far
    nearest = float(seen.depths.min())
    farthest = float((seen.depths.max(axis=1) + epsilon * seen.table.radii).max()) + epsilon_length
    before, behind = abs(nearest), abs(farthest)
    if camera.is_orthographic:
        left, right, bottom, top = camera.window
        before = behind = max(farthest - nearest, right - left, top - bottom)
    near = max(camera.near, nearest - _MARGIN * before)
    far = min(camera.far, farthest + _MARGIN * behind)
    return near, max(far, near + max(abs(near) * _MARGIN, 1e-300))


def _power_of_two_scale(camera: Camera, seen: Seen, near: float) -> float:
    """The factor 2^-k that brings the median depth, weighted by surfel count, into 0.7 to 1.4."""
    if not len(seen.table):
        return 1.0
    depths = _median_depths(seen, camera, near)
    if camera.is_orthographic:
        left, right, bottom, top = camera.window
        depths = np.maximum(np.abs(depths), max(right - left, top - bottom))
    counts = seen.table.counts
    order = np.argsort(depths)
    half = np.searchsorted(np.cumsum(counts[order]), counts.sum() / 2)
    return math.ldexp(1.0, -round(math.log2(depths[order][min(half, len(order) - 1)])))


def _median_depths(seen: Seen, camera: Camera, near: float) -> np.ndarray:
    """(n,) the median depth of some places of each instance between the clip planes; distant outliers count no more
    than others."""
    if len(seen.table) > _MOST_SAMPLED:
        middles = seen.depths.mean(axis=1)
        return np.where((middles > near) & (middles < camera.far), middles, near)
    medians = []
    for matrix, shape in zip(seen.from_eye.model_views, seen.table.shape_of.tolist(), strict=True):
        places = seen.table.shapes[shape].positions
        depths = -(places[:: max(-(-len(places) // _SOME), 1)] @ matrix[:3, :3].T + matrix[:3, 3])[:, 2]
        depths = depths[(depths > near) & (depths < camera.far)]
        medians.append(float(np.median(depths)) if len(depths) else near)
    return np.array(medians)
