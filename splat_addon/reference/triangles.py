# SPDX-License-Identifier: GPL-3.0-or-later
"""`render_triangles`: the picture of a mesh itself, the reference for pictures of its surfels.

Float64, many samples a pixel, unlit: each sample shows the nearest triangle's interpolated corner colours. It shares
nothing with the sampling of surfels, with the renderer or with `render_exact` but the camera and the pixel filter.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ..rendering.scene.camera import Camera
from ..runs import expand
from .filters import filter_weights, resample

#: Triangle-sample pairs per batch: about 100 bytes each.
CHUNK_PAIRS = 1_000_000

#: Where depths differ by less than this share, the triangle that faces the viewer is seen.
SAME_DEPTH = 1e-6

#: Samples of a strip of the picture.
STRIP_SAMPLES = 2_000_000


@dataclass(frozen=True, eq=False)
class TrianglePicture:
    """color: (h, w, 3) scene-linear over black, filtered. coverage: (h, w) filtered alike, 0 to 1.
    share: (h, w) of each pixel's own samples that hit. Row 0 is at the bottom."""

    color: np.ndarray
    coverage: np.ndarray
    share: np.ndarray


def render_triangles(
    corners: np.ndarray,
    colors: np.ndarray,
    camera: Camera,
    *,
    samples: int = 8,
    pixel_filter: str = "gaussian",
    shade: Callable[[np.ndarray], np.ndarray] = lambda values: values,
) -> TrianglePicture:
    """The picture of triangles by definition.

    corners: (T, 3, 3) world space. colors: (T, 3, 3) scene-linear, at the corners. Both sides are seen; of the two
        sides of a card, which are in the same place, the one that faces the viewer.
    shade: makes (n, 3) colours of what the samples interpolate, such as normals in even light.
    samples: samples x samples rays a pixel, at (i + 0.5) / samples. pixel_filter: a name in `filters.PIXEL_FILTERS`.

    A sample is inside where the three barycentric coordinates of the projected triangle are 0 or more (Pineda, "A
    Parallel Algorithm for Polygon Rasterization", 1988); 1 / depth and colour / depth are linear in the picture.
    Raises ValueError for triangles that reach before the near plane, which this does not clip.
    """
    points, over_depth = _projected(np.asarray(corners, np.float64), camera)
    weights = filter_weights(pixel_filter, samples)
    margin = (len(weights) // samples - 1) // 2
    width, height = camera.size
    columns = (width + 2 * margin) * samples
    strip = max(STRIP_SAMPLES // (columns * samples) - 2 * margin, 1)
    left, right, bottom, top = camera.window
    step = (np.array([right, top]) - (left, bottom)) / camera.size / samples
    # In samples, whose centres are then whole numbers.
    places = (points - (left, bottom)) / step - 0.5 + margin * samples
    color, share = np.empty((height, width, 4)), np.empty((height, width))
    for start in range(0, height, strip):
        rows = min(strip, height - start)
        first = np.array([0.0, start * samples])
        shape = (rows + 2 * margin) * samples, columns
        values = _samples(places - first, over_depth, np.asarray(colors, np.float64), shape)
        hit = values[..., 3] > 0
        values[hit, :3] = shade(values[hit, :3])
        color[start : start + rows] = resample(values, weights, samples)
        inner = values[margin * samples :, margin * samples :, 3][: rows * samples, : width * samples]
        share[start : start + rows] = inner.reshape(rows, samples, width, samples).mean(axis=(1, 3))
    return TrianglePicture(color[..., :3], color[..., 3], share)


def _projected(corners: np.ndarray, camera: Camera) -> tuple[np.ndarray, np.ndarray]:
    """(T, 3, 2) places on the window's plane, and (T, 3) numbers that are linear in the picture and largest nearest to
    the eye: 1 / depth, or minus the depth for parallel views."""
    to_view = camera.world_to_view()
    eye = corners @ to_view[:3, :3].T + to_view[:3, 3]
    depth = -eye[..., 2]
    if depth.size and not depth.min() >= camera.near:
        raise ValueError(
            f"A corner lies {depth.min():g} before the camera and its near plane at {camera.near:g}; step back."
        )
    if camera.is_orthographic:
        return eye[..., :2], -depth
    return eye[..., :2] / depth[..., None], 1 / depth


def _samples(places: np.ndarray, over_depth: np.ndarray, colors: np.ndarray, shape: tuple[int, int]) -> np.ndarray:
    """(rows, columns, 4) colour and 1 of the nearest triangle at each sample, 0 where there is none."""
    shares = _share_planes(places)
    depths = np.einsum("tkc,tk->tc", shares, over_depth)
    (x1, y1), (x2, y2) = ((places[:, k] - places[:, 0]).T for k in (1, 2))
    depths += (x1 * y2 > x2 * y1)[:, None] * SAME_DEPTH * np.abs(depths)
    nearest, owner = np.full(shape[0] * shape[1], -np.inf), np.full(shape[0] * shape[1], -1)
    for triangle, row, first, count in _spans(places, shares, shape):
        span, column = expand(count)
        column += first[span]
        at = row[span] * shape[1] + column
        per_column, at_row = depths[triangle, 0], depths[triangle, 1] * row + depths[triangle, 2]
        near = per_column[span] * column + at_row[span]
        np.maximum.at(nearest, at, near)
        won = np.flatnonzero(near == nearest[at])
        owner[at[won]] = triangle[span[won]]
    hit = np.flatnonzero(owner >= 0)
    values = np.zeros((len(owner), 4))
    for part in np.array_split(hit, len(hit) // CHUNK_PAIRS + 1):
        row, column = np.divmod(part, shape[1])
        triangle = owner[part]
        planes = shares[triangle]
        share = planes[..., 0] * column[:, None] + planes[..., 1] * row[:, None] + planes[..., 2]
        if over_depth.min(initial=1) > 0:  # perspective
            share *= over_depth[triangle]
        share /= share.sum(axis=1, keepdims=True)
        values[part, :3] = np.einsum("nk,nkc->nc", share, colors[triangle])
        values[part, 3] = 1
    return values.reshape(*shape, 4)


def _share_planes(places: np.ndarray) -> np.ndarray:
    """(T, 3, 3) coefficients p of the barycentric coordinates p0 column + p1 row + p2; not finite for a
    triangle without area.
    """
    (x, y), planes = np.moveaxis(places, 2, 0), np.empty((len(places), 3, 3))
    for k in range(3):
        i, j = (k + 1) % 3, (k + 2) % 3
        planes[:, k] = np.stack([y[:, i] - y[:, j], x[:, j] - x[:, i], x[:, i] * y[:, j] - x[:, j] * y[:, i]], axis=1)
    with np.errstate(divide="ignore", invalid="ignore"):
        return planes / planes[:, :, 2].sum(axis=1)[:, None, None]


def _spans(places: np.ndarray, shares: np.ndarray, shape: tuple[int, int]):
    """Runs of samples inside triangles, in chunks: their triangles, rows, first columns and counts, (n,) each.

    Along a row each of the three coordinates is linear, so where all of them are 0 or more is an interval.
    """
    low = np.clip(np.ceil(places[..., 1].min(axis=1)), 0, shape[0]).astype(np.int64)
    rows = np.clip(np.floor(places[..., 1].max(axis=1)) + 1, 0, shape[0]).astype(np.int64) - low
    width = np.clip(np.ptp(places[..., 0], axis=1), 1, shape[1])
    seen = np.flatnonzero((rows > 0) & np.isfinite(shares).all(axis=(1, 2)))
    load = np.cumsum(rows[seen] * width[seen])
    for part in np.split(seen, np.flatnonzero(np.diff(load // CHUNK_PAIRS)) + 1):
        owner, row = expand(rows[part])
        triangle = part[owner]
        row += low[triangle]
        first, last = np.zeros(len(row)), np.full(len(row), shape[1] - 1.0)
        for k in range(3):
            slope, at_zero = shares[triangle, k, 0], shares[triangle, k, 1] * row + shares[triangle, k, 2]
            with np.errstate(divide="ignore", invalid="ignore"):
                root = -at_zero / slope
            first = np.where(slope > 0, np.maximum(first, root), first)
            last = np.where(slope < 0, np.minimum(last, root), last)
            last[(slope == 0) & (at_zero < 0)] = -1
        first = np.ceil(first).astype(np.int64)
        count = np.floor(last).astype(np.int64) - first + 1
        kept = np.flatnonzero(count > 0)
        yield triangle[kept], row[kept], first[kept], count[kept]
