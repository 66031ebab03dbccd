# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfels of bare points are as wide as the points are apart, and leave no holes."""

import numpy as np
import pytest

from splat_addon.sampling import surfels_from_points
from splat_addon.sampling.points.from_points import _limit
from splat_addon.sampling.points.normals import tangent_frames


def uncovered_share(surfels, points, normals, near=32):
    """The share of points of the surface, given with normals, that lie on no splat."""
    from scipy.spatial import cKDTree

    positions, (x, y) = surfels.origin + surfels.positions, surfels.half_axes()
    _, neighbours = cKDTree(positions).query(points, k=near)
    covered = np.zeros(len(points), bool)
    for surfel in neighbours.T:
        plane = surfels.geometric_normals()[surfel]
        away = points - positions[surfel]
        along = (away * plane).sum(axis=1) / (normals * plane).sum(axis=1)
        foot = away - along[:, None] * normals
        covered |= sum(((foot * a[surfel]).sum(axis=1) / (a[surfel] ** 2).sum(axis=1)) ** 2 for a in (x, y)) <= 1
    return 1 - covered.mean()


def test_a_square_grid_gets_discs_of_the_splat_size(grid_points):
    surfels, _ = surfels_from_points(grid_points(20, 20, 0.5, 0.5), splat_size=1.5)
    inner = surfels.scales.reshape(20, 20, 2)[3:-3, 3:-3]
    assert np.allclose(inner, 1.5 * 0.5, rtol=0.05)


def test_only_a_surface_all_around_bears_large_splats(grid_points):
    """A grid of eight times the spacing keeps large splats, except at its edges, and where it is rough."""
    coarse = 8 * grid_points(16, 16) + np.array([60.0, 0, 0])
    rough = coarse + np.random.default_rng(0).normal((200, 0, 0), (0, 0, 4), coarse.shape)
    surfels, report = surfels_from_points(np.concatenate([grid_points(50, 50), coarse, rough]), isolated="keep")
    sizes = surfels.radius[2500:].reshape(2, 16, 16) / np.median(surfels.radius)
    assert (sizes[0, 4:-4, 4:-4] > 7).all()
    assert sizes[0, 0].max() < 5.01 and sizes[1].max() < 5.01
    assert report.limited > 256


def test_a_large_splat_needs_large_neighbours_that_are_no_strays():
    """The outer points of a grid are strays, so that the middle one, whose neighbours are large, alone is borne."""
    x, y = np.meshgrid(np.arange(3), np.arange(3))
    places = np.stack([x, y, 0 * x], axis=-1).reshape(-1, 3).astype(float)
    positions = np.tile(places, (6, 1))
    positions[:, 0] += np.repeat(100.0 * np.arange(6), 9)
    nearest = np.concatenate([np.delete(np.arange(9), k)[None] + 9 * part for part in range(6) for k in range(9)])
    scales, alone = np.ones((54, 2)), np.zeros(54, bool)
    scales[:18], alone[9:13], alone[14:18] = 20, True, True
    limited = _limit(scales, positions, np.tile((0.0, 0, 1), (54, 1)), nearest, np.ones(54, bool), alone)
    assert (scales[4] == 20).all() and (scales[13] == 5).all() and limited[13] and not limited[4]


@pytest.mark.parametrize("stretch", [2.0, 4.0])
def test_a_stretched_grid_gets_ellipses_along_its_long_spacing(grid_points, stretch):
    surfels, _ = surfels_from_points(grid_points(60, 20, 1.0, stretch), splat_size=1.25)
    inner = np.arange(60 * 20).reshape(60, 20)[10:-10, 5:-5].ravel()
    assert np.allclose(surfels.scales[inner], (1.25 * stretch, 1.25), rtol=0.1)
    assert np.allclose(np.abs(surfels.half_axes()[0][inner, 1]), surfels.scales[inner, 0], rtol=0.01)


@pytest.mark.parametrize("stretch", [1.0, 2.0, 4.0])
def test_a_grid_is_covered_between_its_outer_points(grid_points, stretch):
    surfels, _ = surfels_from_points(grid_points(40, 20, 1.0, stretch), splat_size=1.0)
    points = np.random.default_rng(3).random((20_000, 3)) * (39, 19 * stretch, 0)
    assert uncovered_share(surfels, points, np.tile([0.0, 0.0, 1.0], (20_000, 1))) == 0


def test_random_points_of_a_sphere_are_covered(sphere_points):
    points, _ = sphere_points(10_000)
    random = np.random.default_rng(4).normal(size=(20_000, 3))
    random /= np.linalg.norm(random, axis=1, keepdims=True)
    assert uncovered_share(surfels_from_points(points)[0], random, random) == 0


def test_the_range_map_has_no_hole_where_its_mesh_has_none(range_map_mesh):
    """The test points are on the mesh's faces, which the surfels were made without; faces across a step in depth are
    left out.
    """
    vertices, faces = range_map_mesh
    surfels, _ = surfels_from_points(vertices, viewpoint=(0, 0, 0))
    random = np.random.default_rng(8)
    a, b, c = vertices[faces[random.choice(len(faces), 20_000)]].transpose(1, 0, 2)
    u, v = np.sort(random.random((2, len(a), 1)), axis=0)
    normals = np.cross(b - a, c - a)
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    short = max_edge(a, b, c) < 3 * np.median(max_edge(a, b, c))
    points = a * u + b * (v - u) + c * (1 - v)
    assert short.mean() > 0.98
    assert uncovered_share(surfels, points[short], normals[short]) < 1e-3


def max_edge(a, b, c):
    return np.max([np.linalg.norm(p - q, axis=1) for p, q in ((a, b), (b, c), (c, a))], axis=0)


def test_half_the_splat_size_of_a_grid_is_enlarged_until_it_covers(grid_points):
    surfels, _ = surfels_from_points(grid_points(20, 20), splat_size=0.5)
    assert np.allclose(surfels.scales.reshape(20, 20, 2)[3:-3, 3:-3], np.sqrt(0.5), rtol=0.01)


def test_splats_at_a_border_do_not_reach_farther_than_inside(grid_points):
    surfels, _ = surfels_from_points(grid_points(20, 20))
    assert surfels.radius.max() < 1.5 * np.median(surfels.radius)


def test_a_gap_is_not_filled(grid_points):
    points = grid_points(40, 20)
    points[:, 0] += 10 * (points[:, 0] >= 20)
    surfels, _ = surfels_from_points(points)
    assert surfels.radius.max() < 2.5


def test_a_gap_that_neighbours_bridge_is_not_filled(grid_points):
    """With 80 neighbours, a point at the border also sees points on the far side of the gap, at a distance of 7."""
    points = grid_points(40, 20)
    points[:, 0] += 6 * (points[:, 0] >= 20)
    surfels, _ = surfels_from_points(points, neighbours=80)
    assert surfels.radius.max() < 6


def test_the_other_side_of_a_thin_sheet_does_not_narrow_a_splat(grid_points):
    sheet = grid_points(20, 20)
    points = np.concatenate([sheet, np.add(sheet, (0.4, 0.3, -0.01))])
    normals = np.repeat([(0, 0, 1), (0, 0, -1)], 400, axis=0)
    surfels, _ = surfels_from_points(points, normals)
    inner = surfels.scales[:400].reshape(20, 20, 2)[3:-3, 3:-3]
    assert np.allclose(inner, 1.25, rtol=0.1)


def test_given_radii_are_used_where_they_are_usable(grid_points):
    radii = np.full(400, 3.0)
    radii[:4] = 0, -1, np.nan, np.inf
    surfels, report = surfels_from_points(grid_points(20, 20), radii=radii)
    assert (surfels.scales[4:] == 3).all() and (surfels.scales[:4] < 2).all()
    assert report.estimated_radii == 4


def test_tangent_frames_are_right_handed_at_the_poles_too():
    random = np.random.default_rng(0).normal(size=(100, 3))
    normals = np.concatenate([random / np.linalg.norm(random, axis=1, keepdims=True), np.eye(3), -np.eye(3)])
    u, v = tangent_frames(normals)
    assert np.allclose(np.cross(u, v), normals)
    assert np.allclose((u * u).sum(axis=1), 1) and np.allclose((u * normals).sum(axis=1), 0)
