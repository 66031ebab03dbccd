# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes that are moved and joined have the volume and area that trimesh computes."""

from dataclasses import replace

import numpy as np
import pytest
import trimesh

from splat_addon.sampling import Channel, Surface, TriangleMesh, is_solid, joined, transformed
from tests.plain import sample_mesh


def mesh_of(solid: trimesh.Trimesh, **fields) -> TriangleMesh:
    return TriangleMesh(solid.vertices, solid.faces, **fields)


@pytest.fixture
def ball():
    solid = trimesh.creation.icosphere(subdivisions=2)
    return mesh_of(solid, corner_normals=solid.vertices[solid.faces])


MAPS = {
    "turned": trimesh.transformations.rotation_matrix(1, (1, 2, 3), (4, 5, 6)),
    "mirrored": np.diag([-2.0, 1, 1, 1]),
    "mirrored twice": np.diag([-2.0, 1, -3, 1]),
    "sheared": np.array([[1, 2, 0, 5], [0, 1, 0, 6], [0, 0.5, 1, 7], [0, 0, 0, 1.0]]),
}


@pytest.mark.parametrize("matrix", MAPS.values(), ids=MAPS)
def test_a_solid_stays_a_solid_of_the_maps_volume(ball, matrix):
    moved = transformed(ball, matrix)
    after = trimesh.Trimesh(moved.positions, moved.triangles, process=False)
    before = trimesh.Trimesh(ball.positions, ball.triangles, process=False)
    assert after.volume == pytest.approx(abs(np.linalg.det(matrix)) * before.volume)
    assert is_solid(moved)


@pytest.mark.parametrize("matrix", MAPS.values(), ids=MAPS)
def test_shading_normals_stay_on_the_outside(ball, matrix):
    moved = transformed(ball, matrix)
    a, b, c = moved.positions[moved.triangles.T]
    faces = np.cross(b - a, c - a)
    faces /= np.linalg.norm(faces, axis=1, keepdims=True)
    shading = moved.corner_normals / np.linalg.norm(moved.corner_normals, axis=2, keepdims=True)
    assert np.einsum("tcj,tj->tc", shading, faces).min() > 0.5


@pytest.mark.parametrize("matrix", MAPS.values(), ids=MAPS)
def test_corner_values_stay_at_their_corners(ball, matrix):
    """Each corner's colour is its position before the move, so the moved colour must be the position after it."""
    colors = np.concatenate([ball.positions[ball.triangles], np.ones((len(ball), 3, 1))], axis=2)
    named = TriangleMesh(ball.positions, ball.triangles, corner_colors=colors)
    moved = transformed(named, matrix)
    assert np.allclose(moved.corner_colors @ matrix[:3].T, moved.positions[moved.triangles])


def test_nothing_is_copied_where_nothing_moves(ball):
    assert transformed(ball, np.eye(4)) is ball
    assert joined([ball]) is ball


def test_joined_meshes_are_all_there(ball):
    box = transformed(mesh_of(trimesh.creation.box()), trimesh.transformations.translation_matrix((5, 0, 0)))
    both = joined([ball, box])
    solid = trimesh.Trimesh(both.positions, both.triangles, process=False)
    assert solid.volume == pytest.approx(trimesh.creation.icosphere(subdivisions=2).volume + 1)
    assert is_solid(both)


def test_layers_of_coordinates_stay_those_of_their_mesh(ball):
    """One mesh has two layers of coordinates, the other has one: its second layer is 0 and is never looked up."""
    two = replace(ball, corner_uvs=np.full((len(ball), 3, 4), 0.5))
    one = replace(ball, corner_uvs=np.full((len(ball), 3, 2), 0.25))
    both = joined([two, one]).corner_uvs
    assert (both[: len(ball)] == 0.5).all() and (both[len(ball) :, :, :2] == 0.25).all()
    assert (both[len(ball) :, :, 2:] == 0).all()


def test_what_one_mesh_lacks_is_filled_in(ball):
    """A box without normals, joined with a smooth ball, is shaded flat and keeps its material."""
    painted = mesh_of(
        trimesh.creation.icosphere(subdivisions=2),
        corner_normals=ball.corner_normals,
        materials=np.ones(len(ball), np.int32),
        surfaces=(Surface(Channel((1, 0, 0, 1))), Surface(Channel((0, 1, 0, 1)))),
    )
    box = transformed(mesh_of(trimesh.creation.box()), trimesh.transformations.translation_matrix((5, 0, 0)))
    surfels = sample_mesh(joined([painted, box]), spacing=0.1)
    of_box = surfels.origin[0] + surfels.positions[:, 0] > 3
    assert np.allclose(surfels.normals[of_box], surfels.geometric_normals()[of_box], atol=1e-6)
    assert np.allclose(surfels.colors[of_box], (1, 0, 0, 1)) and np.allclose(surfels.colors[~of_box], (0, 1, 0, 1))
    assert (surfels.materials == ~of_box).all()
