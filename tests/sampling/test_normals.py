# SPDX-License-Identifier: GPL-3.0-or-later
"""Shading normals are interpolated between corners, and geometric normals follow the winding."""

import numpy as np
import pytest

from splat_addon.sampling import TriangleMesh
from tests.plain import sample_mesh


def test_shading_normals_of_a_sphere_are_its_own(sphere):
    surfels = sample_mesh(sphere, resolution=64)
    radial = surfels.origin + surfels.positions
    radial /= np.linalg.norm(radial, axis=1, keepdims=True)
    cosine = np.einsum("ij,ij->i", radial, surfels.normals)
    assert np.degrees(np.arccos(np.clip(cosine, -1, 1))).max() < 0.05


def test_without_corner_normals_a_face_is_flat_shaded(cube):
    surfels = sample_mesh(cube(), resolution=8)
    assert (np.sort(np.abs(surfels.normals), axis=1) == (0, 0, 1)).all()


def test_geometric_normals_point_the_way_of_the_winding(cube):
    surfels = sample_mesh(cube(), resolution=8)
    outwards = surfels.origin + surfels.positions - 0.5
    assert (np.einsum("ij,ij->i", outwards, surfels.geometric_normals()) > 0.499).all()


def test_a_turned_triangle_turns_its_geometric_normal(triangle):
    surfels = sample_mesh(triangle((0, 0, 0), (0, 1, 0), (1, 0, 0)), resolution=8)
    assert np.allclose(surfels.geometric_normals(), (0, 0, -1))


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("broken", [0, np.nan, np.inf, 1e300])
def test_a_zero_or_broken_corner_normal_falls_back_to_the_faces(square, broken):
    normals = np.zeros((2, 3, 3))
    normals[1] = broken
    surfels = sample_mesh(square(corner_normals=normals), resolution=8)
    assert len(surfels) == 64 and (surfels.normals == (0, 0, 1)).all()


def test_normals_that_cancel_out_fall_back_to_the_face(triangle):
    normals = np.array([[(1, 0, 0), (-1, 0, 0), (1, 0, 0)]], float)
    surfels = sample_mesh(triangle((0, 0, 0), (1, 0, 0), (0, 1, 0), corner_normals=normals), resolution=9)
    assert np.allclose(np.linalg.norm(surfels.normals, axis=1), 1)


def test_tiny_and_huge_corner_normals_keep_their_direction(square):
    for length in (1e-12, 1e12):
        surfels = sample_mesh(square(corner_normals=np.full((2, 3, 3), length)), resolution=4)
        assert np.allclose(surfels.normals, 3**-0.5)


def test_the_axis_is_chosen_by_the_face_and_not_by_its_shading(cube):
    """Smooth normals lean away from the faces; choosing by them would lose one sample in seven."""
    box = cube()
    a, b, c = np.moveaxis(box.positions[box.triangles], 1, 0)
    means = np.zeros((8, 3))
    np.add.at(means, box.triangles, np.cross(b - a, c - a)[:, None])
    smooth = TriangleMesh(box.positions, box.triangles, corner_normals=means[box.triangles])
    assert len(sample_mesh(smooth, resolution=32)) == 6 * 32**2
