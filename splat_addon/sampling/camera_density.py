# SPDX-License-Identifier: GPL-3.0-or-later
"""Finds the spacing for one camera and resolution from the visible point of the surface that is closest to the camera.

A coarse sampling stands in for the surface. This gives a floor under the camera or a room around it its true distance,
and is cheap enough for every redraw of a panel.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .density import grid_spacing, mean_width
from .mesh.cleaning import drop_unusable
from .mesh.triangle_mesh import TriangleMesh
from .options import PLAIN
from .sample import sample_mesh

#: Cells along the longest edge for the outline, and the maximum distance, in cells, from a surface point to the outline
#: (up to 1.4 on the armadillo).
_OUTLINE_RESOLUTION = 96
_OUTLINE_REACH = 1.5

#: More than the relative error of what is computed of a few coordinates.
_ROUNDING = 1e-12


class NotSeenError(ValueError):
    """No part of the surface is in the camera's view."""


@dataclass(frozen=True, eq=False)
class Outline:
    """(n, 3) points, object units; every point of the surface lies within `reach` of one of them. width: `mean_width`
    of the mesh."""

    points: np.ndarray
    reach: float
    width: float


def outline(mesh: TriangleMesh) -> Outline:
    """The outline of the usable triangles; without points if there are none."""
    mesh, _ = drop_unusable(mesh)
    if not len(mesh):
        return Outline(np.zeros((0, 3)), 0.0, 0.0)
    spacing = grid_spacing(mesh, resolution=_OUTLINE_RESOLUTION)
    surfels = sample_mesh(mesh, spacing=spacing, **PLAIN)
    return Outline(surfels.origin + surfels.positions, _OUTLINE_REACH * spacing, mean_width(mesh))


def camera_spacing(
    surface: Outline,
    pixels: float,
    *,
    object_to_view: np.ndarray,
    window: tuple[float, float, float, float],
    size: tuple[int, int],
    near: float,
    is_orthographic: bool,
) -> float:
    """Spacing, object units, at which surfels are `pixels` apart in the picture where the surface is closest to the
    camera, and less elsewhere.

    object_to_view: (4, 4) from object units to the camera's space, which looks down -Z.
    window: left, right, bottom, top of the picture, as in `Camera`: on the plane at distance 1, or for an orthographic
        camera in world units.
    size: width and height of the picture in pixels. near: clip distance, world units.

    Raises ValueError if `pixels` is not a finite number above 0, and NotSeenError if the camera does not see the
    surface.
    """
    if not (np.isfinite(pixels) and pixels > 0):
        raise ValueError(f"The pixels a surfel covers must be a finite number above 0, not {pixels}.")
    linear, translation = object_to_view[:3, :3], object_to_view[:3, 3]
    stretch = float(np.linalg.norm(linear, 2))
    reach = surface.reach * stretch
    x, y, z = linear @ surface.points.T + translation[:, None]
    depth = -z
    seen = _are_seen(x, y, depth, reach, window, near, is_orthographic)
    if not seen.any():
        raise NotSeenError("The camera does not see the object; turn it there, or choose another density.")
    pixel = _pixel(window, size)
    distance = 1.0 if is_orthographic else max(float(depth[seen].min()) - reach, near)
    return pixels * pixel * distance / stretch


def least_camera_spacings(
    surface: Outline,
    pixels: float,
    *,
    objects_to_view: np.ndarray,
    window: tuple[float, float, float, float],
    size: tuple[int, int],
    near: float,
    is_orthographic: bool,
) -> np.ndarray:
    """(n,) numbers that `camera_spacing` is never below, found for many places of a surface at once from a ball around
    it; infinite where the camera certainly does not see it. objects_to_view: (n, 4, 4); the rest as there."""
    linear, translation = objects_to_view[:, :3, :3], objects_to_view[:, :3, 3]
    stretches = np.linalg.svd(linear, compute_uv=False)[:, 0]
    if not len(surface.points):
        return np.full(len(linear), np.inf)
    center = (surface.points.min(axis=0) + surface.points.max(axis=0)) / 2
    x, y, z = (linear @ center + translation).T
    reach = (surface.reach + np.linalg.norm(surface.points - center, axis=1).max()) * stretches
    reach += _ROUNDING * (reach + np.abs((x, y, z)).max(axis=0))
    distance = 1.0 if is_orthographic else np.maximum(-z - reach, near)
    with np.errstate(divide="ignore"):
        least = pixels * _pixel(window, size) * distance / stretches
    return np.where(_are_seen(x, y, -z, reach, window, near, is_orthographic), least, np.inf)


def _pixel(window: tuple[float, float, float, float], size: tuple[int, int]) -> float:
    left, right, bottom, top = window
    return min((right - left) / size[0], (top - bottom) / size[1])


def _are_seen(x, y, depth, reach, window: tuple[float, float, float, float], near: float, is_orthographic: bool):
    """(n,) bool: whether something within reach of points may be in the picture."""
    seen = depth > near - reach
    left, right, bottom, top = window
    for across, low, high in ((x, left, right), (y, bottom, top)):
        seen &= _beside(across, depth, low, is_orthographic) > -reach
        seen &= _beside(across, depth, high, is_orthographic) < reach
    return seen


def _beside(across: np.ndarray, depth: np.ndarray, edge: float, is_orthographic: bool) -> np.ndarray:
    """(n,) signed distance from the side plane of the view through `edge` of the window."""
    return across - edge if is_orthographic else (across - edge * depth) / np.hypot(1, edge)
