# SPDX-License-Identifier: GPL-3.0-or-later
"""Moves and tilts splats so that they fit the samples around them.

A splat in the plane of its triangle sticks out of silhouettes: by k r^2 / 2 at its rim where the surface has curvature
k, and by more where triangles are smaller than splats, as on scans. Here its plane becomes that of least squares
through the sample and its neighbours (`image_samples`). What lies beyond a clip line is another piece of surface. A
line keeps slightly more of a splat that has moved, because it no longer ends exactly where its neighbour does.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import numpy as np

from ...clip_lines import CLIP_FIELDS, CUT, are_reflex, unpack_lines
from ...quaternions import axes_columns
from ...workers import in_order
from ..attributes.blend_depths import LEAST_BLENDING
from ..ldc.grid import Grid
from ..mesh.triangle_mesh import triangle_chunks
from ..table import SampleTable
from .image_samples import SAME_SIDE, ImageSamples

#: How far off a sample's plane neighbours may be, in cells.
_FARTHEST = np.float32(0.9)

#: How much the triangle's own plane counts: for the offset as much as this many neighbours, and for the tilt as much as
#: this many at a distance of one cell.
_OWN_PLACE, _OWN_TILT = np.float32(1), np.float32(1)

#: Weight of a neighbour in the next column or row, and of a diagonal one.
_WEIGHT, _DIAGONAL = np.float32(1), np.float32(0.7)

#: The steepest tilt, as a slope.
_STEEPEST = np.float32(0.5)

#: Samples per batch: at least, so that operations take longer than their calls, and at most, so that they stay in the
#: processor's cache; and batches in between, so that threads are equally busy.
_LEAST, _MOST, _BATCHES = 2048, 32768, 12

#: The share of the time that it takes to find neighbours.
_FINDING = 0.4

#: A line cuts less by this share of the offset and the slope of its splat.
_KEPT = 0.5


def fit_planes(
    arrays: SampleTable,
    images: list[tuple[int, slice]],
    inside: np.ndarray,
    grid: Grid,
    is_closed: bool,
    report: Callable[[float], None] = lambda share: None,
) -> SampleTable:
    """The fields of `Surfels` that change: positions, rotations and clip lines.

    arrays: samples with blend depths, which tell where the surface bends; positions relative to the grid's middle.
    images: the samples of each image. inside: (N,) from `inside_triangles`: samples that have all their neighbours in
    their own triangle lie in the plane that fits these, and keep it. is_closed: whether the mesh has no open border;
    where it has, a line may be one, beyond which nothing could hide what sticks out. report: called between steps with
    the finished share, 0 to 1.
    """
    # Where a triangle bends, those that its surface goes on in do, too.
    bent = np.flatnonzero((arrays["blend_depth"] > LEAST_BLENDING) & (inside < 2))
    if not len(bent):
        return {}
    changed = {name: arrays[name].copy() for name in ("positions", "rotations", *CLIP_FIELDS) if name in arrays}
    is_cut = np.zeros(len(arrays["positions"]), bool)
    for name in CLIP_FIELDS:
        if name in arrays:
            is_cut |= arrays[name][:, 1] > 0
    seen = _seen(arrays, images, bent, grid.spacing, report)

    def fit(image: ImageSamples, part: np.ndarray) -> int:
        """Fit the planes of these samples, in place; returns how many there are."""
        rows = bent.take(image.rows[part])
        at = np.flatnonzero(is_cut.take(rows))
        cut = rows.take(at)
        scales = arrays["scales"].take(cut, axis=0)
        lines = _Lines(changed, rows, at, scales / np.float32(grid.spacing))
        sums = _Fit(image, part, lines)
        for another in seen:
            if another is not image:
                sums.add_from(another)
        offset, slope = sums.solve()
        _move(changed, rows, [n[part] for n in image.along_axes(*image.normals)], offset, slope, grid.spacing)
        offset, slope = offset.take(at), slope.take(at, axis=1)
        moved = np.abs(offset) + np.sqrt((slope * slope).sum(axis=0))
        less = (sums.goes_on.take(at) | is_closed) * (_KEPT * moved * grid.spacing)
        # The first half-axis is the larger one (`ellipse_scales`).
        _cut_less(changed, cut, less / scales[:, 0])
        return len(rows)

    to_fit = [np.flatnonzero(inside.take(bent.take(image.rows)) == 0) for image in seen]
    total, done = max(sum(map(len, to_fit)), 1), 0
    size = min(max(total // _BATCHES, _LEAST), _MOST)
    parts = (
        (image, some[part])
        for image, some in zip(seen, to_fit, strict=True)
        for part in triangle_chunks(len(some), size)
    )
    for count in in_order(partial(fit, *part) for part in parts):
        done += count
        report(_FINDING + (1 - _FINDING) * done / total)
    return changed


def _seen(arrays, images, bent: np.ndarray, spacing: float, report: Callable[[float], None]) -> list[ImageSamples]:
    """The samples with these numbers in each image that has any. arrays, images, report: as in `fit_planes`."""
    places, normals = _places_and_normals(arrays, bent, spacing)
    spans = [(axis, slice(*np.searchsorted(bent, (rows.start, rows.stop)).tolist())) for axis, rows in images]
    seen, done = [], 0
    for image in in_order(partial(ImageSamples, places, normals, *s) for s in spans if s[1].stop > s[1].start):
        seen.append(image)
        done += len(image)
        report(_FINDING * done / len(bent))
    return seen


def _places_and_normals(arrays: SampleTable, rows: np.ndarray, spacing: float):
    """(3, n) float32 places in cells from the grid's middle, and (3, n) unit normals of planes."""
    places, normals = np.empty((2, 3, len(rows)), np.float32)
    for part in triangle_chunks(len(rows)):
        some = rows[part]
        np.multiply(arrays["positions"].take(some, axis=0).T, np.float32(1 / spacing), out=places[:, part])
        normals[:, part] = axes_columns(arrays["rotations"].take(some, axis=0), 2)[0]
    return places, normals


class _Lines:
    """Which offsets from n samples the lines of c of them keep. at: (c,) which have lines. clipped: (n,) index among
    these, or -1. covectors: (2, 4, c), above 0 at offsets in cells, and 1, on the kept side. reflex: (c,) whether one
    line's side is enough."""

    def __init__(self, arrays: SampleTable, rows: np.ndarray, at: np.ndarray, sizes: np.ndarray):
        """sizes: (c, 2) half-axes, in cells."""
        self.at, cut = at, rows.take(at)
        self.clipped = np.full(len(rows), -1, np.intp)
        self.clipped[at] = np.arange(len(at))
        none = np.zeros((len(at), 2), np.int16)
        packed = [arrays[name].take(cut, axis=0) if name in arrays else none for name in CLIP_FIELDS]
        self.reflex = are_reflex(*packed)
        x, y = axes_columns(arrays["rotations"].take(cut, axis=0), 0, 1)
        half_axes = x / sizes[:, 0], y / sizes[:, 1]
        self.covectors = np.empty((2, 4, len(self.at)), np.float32)
        for covector, line in zip(self.covectors, packed, strict=True):
            a, b, c = unpack_lines(line).T
            covector[:3], covector[3] = a * half_axes[0] + b * half_axes[1], c


def _are_kept(covectors: np.ndarray, reflex: np.ndarray, offsets) -> np.ndarray:
    """(m,) bool, by `_Lines` of m surfels. offsets: three of (m,), in cells along x, y and z."""
    x, y, z = offsets
    one, other = (a * x + b * y + c * z + d >= 0 for a, b, c, d in covectors)
    return (one & other) | (reflex & (one | other))


class _Fit:
    """Planes of least squares through n samples of an image and their neighbours, as sums over the latter.

    part: numbers of the samples in the image. lines: their own clip lines, beyond which neighbours do not count.
    goes_on: (n,) whether there are any beyond a line, which then is no open border.
    """

    def __init__(self, image: ImageSamples, part: np.ndarray, lines: _Lines):
        self._image, self._lines, self._next_axes = image, lines, image.next_axes(part)
        self._places, self._normals = ([row[part] for row in rows] for rows in (image.places, image.normals))
        self._depth = image.depth[part]
        count = len(self._depth)
        self._weight, self._height = np.zeros(count, np.float32), np.zeros(count, np.float32)
        self._squares, self._rises = np.zeros((2, count), np.float32), np.zeros((2, count), np.float32)
        self.goes_on = np.zeros(count, bool)
        self._neighbours = image.neighbours(part)
        for step, neighbour in self._neighbours.items():
            self._add(step, neighbour)

    def _add(self, step: tuple[int, int], neighbour: np.ndarray):
        """Add what the image has at this step from the samples. neighbour: (n,) by number in the image, or -1."""
        image = self._image
        rise = image.depth.take(neighbour)
        rise -= self._depth
        u, v, a = self._normals
        height = a * rise
        for along, component in zip(step, (u, v), strict=True):
            if along:
                (np.add if along > 0 else np.subtract)(height, component, out=height)
        is_there = neighbour >= 0
        is_there &= np.abs(height) <= _FARTHEST
        at = self._lines.at
        offset = image.along_axes(np.float32(step[0]), np.float32(step[1]), rise.take(at))
        kept = _are_kept(self._lines.covectors, self._lines.reflex, offset)
        self.goes_on[at] |= is_there[at] & ~kept
        is_there[at] &= kept
        weight = is_there * (_DIAGONAL if all(step) else _WEIGHT)
        height *= weight
        self._weight += weight
        self._height += height
        for along, square, rise in zip(step, self._squares, self._rises, strict=True):
            if along:
                square += weight
                (np.add if along > 0 else np.subtract)(rise, height, out=rise)

    def add_from(self, other: ImageSamples):
        """Add neighbours that another image has at the steps where this one has none."""
        image, lines = self._image, self._lines
        is_next = self._next_axes == other.axis
        missing = [np.flatnonzero(is_next & (self._neighbours[step] < 0)) for step in image.STEPS]
        at = np.concatenate(missing)
        u, v = np.repeat(np.array(image.STEPS, np.float32), [len(m) for m in missing], axis=0).T
        own, normals = ([row.take(at) for row in rows] for rows in (self._places, self._normals))
        steps = image.along_axes(u, v, image.rise((u, v), normals))
        found = other.nearest(*(place + step for place, step in zip(own, steps, strict=True)))
        alike = image.in_order(*(n.take(found) for n in other.along_axes(*other.normals)))
        is_alike = sum(one * its for one, its in zip(normals, alike, strict=True)) >= SAME_SIDE
        way = [place.take(found) - mine for place, mine in zip(other.places, own, strict=True)]
        along = image.in_order(*way)
        height = sum(one * step for one, step in zip(normals, along, strict=True))
        is_alike &= (found >= 0) & (np.abs(height) <= _FARTHEST)
        clipped = lines.clipped.take(at)
        some = np.flatnonzero(is_alike & (clipped >= 0))
        clipped = clipped.take(some)
        its = lines.covectors.take(clipped, axis=2), lines.reflex.take(clipped)
        kept = _are_kept(*its, [w.take(some) for w in way])
        self.goes_on[at.take(some)] |= ~kept
        is_alike[some] = kept
        u, v, _ = along
        sums = np.stack([np.ones_like(height), height, u * u, v * v, u * height, v * height])
        keep = np.flatnonzero(is_alike)
        at, sums = at.take(keep), sums.take(keep, axis=1)
        for target, values in zip((self._weight, self._height, *self._squares, *self._rises), sums, strict=True):
            target += np.bincount(at, values, len(target)).astype(np.float32)

    def solve(self) -> tuple[np.ndarray, np.ndarray]:
        """(n,) offsets along the normals, in cells, and (3, n) slopes against the planes of the samples."""
        image = self._image
        rises = [rise / (square + _OWN_TILT) for rise, square in zip(self._rises, self._squares, strict=True)]
        u, v, a = self._normals
        across = rises[0] * u + rises[1] * v
        slope = np.stack(image.along_axes(rises[0] - across * u, rises[1] - across * v, -across * a))
        steepness = np.sqrt((slope * slope).sum(axis=0))
        slope *= np.minimum(1, _STEEPEST / np.maximum(steepness, np.float32(1e-9)))
        return self._height / (self._weight + _OWN_PLACE), slope


def _move(changed, rows: np.ndarray, normals: list[np.ndarray], offset: np.ndarray, slope: np.ndarray, spacing: float):
    """Give samples with these normals planes that are off theirs by (n,) `offset`, in cells, and have a (3, n) `slope`
    against them."""
    offset = offset * np.float32(spacing)
    positions = changed["positions"].take(rows, axis=0)
    for column, component in zip(positions.T, normals, strict=True):
        column += component * offset
    changed["positions"][rows] = positions
    # The shortest turn from the normal n to n - slope.
    (sx, sy, sz), (nx, ny, nz) = slope, normals
    x, y, z = sy * nz - sz * ny, sz * nx - sx * nz, sx * ny - sy * nx
    steepness = sx * sx + sy * sy + sz * sz
    w = 1 + np.sqrt(1 + steepness)
    a, b, c, d = np.ascontiguousarray(changed["rotations"].take(rows, axis=0).T)
    turned = (
        w * a - x * b - y * c - z * d,
        w * b + x * a + y * d - z * c,
        w * c - x * d + y * a + z * b,
        w * d + x * c - y * b + z * a,
    )
    length = np.sqrt(w * w + x * x + y * y + z * z)
    rotations = np.empty((len(rows), 4), np.float32)
    for column, values in zip(rotations.T, turned, strict=True):
        np.divide(values, length, out=column)
    changed["rotations"][rows] = rotations


def _cut_less(changed: SampleTable, rows: np.ndarray, less: np.ndarray):
    """Let the lines of (n,) cut surfels cut less, by (n,) half-axes; none goes."""
    for name in CLIP_FIELDS:
        if name in changed:
            cut = changed[name].take(rows, axis=0)[:, 1]
            changed[name][rows, 1] = np.where(cut > 0, np.maximum(cut - less * CUT, 1), 0).astype(np.int16)
