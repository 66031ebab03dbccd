# SPDX-License-Identifier: GPL-3.0-or-later
"""Blend depths are almost 0 on flat surfaces, and on curved ones as large as the offsets between overlapping splats."""

import numpy as np

from splat_addon.sampling import Tolerance
from splat_addon.sampling.attributes.blend_depths import LEAST_BLENDING
from tests.plain import sample_mesh, sample_surface


def test_flat_surfaces_hardly_blend_although_they_have_creases(cube):
    assert np.all(sample_mesh(cube(), resolution=9, fits_blending=True).blend_depth == np.float32(LEAST_BLENDING))


def test_it_is_absent_where_nobody_asks(cube):
    assert sample_mesh(cube(), resolution=9).blend_depth is None


def test_it_holds_how_far_neighbours_lie_off_a_splats_plane(sphere):
    """Overlapping splats on a ball of radius 1 are off each other's planes by about their radius squared."""
    surfels = sample_mesh(sphere, resolution=40, fits_blending=True)
    off = surfels.blend_depth * surfels.radius
    sagitta = surfels.radius**2 / 2
    assert np.median(off / sagitta) > 1
    assert np.percentile(off / sagitta, 99) < 6
    assert surfels.blend_depth.max() < 0.5


def test_finer_surfels_blend_less(sphere):
    coarse, fine = (sample_mesh(sphere, resolution=r, fits_blending=True).blend_depth.mean() for r in (8, 16))
    assert coarse > 0.15 and fine < 0.6 * coarse


def test_merged_surfels_have_one_too(cube):
    merged = sample_surface(cube(), resolution=32, fits_blending=True, tolerance=Tolerance(1e-4)).surfels
    assert len(merged.blend_depth) == len(merged) and merged.blend_depth.max() < 2 * LEAST_BLENDING
