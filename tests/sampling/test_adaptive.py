# SPDX-License-Identifier: GPL-3.0-or-later
"""Adaptive sampling: fewer, larger surfels on flat parts, within the tolerance, without holes, never across an edge."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from splat_addon.reference.bare import uncovered_points
from splat_addon.sampling import Channel, Surface, Tolerance, TriangleMesh, VertexColors, grid_spacing
from tests.plain import sample_surface


def adaptive(mesh, resolution, cells=0.1, **limits):
    """The mesh sampled with a tolerance, given in cells."""
    spacing = grid_spacing(mesh, resolution=resolution)
    return sample_surface(mesh, resolution=resolution, tolerance=Tolerance(cells * spacing, **limits))


def turned(mesh, angles):
    """The mesh turned by three angles, so that no face is parallel to the grid."""
    from scipy.spatial.transform import Rotation

    return TriangleMesh(Rotation.from_euler("xyz", angles).apply(mesh.positions), mesh.triangles)


def test_a_flat_square_keeps_small_surfels_along_its_border_alone(square):
    """64 x 64 cells become 6 x 6 blocks of 8 x 8 inside, surrounded by a ring of blocks of 4, then 2, then 1."""
    sampling = adaptive(square(), 64)
    surfels = sampling.surfels
    middle = np.abs((surfels.origin + surfels.positions)[:, :2] - 0.5).max(axis=1) < 0.3
    assert np.allclose(surfels.scales[middle], 0.75 * 8 / 64)
    assert len(surfels) + sampling.saved == 64**2 and len(surfels) < 64**2 / 4


def test_no_disc_sticks_out_farther_than_a_single_splat(square):
    surfels = adaptive(square(), 64).surfels
    reach = (surfels.origin + surfels.positions)[:, :2] + surfels.scales[:, :1]
    assert reach.max() <= 1 + 0.7501 / 64 + 1e-6


def test_a_cube_in_any_position_has_no_holes(cube):
    box = turned(cube(), (0.4, 0.7, 0.2))
    sampling = adaptive(box, 64)
    assert sampling.saved > len(sampling.surfels)
    assert len(uncovered_points(box, sampling.surfels, grid_spacing(box, resolution=64))) == 0


@settings(max_examples=settings.default.max_examples // 5)
@given(st.tuples(*[st.floats(-3, 3)] * 3))
def test_merged_surfels_lie_on_flat_faces_in_every_position(angles):
    """On a plane through the origin every merged surfel lies in the plane and faces along its normal."""
    import trimesh

    sheet = TriangleMesh(np.array([(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0.0)]), np.array([(0, 1, 2), (0, 2, 3)]))
    sheet = turned(sheet, angles)
    normal = trimesh.Trimesh(sheet.positions, sheet.triangles).face_normals[0]
    sampling = adaptive(sheet, 48)
    surfels = sampling.surfels
    assert sampling.saved > 0
    assert np.abs((surfels.origin + surfels.positions) @ normal).max() < 1e-5
    assert (surfels.geometric_normals() @ normal > 1 - 1e-5).all()


@pytest.mark.parametrize("cells", [0.05, 0.2, 0.5])
def test_the_error_stays_within_the_tolerance_on_a_sphere(sphere, cells):
    """The distance from the sphere is measured; the bound that the sampling reports is not used."""
    spacing = grid_spacing(sphere, resolution=200)
    sampling = adaptive(sphere, 200, cells, angle=1.0)
    off = np.abs(np.linalg.norm(sampling.surfels.origin + sampling.surfels.positions, axis=1) - 1)
    assert sampling.saved > 0 and off.max() <= sampling.error + 1e-4 * spacing + 1e-4
    assert sampling.error <= cells * spacing


def test_a_larger_tolerance_leaves_fewer(sphere):
    counts = [len(adaptive(sphere, 200, cells, angle=1.0).surfels) for cells in (0.05, 0.2, 0.5)]
    assert counts[0] > counts[1] > counts[2]


def test_normals_that_turn_are_not_merged(sphere):
    """With 200 cells, normals two cells apart on the sphere differ by 0.02 rad."""
    assert adaptive(sphere, 200, 0.5, angle=0.001).saved == 0


def test_colours_that_differ_are_not_merged(square):
    ramp = np.array([0, 1, 1, 0])[[[0, 1, 2], [0, 2, 3]]][..., None] * np.ones(4)
    mesh = square(corner_colors=ramp, surfaces=(Surface(Channel((1, 1, 1, 1), VertexColors())),))
    assert adaptive(mesh, 64, color=1e-4).saved == 0 and adaptive(mesh, 64, color=1.0).saved > 0


def test_materials_are_not_merged(square):
    two = square(materials=np.array([0, 1]), surfaces=(Surface(), Surface()))
    surfels = adaptive(two, 64).surfels
    x, y = (surfels.origin + surfels.positions)[:, :2].T
    assert set(surfels.materials) == {0, 1}
    assert (surfels.materials[x > y + 0.02] == 0).all() and (surfels.materials[x < y - 0.02] == 1).all()


@pytest.mark.parametrize("field", ["materials", "colors", "normals"])
def test_odd_cells_inside_a_block_are_not_merged(field):
    """Neither odd cell is the first of its block, and their colours or normals cancel out in the block's mean."""
    x, y = (a.ravel() for a in np.meshgrid(np.arange(33), np.arange(33)))
    corner = (np.arange(32)[:, None] * 33 + np.arange(32)).ravel()[:, None]
    triangles = np.concatenate([corner + np.array(step) for step in ((0, 1, 34), (0, 34, 33))])
    odd = np.zeros((2, 32, 32), int)
    odd[:, 12, 13], odd[:, 13, 12] = 1, 1 if field == "materials" else -1
    odd = odd.ravel()
    tilted = np.array([(0, 0, 1), (0.6, 0, 0.8), (-0.6, 0, 0.8)])[odd]
    values = {
        "materials": {"materials": odd},
        "colors": {"corner_colors": np.repeat(0.5 + 0.4 * odd, 12).reshape(-1, 3, 4)},
        "normals": {"corner_normals": tilted[:, None].repeat(3, axis=1)},
    }[field]
    surfaces = (Surface(Channel((1, 1, 1, 1), VertexColors())),)
    mesh = TriangleMesh(np.stack([x, y, 0 * x], axis=1) / 32, triangles, surfaces=surfaces, **values)
    surfels = adaptive(mesh, 32).surfels
    stored = getattr(surfels, field).reshape(len(surfels), -1)[:, 0]
    assert np.count_nonzero(np.abs(stored - np.median(stored)) > 0.3) == 2 and len(surfels) < 700


@pytest.mark.parametrize(("cells", "angle", "color"), [(9, 9, 0.06), (9, 0.06, 9), (0.1, 9, 9)])
def test_each_sample_is_within_the_tolerances_of_the_surfel_in_its_place(sphere, cells, angle, color):
    """The mesh is a coloured sphere with a radius of 50 cells; each tolerance in turn is the limiting one."""
    from scipy.spatial import cKDTree

    colors = np.concatenate([sphere.positions, np.ones((len(sphere.positions), 1))], axis=1)[sphere.triangles]
    ball = TriangleMesh(
        sphere.positions,
        sphere.triangles,
        corner_normals=sphere.corner_normals,
        corner_colors=colors,
        surfaces=(Surface(Channel((1, 1, 1, 1), VertexColors())),),
    )
    spacing = grid_spacing(ball, resolution=100)
    plain = sample_surface(ball, resolution=100).surfels
    merged = adaptive(ball, 100, cells, angle=angle, color=color).surfels
    edges = np.exp2(np.rint(np.log2(merged.scales[:, 1] / (0.75 * spacing)))) * spacing
    merged_rows = np.flatnonzero(merged.scales[:, 1] > 1.3 * spacing)
    tree, axis = cKDTree(plain.positions), np.abs(plain.geometric_normals()).argmax(axis=1)
    checked = 0
    for row in merged_rows[:: len(merged_rows) // 200 + 1]:
        normal = merged.geometric_normals()[row]
        image = np.abs(normal).argmax()
        near = np.array(tree.query_ball_point(merged.positions[row], 2 * edges[row]))
        away = plain.positions[near] - merged.positions[row]
        inside = (np.abs(np.delete(away, image, axis=1)) < edges[row] / 2).all(axis=1) & (axis[near] == image)
        near, away = near[inside], away[inside]
        checked += len(near)
        assert np.abs(away @ normal).max() <= cells * spacing + 1e-6
        assert (plain.normals[near] @ merged.normals[row]).min() >= np.cos(min(angle, 3)) - 1e-6
        assert np.abs(plain.colors[near] - merged.colors[row]).max() <= color + 1e-6
    assert checked >= 4 * 50


def test_two_sheets_closer_than_a_cell_stay_two(square):
    near = square()
    both = TriangleMesh(
        np.concatenate([near.positions, near.positions + np.array([0, 0, 0.005])]),
        np.concatenate([near.triangles, near.triangles + 4]),
    )
    one, two = adaptive(near, 64), adaptive(both, 64)
    assert len(two.surfels) == 2 * len(one.surfels)


def test_what_cannot_be_merged_is_left_bit_by_bit(armadillo):
    plain = sample_surface(armadillo, resolution=64).surfels
    merged = sample_surface(armadillo, resolution=64, tolerance=Tolerance(0.0)).surfels
    assert sorted(map(bytes, plain.positions)) == sorted(map(bytes, merged.positions))


def test_the_armadillo_has_no_holes(armadillo):
    sampling = adaptive(armadillo, 128, 0.5, angle=1.0)
    bare = uncovered_points(armadillo, sampling.surfels, grid_spacing(armadillo, resolution=128))
    assert sampling.saved > 1000 and len(bare) <= 4


@pytest.mark.parametrize("limits", [{"distance": -1}, {"distance": float("nan")}, {"distance": 0, "angle": -1}])
def test_an_unusable_tolerance_is_refused_in_a_sentence(limits):
    with pytest.raises(ValueError, match="must be a finite number, 0 or more, not"):
        Tolerance(**limits)


def test_3_to_1_cannot_be_adaptive(cube):
    with pytest.raises(ValueError, match="choose another, or no tolerance"):
        sample_surface(cube(), resolution=8, reduction="three_to_one", tolerance=Tolerance(0.1))
