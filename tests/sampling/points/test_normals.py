# SPDX-License-Identifier: GPL-3.0-or-later
"""Estimated normals agree with those of a sphere, a torus and a scanned mesh, and face the right side."""

import numpy as np
import pytest

from splat_addon.sampling import surfels_from_points
from splat_addon.sampling.points.neighbours import nearest_neighbours
from splat_addon.sampling.points.normals import local_planes
from splat_addon.sampling.points.orientation import consistent_signs, scanned_sides


def angles(surfels, normals):
    """Degrees between the estimated normals and the true ones; a normal on the wrong side has up to 180."""
    return np.degrees(np.arccos(np.clip((surfels.normals * normals).sum(axis=1), -1, 1)))


@pytest.mark.parametrize("shape", ["sphere_points", "torus_points"])
@pytest.mark.parametrize(("noise", "typical", "worst"), [(0.0, 1.1, 10.0), (0.003, 2.5, 15.0)])
def test_normals_are_close_to_the_true_ones_and_all_outward(request, shape, noise, typical, worst):
    points, normals = request.getfixturevalue(shape)(20_000, noise)
    surfels, _ = surfels_from_points(points, isolated="keep")
    error = angles(surfels, normals)
    assert np.median(error) < typical and error.max() < worst


def test_two_parts_are_each_outward(sphere_points):
    points, normals = sphere_points(5000)
    surfels, report = surfels_from_points(np.concatenate([points, 0.1 * points + 5]))
    assert report.parts == 2
    assert (angles(surfels, np.concatenate([normals, normals])) < 30).all()


def test_each_point_faces_its_own_scanner(sphere_points):
    """The upper half is seen from above, the lower one from inside, and nothing is known of the points around them."""
    points, _ = sphere_points(2000)
    scanners = np.where(points[:, 2:] > 0, (0, 0, 5.0), 0.0)
    scanners[np.abs(points[:, 2]) < 0.4] = np.nan
    surfels, _ = surfels_from_points(points + 1e4, scanners=scanners + 1e4)
    towards = scanners - points
    cosines = np.einsum("ij,ij->i", surfels.normals, towards) / np.linalg.norm(towards, axis=1)
    assert len(surfels) == 2000 and np.nanmin(cosines) > 0.1
    assert np.count_nonzero(np.isnan(cosines)) > 500


def test_from_a_viewpoint_inside_normals_face_inward(sphere_points):
    points, normals = sphere_points(5000)
    surfels, _ = surfels_from_points(points + 1e4, viewpoint=(1e4, 1e4, 1e4))
    assert (angles(surfels, -normals) < 30).all()


def test_a_flat_sheet_faces_up(grid_points):
    surfels, _ = surfels_from_points(grid_points(20, 20))
    assert np.allclose(surfels.normals, (0, 0, 1))


def test_normals_turn_with_a_sharp_edge():
    """Normals of neighbours across the edge are at right angles, which does not tell their sides; a reflection does."""
    side = (np.stack(np.meshgrid(np.arange(20), np.arange(20)), -1).reshape(-1, 2) + 0.5) / 20
    faces = [np.insert(side, axis, end, axis=1) for axis in range(3) for end in (0.0, 1.0)]
    points = np.concatenate(faces)
    surfels, _ = surfels_from_points(points)
    assert ((surfels.normals * (points - 0.5)).sum(axis=1) > 0).all()


def test_exact_normals_of_a_tetrahedron_turn_with_its_edges():
    """Across an edge the normals are 109 degrees apart, so their cosine alone would choose the wrong side."""
    corners = np.array([(1, 1, 1), (1, -1, -1), (-1, 1, -1), (-1, -1, 1)], float)
    random = np.random.default_rng(0)
    faces = [random.dirichlet((1, 1, 1), 500) @ np.delete(corners, k, axis=0) for k in range(4)]
    points, outward = np.concatenate(faces), np.repeat(-corners / np.sqrt(3), 500, axis=0)
    normals = outward * random.choice((-1, 1), (2000, 1))
    signs, part, _ = consistent_signs(points, normals, nearest_neighbours(points, 8)[0])
    assert part.max() == 0
    assert abs(((signs[:, None] * normals) * outward).sum()) == pytest.approx(2000)


def test_the_range_map_faces_its_scanner(range_map):
    surfels, report = surfels_from_points(range_map, viewpoint=(0, 0, 0))
    towards = -(surfels.origin + surfels.positions)
    assert ((surfels.normals * towards).sum(axis=1) > 0).mean() > 0.999
    assert report.isolated == 42


def test_the_range_map_has_the_normals_of_its_mesh(range_map_mesh):
    vertices, faces = range_map_mesh
    a, b, c = vertices[faces].transpose(1, 0, 2)
    weighted = np.repeat(np.cross(b - a, c - a), 3, axis=0)
    normals = np.stack([np.bincount(faces.ravel(), column, len(vertices)) for column in weighted.T], axis=1)
    length = np.linalg.norm(normals, axis=1)
    surfels, _ = surfels_from_points(vertices, viewpoint=(0, 0, 0), isolated="keep")
    cosines = (surfels.normals * normals).sum(axis=1)[length > 0] / length[length > 0]
    assert np.degrees(np.arccos(np.median(cosines))) < 2 and (cosines < 0).sum() < 10


def test_given_normals_are_used_where_they_are_usable(sphere_points):
    points, normals = sphere_points(2000)
    given = -3 * normals
    given[:10], given[10:20] = 0, np.nan
    surfels, report = surfels_from_points(points, given, isolated="keep")
    assert np.allclose(surfels.normals[20:], -normals[20:], atol=1e-6)
    assert report.estimated_normals == 20


@pytest.mark.parametrize("scale", [1e-150, 1e-6, 1.0, 1e100])
def test_a_plane_is_found_at_any_scale(scale):
    points = scale * np.random.default_rng(2).normal(size=(9, 3)) @ np.diag([1, 1, 0])
    assert np.allclose(np.abs(local_planes(points, np.arange(1, 9)[None]).normals), (0, 0, 1))


def test_points_on_a_line_get_a_normal_across_it():
    points = np.outer(np.arange(9.0), (1, 2, 3))
    (normal,) = local_planes(points, np.arange(1, 9)[None]).normals
    assert np.linalg.norm(normal) == pytest.approx(1) and abs(normal @ (1, 2, 3)) < 1e-6


def test_surfaces_steep_to_their_scanners_are_on_the_side_of_their_neighbours():
    angle, depth, across = np.linspace(0, np.pi / 2, 12), np.arange(0.7, 30, 0.7), np.arange(0, 10, 0.7)
    # a wall below a round edge that is seen from above
    profile = np.concatenate([5 * np.stack([np.sin(angle), np.cos(angle)], 1), np.stack([0 * depth + 5, -depth], 1)])
    outward = np.concatenate([np.stack([np.sin(angle), np.cos(angle)], 1), np.tile((1.0, 0.0), (len(depth), 1))])
    x, y, z = np.broadcast_arrays(profile[:, None, 0], across, profile[:, None, 1])
    points, normals = (
        np.stack([x, y, z], -1).reshape(-1, 3),
        np.repeat(np.insert(outward, 1, 0, axis=1), len(across), 0),
    )
    flips = np.random.default_rng(0).choice((-1, 1), len(points))
    near, scanners = nearest_neighbours(points, 8)[0], np.tile((0, 0, 1e6), (len(points), 1))
    assert (scanned_sides(points, normals * flips[:, None], near, scanners) == flips).all()
    wall = normals[:, 2] == 0
    near = nearest_neighbours(points[wall], 8)[0]
    assert (np.abs(scanned_sides(points[wall], normals[wall], near, scanners[wall])) == 1).all()
