# SPDX-License-Identifier: GPL-3.0-or-later
"""The numpy twin of shaders/features/clip_lines.glsl and lib/clipped_share.glsl: splats that end at lines."""

from __future__ import annotations

import numpy as np

from ...large_surfels import SAMPLE_SIZE
from ...rendering.methods import METHODS
from . import TWINS
from .mip import FILTER_VARIANCE, KERNEL_VARIANCE, NORMAL, NORMAL_END
from .plane import Plane, gradients, places

#: Smaller shares are 0: the approximation ends there.
LEAST_SHARE = 0.006

#: The least share within the rim that divides.
LEAST_WITHIN = 0.05

#: Half-axes between two lines; narrower strips count as that wide.
LEAST_WIDTH = 0.01

#: Half-axes squared, beyond which the pixel is too large for float precision.
LARGEST_PIXEL = 1e8


def clipped_samples(method: str, plane: Plane, points: np.ndarray, pixel: np.ndarray, lines: np.ndarray, reflex: bool):
    """(M,) weights and (M,) depths of a splat that ends at lines, computed by the method's twin.

    lines: (2, 3) of unit direction, in half-axes, as `Surfels.clip_lines` gives them.
    """
    weights, depths = TWINS[method](plane, points, pixel)
    at, reflex = places(plane, points), np.full(len(points), reflex)
    if METHODS[method].blurs_rims:
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            place = np.where(at.k[:, None] > 0, at.uv, np.inf)
            share = clipped_share(place, gradients(plane, at, pixel), lines[None], reflex)
    else:
        share = _in_picture(at, there(lines), reflex)
    return weights * share, depths


def there(lines: np.ndarray) -> np.ndarray:
    """(..., 3) lines; lines that cut nothing get no direction, because a filter reaches beyond the ellipse."""
    return np.where(lines[..., 2:] < 1, lines, (0.0, 0.0, 1.0))


def _in_picture(at, lines: np.ndarray, reflex: np.ndarray) -> np.ndarray:
    """(M,) bool: whether places are on the kept side. In the picture, lines continue beyond the plane's horizon."""
    side = np.where(at.k > 0, 1.0, -1.0)[:, None]
    homogeneous = np.concatenate([at.uv * side, side], axis=1)
    inside = np.einsum("nk,lk->nl", homogeneous, lines) >= 0
    inside |= ~lines[:, :2].any(axis=1)
    return np.where(reflex, inside.any(axis=1), inside.all(axis=1))


def clipped_share(place: np.ndarray, change: np.ndarray, lines: np.ndarray, reflex: np.ndarray) -> np.ndarray:
    """(M,) share of kernel times pixel on the kept side of the lines, over how dense kernels are there.

    place: (M, 2) positions of the pixels in half-axes, infinite beyond the plane's horizon. change: (M, 2, 2) change of
    the position per pixel along x and y. lines: (1 or M, 2, 3). reflex: (M,) bool.
    """
    middle, seen = _kernel_under_pixel(place, change)
    lines = np.broadcast_to(there(lines), (len(place), 2, 3))
    direction = lines[..., :2]
    across = np.einsum("nij,nkj->nki", seen, direction)
    deviation = np.sqrt(np.maximum(np.einsum("nki,nki->nk", direction, across), 1e-20))
    inside = (np.einsum("nki,ni->nk", direction, middle) + lines[..., 2]) / deviation
    one, other = _share_within_rim(_share_before(inside), place, middle, across, seen, deviation).T
    correlation = np.einsum("ni,ni->n", across[:, 0], direction[:, 1]) / deviation.prod(axis=1)
    both = _both_keep(one, other, correlation)
    share = np.where(reflex, one + other - both, both)
    return np.where(share > LEAST_SHARE, share / _kernel_density(inside, deviation, lines, reflex), 0.0)


def _kernel_density(inside: np.ndarray, deviation: np.ndarray, lines: np.ndarray, reflex: np.ndarray) -> np.ndarray:
    """(M,) how dense the kernels of equally spaced splats lie where a pixel sees their kept sides; 1 far from lines.

    Their centres are on that side alone, in as many rows as fit between two lines that face each other; a row that
    just fits counts in part. inside: (M, 2) distance from the lines, in deviations of kernel times pixel.
    """
    mean = 0.5 * (inside + np.sqrt(inside**2 + 8 / np.pi)) * deviation
    opposite = np.clip(-np.einsum("ni,ni->n", lines[:, 0, :2], lines[:, 1, :2]), 0, 1)
    strip = np.where(reflex, 0.0, np.arcsin(opposite) * 2 / np.pi)
    width = np.maximum(lines[..., 2].sum(axis=1), LEAST_WIDTH)
    limit = 1 + strip * (np.minimum(width / mean.sum(axis=1), 1) - 1)
    mean = np.minimum(mean * limit[:, None], 1.0)
    one = 0.5 + mean - 0.5 * mean**2
    both = one.prod(axis=1)
    beside = np.maximum(lines[..., 2], 0) * SAMPLE_SIZE
    beside = np.floor(beside) + np.maximum(beside % 1 * 10 - 9, 0)
    rows = (1 + beside.sum(axis=1)) / (SAMPLE_SIZE * width)
    return np.where(reflex, one.sum(axis=1) - both, both + strip * ((one.sum(axis=1) - 1) * rows - both))


def _share_within_rim(share, place, middle, across, seen, deviation) -> np.ndarray:
    """(M, 2) share that each line keeps of the part within the rim, from its (M, 2) share of all.

    seen: (M, 2, 2) covariance of kernel times pixel; across: (M, 2, 2) the same, taken along the lines' directions.
    """
    place = np.where(np.isfinite(place), place, 1.0)
    outward = place / np.maximum(np.linalg.norm(place, axis=1, keepdims=True), 1e-10)
    variance = np.maximum(np.einsum("ni,nij,nj->n", outward, seen, outward), 1e-20)
    beside = (1.0 - np.einsum("ni,ni->n", outward, middle)) / np.sqrt(variance)
    within = np.maximum(_share_before(beside), LEAST_WITHIN)[:, None]
    together = np.maximum(-np.einsum("nki,ni->nk", across, outward), 0.0) / deviation
    together = np.minimum(together**2 / variance[:, None], 1.0)
    return share + together * (np.minimum(share / within, 1.0) - share)


def _share_before(inside: np.ndarray) -> np.ndarray:
    """Normal distribution function of x; 1 where the approximation ends."""
    x = np.clip(inside, -NORMAL_END, NORMAL_END)
    return np.where(inside < NORMAL_END, 0.5 + x * sum(f * x ** (2 * power) for power, f in enumerate(NORMAL)), 1.0)


def _both_keep(one: np.ndarray, other: np.ndarray, correlation: np.ndarray) -> np.ndarray:
    """The share of a Gaussian on the kept side of two lines, given the share of each (Sheppard 1899, exact at the
    middle)."""
    turn = np.arcsin(np.clip(correlation, -1, 1)) * 2 / np.pi
    end = np.where(turn > 0, np.minimum(one, other), np.maximum(one + other - 1, 0))
    return one * other + np.abs(turn) * (end - one * other)


def _kernel_under_pixel(place: np.ndarray, change: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Middle (M, 2) and variance (M, 2, 2) of kernel times pixel; those of the kernel if the pixel is unbounded."""
    pixel = FILTER_VARIANCE * change @ np.swapaxes(change, 1, 2)
    kernel = KERNEL_VARIANCE * np.eye(2)
    has_end = (np.trace(pixel, axis1=1, axis2=2) < LARGEST_PIXEL) & ((place**2).sum(axis=1) < LARGEST_PIXEL)
    pixel, place = np.where(has_end[:, None, None], pixel, np.eye(2)), np.where(has_end[:, None], place, 0.0)
    joined = KERNEL_VARIANCE * np.linalg.inv(kernel + pixel)
    middle = np.einsum("nij,nj->ni", joined, place)
    seen = np.einsum("nij,njk->nik", joined, pixel)
    return np.where(has_end[:, None], middle, 0.0), np.where(has_end[:, None, None], seen, kernel)
