# SPDX-License-Identifier: GPL-3.0-or-later
"""`render_ewa`: the picture as the elliptical weighted average of the papers defines it.

Scene -> `splats` (eye space) -> affine projections -> averages at the pixels' centres -> `shading` -> Frame. Zwicker,
Pfister, van Baar, Gross, "Surface Splatting", 2001: the resampling filter, equations 9 to 12; the object space form of
Ren et al. 2002 has the same kernels. The reference for method "ewa"; in the affine limit it is an independent way to
compute what `render_exact` does.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..rendering.frame import EMPTY_DEPTH, Frame
from ..rendering.scene import Scene
from ..rendering.scene.camera import Camera
from ..rendering.settings import Settings
from .clipped_kernels import TO_LINE, kernel_ends, seen_near_lines
from .exact import DEFAULTS, shaded_rays
from .rays import RayGrid, average, candidates, splats_in, visible_depth
from .splats import Splats, eye_splats, projected_bounds

#: Standard deviation of the kernel exp(-2 rho^2), in half-axes.
KERNEL_SIGMA = 0.5

#: How far outside its ellipse a splat's plane is extrapolated for its depth, in radii.
FARTHEST_RADII = 16.0


@dataclass(frozen=True, eq=False)
class Projections:
    """N splats in the picture, all (N, ...) in pixels. center: (N, 2). variance: (N, 2, 2) of kernel and filter.

    amplitude: (N,) what keeps the kernel's integral. reach: (N,) how far their depths go, world units.
    """

    center: np.ndarray
    variance: np.ndarray
    amplitude: np.ndarray
    reach: np.ndarray


def render_ewa(
    scene: Scene,
    camera: Camera,
    settings: Settings = DEFAULTS,
    *,
    filter_sigma: float | None = None,
    cutoff: float = 2.0,
) -> Frame:
    """The picture of `scene` by screen-space EWA, in float64, at one sample a pixel.

    filter_sigma: of the pixel's Gaussian, in pixels, if not the settings'; 0 leaves the low-pass out.
    cutoff: where a resampling kernel ends, in its standard deviations; 2 is where `render_exact`'s kernels end.

    A splat's projection is approximated as affine at its centre; splats with their centre in front of the near plane
    have none and are left out (`stats["left_out"]` counts them). All splats are opaque. Visibility uses the unfiltered
    splats on rays through pixel centres, as in `render_exact`; the sums are normalised and shaded once per pixel. Clip
    lines cut what hides, and end kernels as the pixel's Gaussian blurs them (`clipped_kernels`).
    """
    filter_sigma = settings.gaussian_variance**0.5 if filter_sigma is None else filter_sigma
    splats = eye_splats(scene, camera).as_asked(settings).as_opaque()
    before = -splats.center[:, 2] > (-np.inf if camera.is_orthographic else camera.near)
    grid = RayGrid.of_pixels(camera, 1, 0, 0, *camera.size)
    visibility = _visibility(splats, grid, settings.epsilon)
    splats = splats.take(np.flatnonzero(before))
    projections = project(splats, camera, filter_sigma)
    surface = average(splats, grid, _contributions(splats, projections, grid, visibility, cutoff, settings.epsilon))
    rays = shaded_rays(surface, grid, scene, camera, settings)
    depth = np.full(grid.count, EMPTY_DEPTH)
    depth[surface.rays] = surface.depth
    normal = rays[..., 4:7] @ camera.matrix_world[:3, :3].T
    arrays = rays[..., :4], depth.reshape(grid.shape), normal, rays[..., 7]
    stats = {"surfels": len(splats), "left_out": int(np.count_nonzero(~before)), "filter_sigma": filter_sigma}
    return Frame(*(a.astype(np.float32) for a in arrays), stats=stats)


def project(splats: Splats, camera: Camera, filter_sigma: float) -> Projections:
    """The affine projection of splats in front of the eye, combined with the pixel's Gaussian."""
    left, right, bottom, top = camera.window
    pixels = np.array(camera.size) / (right - left, top - bottom)
    depth = -splats.center[:, 2]
    scale = np.ones_like(depth) if camera.is_orthographic else 1 / depth
    middle = splats.center[:, :2] * scale[:, None]
    # d(picture) / d(u, v): the projection x / z differentiated at the centre.
    spread = 0.0 if camera.is_orthographic else 1.0
    axes = [(a[:, :2] + spread * middle * a[:, 2:]) * scale[:, None] * pixels for a in (splats.u, splats.v)]
    jacobian = np.stack(axes, axis=2)
    kernel = KERNEL_SIGMA**2 * jacobian @ np.swapaxes(jacobian, 1, 2)
    area = KERNEL_SIGMA**2 * np.abs(np.linalg.det(jacobian))
    # det(kernel + s^2 I) without cancellation.
    det = area**2 + filter_sigma**2 * np.trace(kernel, axis1=1, axis2=2) + filter_sigma**4
    with np.errstate(divide="ignore", invalid="ignore"):
        amplitude = np.where(det > 0, area / np.sqrt(det), 0.0)
        steepest = np.linalg.norm(_depth_gradients(splats, camera, scale), axis=1) / pixels.min()
    slope = np.hypot(splats.u[:, 2], splats.v[:, 2])
    reach = slope + np.fmin(2 * filter_sigma * steepest, FARTHEST_RADII * splats.radius())
    center = (middle - (left, bottom)) * pixels
    return Projections(center, kernel + filter_sigma**2 * np.eye(2), amplitude, reach)


def _depth_gradients(splats: Splats, camera: Camera, scale: np.ndarray) -> np.ndarray:
    """(N, 2) change of the planes' depth with the picture point, at the centres."""
    depth = -splats.center[:, 2:]
    if camera.is_orthographic:
        return splats.plane[:, :2] / splats.plane[:, 2:]
    facing = np.einsum("ij,ij->i", splats.plane, splats.center)[:, None]
    return -splats.plane[:, :2] * depth**2 / facing


def _visibility(splats: Splats, grid: RayGrid, epsilon: float) -> np.ndarray:
    inside, boxes = splats_in(splats, projected_bounds(splats, grid.camera), grid)
    return visible_depth(inside, boxes, grid, epsilon)


def _contributions(
    splats: Splats, projections: Projections, grid: RayGrid, visibility: np.ndarray, cutoff: float, epsilon: float
):
    """Rays, splats, weights, depths and positions of visible splats, in chunks."""

    def depth_on(splat, ray):
        return _plane_depth(splats, projections, splat, grid, ray)

    half = cutoff * np.sqrt(np.stack([projections.variance[:, 0, 0], projections.variance[:, 1, 1]], axis=1))
    limit = np.array(grid.shape[::-1])
    first = np.clip(np.ceil(projections.center - half - 0.5 - 1e-6), 0, limit).astype(np.int64)
    end = np.clip(np.floor(projections.center + half - 0.5 + 1e-6) + 1, 0, limit).astype(np.int64)
    rows = np.flatnonzero((first < end).all(axis=1) & (projections.amplitude > 0))
    with np.errstate(divide="ignore", invalid="ignore"):
        inverse = np.linalg.inv(projections.variance[rows])
    local = np.zeros(len(splats), np.int64)
    local[rows] = np.arange(len(rows))
    for ray, splat in candidates(rows, first[rows], end[rows], grid):
        row, column = np.divmod(ray, grid.shape[1])
        offset = np.stack([column, row], axis=1) + 0.5 - projections.center[splat]
        square = np.einsum("ni,nij,nj->n", offset, inverse[local[splat]], offset)
        reached = np.flatnonzero(square <= cutoff**2)
        ray, splat, square = ray[reached], splat[reached], square[reached]
        depth = depth_on(splat, ray)
        share, past, way = kernel_ends(splats, grid, ray, splat)
        seen = depth <= visibility[ray]
        near = np.flatnonzero(past > -TO_LINE)
        of = ray[near], splat[near], past[near], way[near]
        seen[near] = seen_near_lines(splats, grid, *of, visibility, depth_on, epsilon)
        seen &= (depth >= grid.camera.near) & (depth <= grid.camera.far) & (share > 0)
        ray, splat = ray[seen], splat[seen]
        weight = projections.amplitude[splat] * np.exp(-square[seen] / 2) * share[seen]
        weight *= splats.side_weight()[splat]
        # A splat has a single colour, the one at its centre.
        yield ray, splat, weight, depth[seen], np.zeros((len(ray), 2))


def _plane_depth(splats: Splats, projections: Projections, splat, grid: RayGrid, ray) -> np.ndarray:
    """(M,) depth of the splat's plane on the ray, clamped near the splat, because outside its ellipse it diverges."""
    origin, direction = grid.rays(ray)
    plane, center = splats.plane[splat], splats.center[splat]
    with np.errstate(divide="ignore", invalid="ignore"):
        depth = np.einsum("ij,ij->i", plane, center - origin) / np.einsum("ij,ij->i", plane, direction)
    offset = np.where(depth > 0, depth, -center[:, 2]) + center[:, 2]
    return -center[:, 2] + np.clip(offset, -projections.reach[splat], projections.reach[splat])
