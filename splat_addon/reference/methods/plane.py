# SPDX-License-Identifier: GPL-3.0-or-later
"""The numpy twin of shaders/lib/plane.glsl and place.glsl: one splat's plane as the picture shows it.

Positions and axes are in view space (looking down -Z); depth counts forwards. A picture point is x / z, y / z
(perspective) or x, y (parallel cameras).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True, eq=False)
class Plane:
    """center: (2,) of the splat in the picture. a, b: (2,) what its half-axes move it. gh: (2,) relative and slope:
    (2,) absolute change of depth along them. depth: at the centre. gradient: (2,) change of depth with the picture
    point. radius: the longer half-axis. scale: picture units per view unit at the centre. normal: (3,).
    """

    center: np.ndarray
    a: np.ndarray
    b: np.ndarray
    gh: np.ndarray
    slope: np.ndarray
    depth: float
    gradient: np.ndarray
    radius: float
    scale: float
    normal: np.ndarray


def projected_ellipse(plane: Plane, pixel: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The exact projection of the splat's ellipse, before the eye: half-axes as the columns of a (2, 2), their lengths
    in pixels (2,), and its centre (2,) in the picture.
    """
    spread = 1 - plane.gh @ plane.gh
    offset = -(plane.a * plane.gh[0] + plane.b * plane.gh[1]) / spread
    columns = np.stack([plane.a / spread**0.5, plane.b / spread**0.5, offset], axis=1) / pixel[:, None]
    axes, sizes, _ = np.linalg.svd(columns)
    return axes, sizes, plane.center + offset


def in_footprint(plane: Plane, points: np.ndarray, pixel: np.ndarray, grown, end: float = 1.0) -> np.ndarray:
    """(M,) bool: which points are in the footprint. It is an ellipse or, if `end` is above 1, the part of the triangle
    around it within `end` times the ellipse. grown: function from the half-axes of the projected ellipse to those of
    the footprint, (2,), in pixels."""
    axes, size, middle = projected_ellipse(plane, pixel)
    x, y = ((((points - middle) / pixel) @ axes / grown(size)) @ axes.T).T
    return (x >= -1) & (x + 3**0.5 * abs(y) <= 2) & (x * x + y * y <= end**2)


@dataclass(frozen=True, eq=False)
class Places:
    """Where M picture points lie in the plane: uv (M, 2) in half-axes, k (M,) depth over the centre's, det (M,),
    d (M, 2) from the centre in the picture."""

    uv: np.ndarray
    k: np.ndarray
    det: np.ndarray
    d: np.ndarray


def splat_plane(position, axis_u, axis_v, is_orthographic: bool = False) -> Plane:
    """position, axes: (3,) view space, in front of the eye."""
    position, axis_u, axis_v = (np.asarray(a, np.float64) for a in (position, axis_u, axis_v))
    depth = -position[2]
    slope = -np.array([axis_u[2], axis_v[2]])
    scale = 1.0 if is_orthographic else 1.0 / depth
    center = position[:2] * scale
    gh = np.zeros(2) if is_orthographic else slope * scale
    a, b = axis_u[:2] * scale - center * gh[0], axis_v[:2] * scale - center * gh[1]
    det = a[0] * b[1] - a[1] * b[0]
    with np.errstate(divide="ignore", invalid="ignore"):
        gradient = np.array([slope[0] * b[1] - slope[1] * a[1], slope[1] * a[0] - slope[0] * b[0]]) / det
    radius = max(np.linalg.norm(axis_u), np.linalg.norm(axis_v))
    return Plane(center, a, b, gh, slope, depth, gradient, radius, scale, np.cross(axis_u, axis_v))


def places(plane: Plane, points: np.ndarray) -> Places:
    """Guennebaud et al. 2006, section 3, relative to the centre. points: (M, 2)."""
    (ax, ay), (bx, by), (g, h) = plane.a, plane.b, plane.gh
    d = points - plane.center
    dx, dy = d.T
    with np.errstate(divide="ignore", invalid="ignore"):
        det = ax * by - ay * bx - dx * (g * by - h * ay) - dy * (h * ax - g * bx)
        uv = np.stack([dx * by - dy * bx, ax * dy - ay * dx], axis=1) / det[:, None]
    return Places(uv, 1 + uv @ plane.gh, det, d)


def gradients(plane: Plane, at: Places, pixel: np.ndarray) -> np.ndarray:
    """(M, 2, 2) d(uv) / d(pixel). pixel: (2,) its size in the picture."""
    (ax, ay), (bx, by), (g, h) = plane.a, plane.b, plane.gh
    dx, dy = at.d.T
    rows = np.array([[by - h * dy, -(bx - h * dx)], [-(ay - g * dy), ax - g * dx]])
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.moveaxis(rows * (at.k / at.det), -1, 0) * pixel


def plane_depth(plane: Plane, at: Places, pixel: np.ndarray, filter_pixels: float, furthest: float = 16) -> np.ndarray:
    """(M,) depth of the plane, clamped near the splat. furthest: from the depths of its ellipse, in radii."""
    steepest = np.linalg.norm(plane.gradient * pixel)
    reach = np.linalg.norm(plane.slope) + min(2 * filter_pixels * steepest, furthest * plane.radius)
    depth = np.clip(plane.depth + at.uv @ plane.slope, plane.depth - reach, plane.depth + reach)
    return np.where(at.k > 0, depth, plane.depth)


def near_clipped_samples(position, axis_u, axis_v, points: np.ndarray, is_orthographic: bool, is_kept=None):
    """(M,) weights, unfiltered, and (M,) depths of a splat that reaches the near plane, wherever its centre lies.

    is_kept: of (M, 2) places in half-axes, (M,) bool: those that no clip line takes away.

    Guennebaud et al. 2006, equation 5: (u w, v w, w) = adj(M) direction. The twin of
    shaders/features/near_clipped.glsl.
    """
    forward = np.array((1.0, 1.0, -1.0))
    p, s, t = (np.asarray(a, np.float64) * forward for a in (position, axis_u, axis_v))
    directions = np.concatenate([points, np.ones((len(points), 1))], axis=1)
    if is_orthographic:
        p = p - np.concatenate([points, np.zeros((len(points), 1))], axis=1)
        directions = np.broadcast_to((0.0, 0.0, 1.0), directions.shape)
    p = np.broadcast_to(p, directions.shape)
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        w = directions @ np.cross(s, t)
        u, v = ((c * directions).sum(axis=1) / w for c in (np.cross(t, p), np.cross(p, s)))
        rho2 = u * u + v * v
        ends = rho2 <= 1 if is_kept is None else (rho2 <= 1) & is_kept(np.stack([u, v], axis=1))
        return np.where(ends, np.exp(-2 * rho2), 0.0), p @ np.cross(s, t) / w
