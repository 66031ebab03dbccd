# SPDX-License-Identifier: GPL-3.0-or-later
"""Two definitions of the picture with no projection formula in common agree where projections are affine."""

import math

import numpy as np
import pytest

from splat_addon.reference import render_ewa, render_exact, scenes
from splat_addon.reference.filters import SIGMA
from splat_addon.rendering import Camera, Scene, Settings
from splat_addon.rendering.scene.camera import look_at

FLAT = Settings(shading="flat")
SIZE = (64, 64)


@pytest.mark.parametrize("shading", ["flat", "principled"])
def test_without_a_low_pass_parallel_rays_make_the_exact_picture(shading):
    scene, camera = scenes.torus(4_000, SIZE)
    camera = Camera.orthographic(camera.matrix_world, 2.9, SIZE, camera.near, camera.far)
    settings = Settings(shading=shading)
    ewa, exact = render_ewa(scene, camera, settings, filter_sigma=0), render_exact(scene, camera, settings, samples=1)
    np.testing.assert_allclose(ewa.color, exact.color, atol=1e-5)
    np.testing.assert_allclose(ewa.normal, exact.normal, atol=1e-5)
    np.testing.assert_allclose(ewa.depth, exact.depth, rtol=1e-6)
    np.testing.assert_array_equal(ewa.coverage, exact.coverage)


@pytest.mark.parametrize("distance", [10, 100, 1000])
def test_from_afar_the_pictures_differ_by_no_more_than_the_perspective_within_a_splat(distance):
    """Within a splat of radius r at depth d, scale and place vary by the ratio r / d.

    So weights exp(-2 rho^2) vary by 4 r / d of themselves, and averages of colours below 1 by twice that. Over a share
    of 2 r / d of its area a splat is in only one of the pictures, which may change the whole average there.
    """
    scene, _ = scenes.checker_plane(10, 2_500, size=SIZE)
    splats = scene.surfels[0]
    splats = getattr(splats, "surfels", splats)
    tilted = look_at((0, -0.6 * distance, 0.8 * distance), (0, 0, 0))
    camera = Camera.perspective(tilted, 2 * math.atan(0.4 / distance), SIZE, 0.5 * distance, 2 * distance)
    ewa, exact = render_ewa(scene, camera, FLAT, filter_sigma=0), render_exact(scene, camera, FLAT, samples=1)
    radius = float(splats.scales.max())
    overdraw = math.pi * float(splats.scales.prod(axis=1).sum()) / 4
    error = np.abs(ewa.color - exact.color).max(axis=2).mean()
    assert error <= (8 + 2 * overdraw) * radius / distance
    assert error > 0


def test_small_splats_under_the_low_pass_are_the_exact_picture_under_the_pixels_gaussian(ellipses):
    """One picture has averages of filtered kernels, the other filtered averages; the bound adds up three differences.

    First, the ripple of the sum of kernels, whose mean over a cell is 0: it counts twice, times the change of colours
    over a cell and its kernels, and the change of the pixel's Gaussian over a cell (its gradient's mass is sqrt(pi / 2)
    / sigma). Second, the variance that a kernel loses where it ends (0.313 of it at two sigma), through the Gaussian's
    curvature (0.97 / sigma^2 of its mass along each axis). Third, the mass beyond the filters' ends.
    """
    spacing, radius, cutoff, pixels = 0.05, 0.2, 4.0, 6
    axis = np.arange(-pixels, pixels, spacing) + spacing / 2
    x, y = (a.ravel() for a in np.meshgrid(axis, axis))
    colors = 0.5 + 0.5 * np.stack([np.cos(x), np.sin(1.5 * y), np.cos(x + y)], axis=1)
    centers = np.stack([x, y, np.full_like(x, -3)], axis=1)
    scene = Scene([ellipses(centers, (radius, 0, 0), (0, radius, 0), colors)])
    camera = Camera.orthographic(np.eye(4), pixels, (pixels, pixels), 0.1, 10)
    ewa = render_ewa(scene, camera, FLAT, cutoff=cutoff)
    exact = render_exact(scene, camera, FLAT, samples=8, pixel_filter="gaussian")
    ripple = _ripple(spacing, radius)
    lost_variance = 0.313 * (radius / 2) ** 2
    ends = 2 * math.exp(-(cutoff**2) / 2) + 4 * math.erfc(2.5 / SIGMA / math.sqrt(2))
    variation = 0.75 * (2 * radius + math.sqrt(2) * spacing)
    bound = ripple * (variation + 2 * spacing * math.sqrt(math.pi / 2) / SIGMA) / (1 - ripple)
    bound += 0.5 * lost_variance * 2 * 0.97 / SIGMA**2 + ends
    assert bound < 0.025
    assert np.abs(ewa.color - exact.color)[..., :3].max() <= bound


def _ripple(spacing, radius):
    """The largest deviation of the sum of a square lattice's kernels from its mean, relative to the mean."""
    reach = math.ceil(radius / spacing) + 1
    k = np.arange(-reach, reach + 1) * spacing
    at = np.linspace(0, spacing, 33)
    square = ((at[:, None] - k) ** 2)[:, None, :, None] + ((at[:, None] - k) ** 2)[None, :, None, :]
    sums = np.where(square <= radius**2, np.exp(-2 * square / radius**2), 0).sum(axis=(2, 3))
    return np.abs(sums / sums.mean() - 1).max()


def test_a_splat_before_the_near_plane_is_left_out_and_counted(ellipses, perspective):
    frame = render_ewa(Scene([ellipses([(0, 0, -2), (0, 0, 1)])]), perspective(), FLAT)
    assert frame.stats["left_out"] == 1
    assert frame.coverage.any()
