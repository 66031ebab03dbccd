# SPDX-License-Identifier: GPL-3.0-or-later
"""The numpy twin of shaders/methods/homogeneous.glsl: tangents lengthened to the size of the pixel's filter."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from . import quad
from .plane import Plane, places, splat_plane

FILTER_RADIUS = 2**0.5


def samples(plane: Plane, points: np.ndarray, pixel: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(M,) weights and (M,) depths at (M, 2) picture points (Guennebaud et al. 2006, equations 8 to 10)."""
    with np.errstate(divide="ignore", invalid="ignore"):
        wide = adjusted(plane, pixel)
        weights, _ = quad.samples(wide, points, pixel)
        along = plane.gradient @ np.stack([wide.a, wide.b], axis=1)
        offset = places(wide, points).uv @ along
        return weights, plane.depth + np.clip(offset, -plane.radius, plane.radius)


def adjusted(plane: Plane, pixel: np.ndarray, as_printed: bool = False) -> Plane:
    """The splat's plane with half-axes at least as long as the filter.

    In the paper's version, which is for discs, the result is 0 / 0 for a disc that faces the ray.
    """
    is_orthographic = is_parallel(plane)
    depth = 1.0 if is_orthographic else plane.depth
    position = np.array([*(plane.center / plane.scale), -plane.depth])
    if as_printed:
        normal = plane.normal / np.linalg.norm(plane.normal)
        across = np.cross(np.array((0.0, 0.0, -1.0)) if is_orthographic else position, normal)
        axes = [plane.radius * v / np.linalg.norm(v) for v in (across, np.cross(normal, across))]
    else:
        _, _, places_of_axes = np.linalg.svd(np.stack([plane.a, plane.b], axis=1) / pixel[:, None])
        axes = places_of_axes @ _axes(plane)
    axes = [_at_least_filter(axis, position, pixel, depth, is_orthographic) for axis in axes]
    return replace(splat_plane(position, *axes, is_orthographic), normal=plane.normal)


def is_parallel(plane: Plane) -> bool:
    """Whether the view is a parallel camera's; a splat without a slope is the same in both."""
    return bool(plane.scale == 1.0 and not plane.gh.any() and plane.slope.any())


def _axes(plane: Plane) -> list[np.ndarray]:
    pairs = ((plane.a, 0), (plane.b, 1))
    return [np.array([*((a + plane.center * plane.gh[k]) / plane.scale), -plane.slope[k]]) for a, k in pairs]


def _at_least_filter(axis, position, pixel, depth, is_orthographic) -> np.ndarray:
    if is_orthographic:
        across = axis[:2]
    else:
        across = (axis[:2] * depth + axis[2] * position[:2]) / (depth**2 - axis[2] ** 2)
    pixels = across / pixel
    size = np.linalg.norm(pixels)
    if 0 < size < FILTER_RADIUS:
        return np.array([*(pixels / size * FILTER_RADIUS * pixel * depth), 0.0])
    return axis
