# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfels of bare points: unusable points are counted, given values are used, and errors are sentences."""

import time

import numpy as np
import pytest

from splat_addon.sampling import surfels_from_points
from splat_addon.sampling.points.cleanup import first_of_each


def test_points_that_are_not_finite_are_counted_and_left_out(grid_points):
    points = grid_points(20, 20)
    points[:4, 0] = np.nan, np.inf, -np.inf, 1e30
    surfels, report = surfels_from_points(points)
    assert (report.non_finite, report.surfels, len(surfels)) == (4, 396, 396)


def test_points_that_repeat_another_are_counted_and_the_first_is_kept(grid_points):
    points = grid_points(20, 20)
    colors = np.zeros((440, 3))
    colors[:400] = 1
    surfels, report = surfels_from_points(np.concatenate([points, points[::10]]), colors=colors)
    assert report.duplicates == 40 and len(surfels) == 400
    assert (surfels.colors[:, :3] == 1).all()


def test_points_of_the_same_coordinates_in_another_order_or_of_another_sign_do_not_repeat_each_other():
    points = np.array([(1, 2, 3), (2, 1, 3), (-1, 2, 3), (1, 2, -3), (0, 0, 0), (-0.0, 0, 0), (1, 1, 0), (1, 2, 3)])
    assert first_of_each(points).tolist() == [0, 1, 2, 3, 4, 6]


@pytest.mark.parametrize(("choice", "kept"), [("drop", 400), ("keep", 402)])
def test_points_that_stand_alone_are_counted_and_left_out_or_kept(grid_points, choice, kept):
    points = np.concatenate([grid_points(20, 20), [(10, 10, 30), (0, 0, -1e9)]])
    surfels, report = surfels_from_points(points, isolated=choice)
    assert report.isolated == 2 and len(surfels) == kept
    assert surfels.radius.max() < 2
    assert report.skipped() == ({"that stand alone": 2} if choice == "drop" else {})


@pytest.mark.parametrize("group", [1, 6])
def test_many_sparse_strays_do_not_become_large_discs(sphere_points, group):
    """Each stray's neighbours are strays at similar distances. Groups of six that happen to meet stay."""
    points, _ = sphere_points(20_000)
    random = np.random.default_rng(2)
    places = np.repeat(random.uniform(-3, 3, (402 // group, 3)), group, axis=0)
    strays = places + 0.02 * random.normal(size=places.shape)
    surfels, _ = surfels_from_points(np.concatenate([points, strays]))
    is_off = np.abs(np.linalg.norm(surfels.origin + surfels.positions, axis=1) - 1) > 0.1
    assert is_off.sum() <= 0.05 * len(strays)
    assert surfels.radius.max() < 12 * np.median(surfels.radius)
    assert len(points) - (~is_off).sum() <= 20


def test_a_sparse_surface_beside_a_dense_one_stays(sphere_points, grid_points):
    """A statue on a ground of 8 times its spacing: only where both meet do neighbours fill space."""
    statue, _ = sphere_points(20_000)
    ground = grid_points(60, 60, 0.2, 0.2) - (6, 6, 1.2)
    _, report = surfels_from_points(np.concatenate([statue, ground]))
    assert report.isolated < 0.02 * len(ground)


@pytest.mark.parametrize("choice", ["drop", "keep"])
def test_a_point_at_the_end_of_the_range_costs_the_others_neither_time_nor_digits(sphere_points, choice):
    """With cells counted from end to end, all other points would share one cell: 1.6 billion distances."""
    points, _ = sphere_points(40_000)
    started = time.process_time()
    surfels, report = surfels_from_points(np.concatenate([points, [(5e17, -5e17, 0)]]), isolated=choice)
    assert time.process_time() - started < 10
    near = slice(0, len(surfels) - (choice == "keep"))
    assert report.isolated >= 1 and len(surfels) >= 39_900
    kept = surfels.origin + surfels.positions[near].astype(np.float64)
    assert np.abs(np.linalg.norm(kept, axis=1) - 1).max() < 1e-6
    assert ((kept * surfels.normals[near]).sum(axis=1) > 0.9).mean() > 0.999


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("choice", ["drop", "keep"])
def test_damaged_points_cost_no_others_and_no_warning(choice):
    """The damage is in positions, normals, radii or colours."""
    random = np.random.default_rng(2)
    damaged = [0, np.nan, np.inf, 1e38, 1e300, -1e300, 1e-300, 1e-45, 5e17]
    for _ in range(20):
        given = {name: random.normal(size=(30, *width)) for name, width in _WIDTHS.items()}
        for values in given.values():
            bad = random.random(values.shape) < 0.05
            values[bad] = random.choice(damaged, bad.sum())
        surfels, report = surfels_from_points(**given, neighbours=5, isolated=choice)
        assert len(surfels) == 30 - sum(report.skipped().values()) and len(surfels) > 10


_WIDTHS = {"positions": (3,), "normals": (3,), "radii": (), "colors": (4,)}


def test_radii_beyond_float32_are_estimated_and_counted(sphere_points):
    points, _ = sphere_points(1000)
    radii = np.full(1000, 0.1)
    radii[:4] = 1e39, 1e300, 1e-50, np.inf
    surfels, report = surfels_from_points(points, radii=radii, isolated="keep")
    assert report.estimated_radii == 4 and (surfels.scales[4:] == np.float32(0.1)).all()
    assert (surfels.scales[:4] < 1).all()


def test_surfels_are_in_the_order_of_the_points(sphere_points):
    points, _ = sphere_points(3000)
    surfels, _ = surfels_from_points(points, isolated="keep")
    assert np.allclose(surfels.origin + surfels.positions, points, atol=1e-6)


def test_the_order_of_the_points_changes_nothing(sphere_points):
    points, _ = sphere_points(3000)
    order = np.random.default_rng(1).permutation(3000)
    plain, shuffled = (surfels_from_points(p, isolated="keep")[0] for p in (points, points[order]))
    assert np.allclose(shuffled.normals, plain.normals[order], atol=1e-5)
    assert np.allclose(shuffled.scales, plain.scales[order], rtol=1e-4)


@pytest.mark.parametrize("scale", [2.0**-40, 2.0**40])
def test_all_lengths_scale_with_the_points(sphere_points, scale):
    points, _ = sphere_points(3000)
    plain, scaled = (surfels_from_points(p, isolated="keep")[0] for p in (points, scale * points))
    assert np.allclose(scaled.normals, plain.normals, atol=1e-5)
    assert np.allclose(scaled.scales, scale * plain.scales, rtol=1e-4)


def test_positions_far_from_the_origin_lose_nothing(grid_points):
    points = grid_points(20, 20) + 1e7
    surfels, _ = surfels_from_points(points)
    assert np.array_equal(surfels.origin + surfels.positions, points)


def test_colours_are_used_and_unusable_ones_are_counted(grid_points):
    colors = np.tile([0.1, 0.2, 5.0, 0.5], (400, 1))
    colors[7, 2] = np.nan
    surfels, report = surfels_from_points(grid_points(20, 20), colors=colors)
    assert np.allclose(np.delete(surfels.colors, 7, axis=0), (0.1, 0.2, 5.0, 0.5))
    assert report.default_colors == 1


def test_colours_far_above_white_are_counted_and_said(grid_points):
    colors = np.full((400, 3), 0.5)
    colors[:7, 1] = 100.0
    surfels, report = surfels_from_points(grid_points(20, 20), colors=colors)
    assert report.bright_colors == 7 and surfels.colors.max() == 100
    assert (
        "Kept the colours of 7 points that exceed 10; colours are taken as scene-linear, where white is 1"
        in report.notes()
    )


def test_one_point_with_everything_given_is_enough():
    surfels, report = surfels_from_points([(1, 2, 3)], [(0, 0, 2)], [0.5])
    assert len(surfels) == 1 and report.notes() == ()
    assert np.allclose(surfels.scales, 0.5) and np.allclose(surfels.geometric_normals(), (0, 0, 1))


def test_no_points_give_no_surfels():
    surfels, report = surfels_from_points(np.empty((0, 3)))
    assert len(surfels) == report.points == 0


def test_the_notes_name_every_number(grid_points):
    points = np.concatenate([grid_points(20, 20), [(np.nan, 0, 0), (0, 0, 0)]])
    _, report = surfels_from_points(points)
    assert report.notes() == (
        "Skipped 1 points that are not finite, 1 points that repeat another",
        "Estimated normals of 400 points from their neighbours, in 1 connected parts; "
        "radii of 400 points from their neighbours",
    )


@pytest.mark.parametrize(
    ("points", "settings", "sentence"),
    [
        (np.zeros((4, 2)), {}, r"positions must have shape \(4, 3\), not \(4, 2\)"),
        (np.eye(3), {"normals": np.eye(2)}, r"normals must have shape \(3, 3\)"),
        (np.eye(3), {"colors": np.ones((3, 2))}, r"colors must have shape \(3, 3\) or \(3, 4\)"),
        (np.eye(3), {"colors": np.full((3, 3), 200, np.uint8)}, "colors must be floating of shape .*, not uint8"),
        (np.eye(3), {}, "3 usable points are too few"),
        (np.ones((9, 3)), {}, "1 usable points are too few"),
        (np.full((9, 3), np.nan), {}, "None of the 9 points has finite coordinates"),
        (np.eye(3), {"neighbours": 10**9}, "whole number from 3 to 256, not 1000000000"),
        (np.eye(3), {"neighbours": 2}, "whole number from 3 to 256, not 2"),
        (np.eye(3), {"splat_size": 0}, "splat size must be a finite number above 0, not 0"),
        (np.eye(3), {"isolated": "maybe"}, "must be one of drop, keep, not 'maybe'"),
        (np.eye(3), {"viewpoint": (0, 0, np.nan)}, "viewpoint must be 3 finite numbers"),
    ],
)
def test_what_cannot_be_done_is_a_sentence(points, settings, sentence):
    with pytest.raises(ValueError, match=sentence):
        surfels_from_points(points, **settings)


@pytest.mark.parametrize(
    "points",
    [
        np.outer(np.arange(50.0), (1, 2, 3)),
        np.arange(6.0)[:, None] % 2 + 1e-9 * np.random.default_rng(0).random((6, 3)),
        1e-30 * np.random.default_rng(0).random((50, 3)),
        1e17 * np.random.default_rng(0).random((50, 3)),
    ],
    ids=["on a line", "in two places", "very small", "very large"],
)
def test_degenerate_points_become_usable_surfels(points):
    surfels, _ = surfels_from_points(points, isolated="keep")
    assert len(surfels) == len(points)
