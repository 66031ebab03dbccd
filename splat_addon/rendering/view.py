# SPDX-License-Identifier: GPL-3.0-or-later
"""The camera's view, prepared for float32: camera-relative, scaled and culled, all in float64.

The camera's position is subtracted before anything is rounded, and the view is scaled by a power of two (exact in
floating point) so that the median depth is about 1. The clip range is narrowed to the visible objects.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..surfels import Surfels
from .depth_range import ClipRange, Seen, clipped, picture_bounds, seen_by
from .scene import Placed
from .scene.camera import Camera
from .scene.from_eye import FromEye
from .scene.table import InstanceTable

#: Visibility moves every splat back by at least this many steps of the depth buffer: rounding in the rasterizer's
#: interpolation is one or two steps.
_LEAST_STEPS = 16

#: Splats of a split object overlap its polygons by this many radii of the largest splat: one less has full weights.
SPLIT_OVERLAP = 1.5


@dataclass(frozen=True, eq=False)
class DrawItem:
    """One of the instances that a view draws, as `Items` have it. part: of its storage, for a draw call."""

    instance: Placed
    items: Items
    row: int
    part: int = 0

    @property
    def hides_backs(self) -> bool:
        return bool(self.items.hides_backs[self.row])

    @property
    def split_distance(self) -> float:
        return float(self.items.split_distances[self.row])

    @property
    def number(self) -> int:
        """Its row in the table of the scene."""
        return int(self.items.table.numbers[self.row])


@dataclass(frozen=True, eq=False)
class Items:
    """Instances that a view draws, all of them surfels or all of them polygons.

    table, from_eye: of length n. scale: world to view units. hides_backs: (n,) bool, splats or polygons that face away
        are skipped. overlaps: (n,) of polygons, how far behind them splats still count, view units.
    split_distances: (n,) of polygons the farthest distance, of splats the least of their centres, view units; 0: no
        limit.
    step: the level of detail at which all of them are drawn whole, of `detail.steps`; None: each as its cut.
    show_nearest: whether splats do not blend, and each sample shows the nearest one.
    places: (n, 2) of those in a pool, the first triangle that is drawn of each, and their number; None for others.
    setback: minimum distance by which a visibility pass moves them back, beside `View.least_offset` and in its unit.
    """

    table: InstanceTable
    from_eye: FromEye
    scale: float
    hides_backs: np.ndarray
    overlaps: np.ndarray
    split_distances: np.ndarray
    setback: float = 0.0
    step: int | None = None
    show_nearest: bool = False
    places: np.ndarray | None = None

    def __len__(self) -> int:
        return len(self.table)

    def __iter__(self) -> Iterator[DrawItem]:
        return map(self.item, range(len(self)))

    def item(self, row: int) -> DrawItem:
        return DrawItem(self.table.placed[row], self, row)

    def taken(self, rows: np.ndarray) -> Items:
        """Some of them. rows: (m,) numbers or (n,) bool."""
        if rows.dtype == bool:
            if rows.all():
                return self
            rows = np.flatnonzero(rows)
        each = (array[rows] for array in (self.hides_backs, self.overlaps, self.split_distances))
        table = self.table.taken(rows)
        return Items(table, self.from_eye.taken(rows, table), self.scale, *each, self.setback)

    def of_kinds(self, which: Callable[[Placed], bool]) -> Items:
        """The items of those kinds for which a function of one instance is true."""
        return self.taken(self.table.of_kinds(which))

    @property
    def key(self) -> bytes:
        """A key that is equal for equal items of one scene, seen from one place."""
        places = np.zeros(0) if self.places is None else self.places
        each = self.table.numbers, self.hides_backs, self.overlaps, self.split_distances, np.array(self.scale), places
        return b"".join(array.tobytes() for array in each)

    @cached_property
    def nearest(self) -> np.ndarray:
        """(n,) least depth of each one's box, world units."""
        return -self.from_eye.corners[..., 2].max(axis=1)


@dataclass(frozen=True, eq=False)
class View:
    """scale: world to view units, a power of two. near: the camera's, scaled; the clip range may be narrower.
    first, far: the clip range, scaled.
    projection: (4, 4) float64 for scaled view space. outside: instances that cannot touch the picture.
    degenerate: instances whose matrix flattens space, so that they have no normals.
    depth_span: how many times the resolution of float32 the hardware's depth resolves at its farthest: far / near, of
        an orthographic camera far - near in view units.
    bounds: left, bottom, right, top in pixels outside of which nothing is; None if that is not known.
    contact: maximum depth of polygons behind splats of the same surface.
    """

    scale: float
    near: float
    first: float
    far: float
    projection: np.ndarray
    placed: Items
    polygons: Items
    outside: int
    degenerate: int
    depth_span: float
    bounds: tuple[float, float, float, float] | None
    contact: float

    def least_offset(self, linear_depth: bool) -> float:
        """The offset that moves a splat back by a few steps of the depth buffer: a fraction of its distance, or for an
        orthographic camera a length in view units."""
        return _LEAST_STEPS / 2**24 * (1.0 if linear_depth else self.depth_span)


def build_view(
    table: InstanceTable,
    camera: Camera,
    epsilon: float,
    whole: ClipRange | None = None,
    are_split: bool = True,
    epsilon_length: float = 0.0,
    seen: Seen | None = None,
) -> View:
    """Instances as seen by this camera. epsilon: how far visibility moves splats back, in radii, and
    epsilon_length on top of that, world units.

    whole: clip range of the camera that this one is cropped from, if any, so that depths are rounded alike in all parts
        of a picture.
    are_split: whether split objects are polygons near this camera and surfels beyond; they cast shadows as both. seen:
        what `seen_by` finds, if it is known.
    """
    seen = seen or seen_by(table, camera)
    near, far, scale = whole or clipped(camera, seen, epsilon, epsilon_length)
    own, from_eye = seen.table, seen.from_eye
    begin = _split_distances(own, from_eye, camera) if are_split else np.zeros(len(own))
    hides_backs = own.of_kinds(lambda placed: placed.is_closed) & (seen.depths >= camera.near).all(axis=1)
    grains = table.overlaps[np.searchsorted(table.numbers, own.numbers)]
    overlaps = (epsilon * grains + epsilon_length * (grains > 0)) * scale
    items = Items(own, from_eye, scale, hides_backs, overlaps, begin * scale)
    are_surfels = own.of_kinds(lambda placed: isinstance(placed.shape, Surfels))
    return View(
        scale=scale,
        near=camera.near * scale,
        first=near * scale,
        far=far * scale,
        projection=scaled_projection(camera, near, far, scale),
        placed=items.taken(are_surfels & ~np.isnan(begin)),
        polygons=items.taken(~are_surfels & ~np.isnan(begin)),
        outside=seen.outside,
        degenerate=seen.degenerate,
        depth_span=(far - near) * scale if camera.is_orthographic else far / near,
        bounds=picture_bounds(seen, camera),
        contact=(1 + 4 * epsilon) * float(table.overlaps.max(initial=0.0)) * scale,
    )


def _split_distances(table: InstanceTable, from_eye: FromEye, camera: Camera) -> np.ndarray:
    """(n,) the distance at which an instance begins or ends, world units; 0 if it is seen everywhere, NaN if nowhere.

    Splats begin before polygons end, so that their weights sum to 1 or more where polygons end (Guennebaud et al. 2006,
    section 5.1).
    """
    found = np.zeros(len(table))
    are_split = table.of_kinds(lambda placed: placed.is_split and not placed.shape.is_transparent)
    if not are_split.any():
        return found
    own, corners = table.taken(are_split), from_eye.corners[are_split]
    nearest, farthest = _distances(corners, camera)
    end = np.where(np.isnan(own.splits[:, 0]), ends_of_lengths(own.splits[:, 1], camera), own.splits[:, 0])
    of_polygons = np.where((nearest > end) | (end == 0), np.nan, np.where(farthest > end, end, 0.0))
    begin = np.maximum(end - SPLIT_OVERLAP * own.radii, 0.0)
    of_surfels = np.where(farthest < begin, np.nan, np.where(nearest < end, begin, 0.0))
    are_surfels = own.of_kinds(lambda placed: isinstance(placed.shape, Surfels))
    found[are_split] = np.where(are_surfels, of_surfels, of_polygons)
    return found


def _distances(corners: np.ndarray, camera: Camera) -> tuple[np.ndarray, np.ndarray]:
    """(n,) bounds on the distances of what is in boxes from the camera, along the view of a parallel one; world
    units."""
    if camera.is_orthographic:
        return -corners[..., 2].max(axis=1), -corners[..., 2].min(axis=1)
    nearest = np.clip(0.0, corners.min(axis=1), corners.max(axis=1))
    return np.linalg.norm(nearest, axis=1), np.linalg.norm(corners, axis=2).max(axis=1)


def ends_of_lengths(lengths: np.ndarray, camera: Camera) -> np.ndarray:
    """(n,) the distances up to which objects with these `split_length`s are polygons, world units; infinite, or 0, if a
    parallel camera shows all of them in one form."""
    pixels = lengths * camera.pixels_per_unit()
    return pixels if not camera.is_orthographic else np.where(pixels > 1, np.inf, 0.0)


def split_distances(placed: DrawItem) -> tuple[float, float] | None:
    """Where the surfels of a split object begin, and where its polygons end, world units; None if all are shown."""
    if not placed.split_distance:
        return None
    begin = placed.split_distance / placed.items.scale
    return begin, begin + SPLIT_OVERLAP * placed.instance.radius


def scaled_projection(camera: Camera, near: float, far: float, scale: float) -> np.ndarray:
    """(4, 4) float64 projection of view space times `scale`."""
    matrix = camera.projection(near, far)
    if camera.is_orthographic:
        matrix[:3, :3] /= scale
    else:
        matrix[2, 3] *= scale
    return matrix
