# SPDX-License-Identifier: GPL-3.0-or-later
"""The number of surfels agrees with closed forms and with the prediction."""

import math
from functools import partial

import numpy as np
import pytest
import trimesh

from splat_addon.sampling import TriangleMesh, predict_count, projected_area
from splat_addon.sampling.density import mean_width
from splat_addon.sampling.ldc.depth_cube import depth_cube
from splat_addon.sampling.ldc.grid import Grid
from splat_addon.sampling.ldc.missed_components import SampledSurface
from splat_addon.sampling.ldc.reductions import keep_dominant
from tests.plain import sample_mesh


@pytest.mark.parametrize("shift", [0, 0.25, 0.5])
def test_each_face_of_a_cube_gets_one_sample_a_cell_wherever_the_grid_starts(cube, shift):
    """If the grid starts at half a cell, the outermost rays run along edges of the cube; half-open rules must keep one
    side only.
    """
    mesh = cube()
    grid = Grid(np.full(3, -shift / 32), 1 / 32, subcells=1024, size=33)
    keeps = partial(keep_dominant, grazing_angle=0)
    surface = SampledSurface(len(mesh.positions))
    images = depth_cube(grid.coordinates(mesh.positions), mesh.triangles, grid, keeps, surface, lambda share: None)
    assert [spans.counts.sum() for spans in images] == [2 * 32**2] * 3


def test_each_face_of_a_cube_gets_one_surfel_a_cell(cube):
    assert len(sample_mesh(cube(), resolution=32)) == 6 * 32**2


def test_the_mean_width_is_that_of_closed_forms(cube, square):
    def width(shape):
        return mean_width(TriangleMesh(np.add(shape.vertices, (5, 3, 1)), np.asarray(shape.faces)))

    wire = trimesh.creation.cylinder(radius=0.01, height=4, sections=64)
    assert width(wire) == pytest.approx(0.02, rel=0.01)
    tube = trimesh.Trimesh(wire.vertices, wire.faces[np.abs(wire.face_normals[:, 2]) < 0.5], process=False)
    assert width(tube) == pytest.approx(0.02 * 2 / 3, rel=0.02)
    assert width(trimesh.creation.box(extents=(1, 1, 1e-3))) == pytest.approx(2e-3, rel=0.01)
    assert width(trimesh.creation.icosphere(subdivisions=4)) == pytest.approx(4 / 3, rel=0.01)
    assert mean_width(square()) < 1e-12 and mean_width(TriangleMesh(np.zeros((0, 3)), np.zeros((0, 3), int))) == 0


def test_a_sphere_has_the_count_of_the_closed_form(sphere):
    """Each of six patches projects to {2 x^2 + y^2 <= 1, x^2 + 2 y^2 <= 1}, with area 2 sqrt(2) atan(1 / sqrt(2))."""
    expected = 6 * 2 * math.sqrt(2) * math.atan(1 / math.sqrt(2)) * 64**2
    assert len(sample_mesh(sphere, resolution=128)) == pytest.approx(expected, rel=2e-3)


@pytest.mark.parametrize("reduction", ["normal", "none"])
def test_the_count_of_the_armadillo_is_predicted_within_a_percent(armadillo, reduction):
    count = len(sample_mesh(armadillo, resolution=128, reduction=reduction))
    assert predict_count(armadillo, resolution=128, reduction=reduction) == pytest.approx(count, rel=0.01)


def test_the_projected_area_of_a_cube_is_its_area(cube):
    assert projected_area(cube()) == projected_area(cube(), "none") == 6


def test_doubling_the_resolution_makes_four_times_the_surfels_of_a_cube(cube):
    assert len(sample_mesh(cube(), resolution=64)) == 4 * len(sample_mesh(cube(), resolution=32))


def test_spacing_and_resolution_are_two_names_of_one_grid(sphere):
    by_resolution, by_spacing = sample_mesh(sphere, resolution=50), sample_mesh(sphere, spacing=2 / 50)
    assert (by_resolution.positions == by_spacing.positions).all()


def test_a_resolution_of_8192_stays_exact(cube):
    """The box is a thin bar, so that the grid is fine but has few samples."""
    strip = cube()
    strip = TriangleMesh(strip.positions * (1, 8 / 8192, 8 / 8192), strip.triangles)
    assert len(sample_mesh(strip, resolution=8192)) == 4 * 8192 * 8 + 2 * 8 * 8


def test_a_wanted_count_is_met_within_a_percent(armadillo):
    assert len(sample_mesh(armadillo, count=20_000)) == pytest.approx(20_000, rel=0.01)


def test_a_wanted_count_is_of_what_the_reduction_leaves(sphere):
    assert len(sample_mesh(sphere, count=20_000, reduction="none")) == pytest.approx(20_000, rel=0.01)
