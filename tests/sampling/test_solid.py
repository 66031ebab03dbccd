# SPDX-License-Identifier: GPL-3.0-or-later
"""A mesh is marked as solid only if no back face can be seen from outside."""

import gzip

import numpy as np
import pytest
import trimesh

from splat_addon.sampling import TriangleMesh
from splat_addon.sampling.mesh.connectivity import connectivity
from splat_addon.sampling.mesh.solid import is_solid


def of(shape):
    return TriangleMesh(shape.vertices, shape.faces)


def joined(*shapes):
    return of(trimesh.util.concatenate(shapes))


SPHERE = trimesh.creation.icosphere(2)
FAR = SPHERE.copy().apply_translation((5, 0, 0))
INVERTED = FAR.copy()
INVERTED.invert()


def test_a_closed_surface_is_solid():
    assert is_solid(of(SPHERE)) and is_solid(joined(SPHERE, FAR))


def test_a_surface_with_a_hole_is_not():
    assert not is_solid(TriangleMesh(SPHERE.vertices, SPHERE.faces[1:]))


def test_a_triangle_turned_over_is_enough_to_say_no():
    faces = SPHERE.faces.copy()
    faces[7] = faces[7][::-1]
    assert not is_solid(TriangleMesh(SPHERE.vertices, faces))


def test_a_part_turned_inside_out_is_not_solid():
    assert not is_solid(joined(SPHERE, INVERTED))
    assert not is_solid(of(INVERTED))


def test_vertices_split_at_seams_count_as_one():
    split = SPHERE.vertices[SPHERE.faces].reshape(-1, 3)
    assert is_solid(TriangleMesh(split, np.arange(len(split)).reshape(-1, 3)))


def test_degenerate_triangles_do_not_open_a_surface():
    faces = np.concatenate([SPHERE.faces, [[0, 0, 5], [3, 3, 3]]])
    assert is_solid(TriangleMesh(SPHERE.vertices, faces))


@pytest.mark.parametrize("scale", [1e-9, 1e9])
def test_size_and_place_do_not_matter(scale):
    assert is_solid(TriangleMesh(SPHERE.vertices * scale + 1e3 * scale, SPHERE.faces))


def test_a_vertex_that_is_not_finite_makes_it_open():
    vertices = SPHERE.vertices.copy()
    vertices[0] = np.nan
    assert not is_solid(TriangleMesh(vertices, SPHERE.faces))


def test_the_armadillo_is_solid_and_the_bunny_is_not(models):
    for name, expected in (("armadillo", True), ("bunny", False)):
        with gzip.open(models / f"{name}.obj.gz") as file:
            shape = trimesh.load(file, file_type="obj", process=False, force="mesh")
        assert is_solid(of(shape)) is expected


def test_what_is_connected_is_found_once_for_a_mesh_and_anew_for_some_of_its_triangles():
    mesh = joined(SPHERE, FAR)
    assert connectivity(mesh) is connectivity(mesh)
    parts = connectivity(mesh).parts
    assert len(np.unique(parts)) == 2
    some = mesh.with_triangles(np.flatnonzero(parts == parts[0]))
    assert len(np.unique(connectivity(some).parts)) == 1
