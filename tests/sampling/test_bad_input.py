# SPDX-License-Identifier: GPL-3.0-or-later
"""Triangles that cannot be sampled are left out and counted; senseless input is refused in a sentence."""

import numpy as np
import pytest

from splat_addon.sampling import SamplingCancelled, TriangleMesh, drop_unusable, grid_spacing, predict_count
from tests.plain import sample_mesh

EMPTY = TriangleMesh(np.zeros((0, 3)), np.zeros((0, 3), int))


def with_extra(mesh, vertices, triangles):
    """The mesh with more triangles, whose indices start at the mesh's last vertex."""
    triangles = np.concatenate([mesh.triangles, np.array(triangles) + len(mesh.positions)])
    return TriangleMesh(np.concatenate([mesh.positions, np.array(vertices, float)]), triangles)


BAD_TRIANGLES = {
    "with a non-finite vertex": [(0, 0, 0), (1, 0, 0), (0, np.nan, 0)],
    "with a vertex beyond 1e+18": [(0, 0, 0), (1, 0, 0), (0, 1e30, 0)],
    "of zero area": [(0, 0, 0), (1, 1, 1), (3, 3, 3)],
    "that repeat another": [(0, 0, 0), (0, 0, 1), (0, 1, 1)],
}


@pytest.mark.parametrize("reason", BAD_TRIANGLES)
def test_a_bad_triangle_is_counted_and_the_rest_is_sampled(cube, reason):
    mesh = with_extra(cube(), BAD_TRIANGLES[reason], [(0, 1, 2)])
    cleaned, dropped = drop_unusable(mesh)
    assert dropped == {reason: 1} and len(cleaned) == 12
    assert len(sample_mesh(mesh, resolution=8)) == 6 * 8**2


def test_an_infinite_vertex_counts_as_non_finite(cube):
    mesh = with_extra(cube(), [(0, 0, 0), (1, 0, 0), (0, -np.inf, 0)], [(0, 1, 2)])
    assert drop_unusable(mesh)[1] == {"with a non-finite vertex": 1}


def test_a_repeated_index_is_counted(cube):
    mesh = with_extra(cube(), [(0, 0, 0), (1, 0, 0)], [(0, 1, 1), (0, 0, 0)])
    assert drop_unusable(mesh)[1] == {"with a repeated vertex": 2}


def test_the_first_of_repeated_triangles_stays_whichever_way_they_turn(cube):
    mesh = cube()
    turned = mesh.triangles[:, [2, 1, 0]]
    cleaned, dropped = drop_unusable(TriangleMesh(mesh.positions, np.concatenate([mesh.triangles, turned, turned])))
    assert dropped == {"that repeat another": 24} and (cleaned.triangles == mesh.triangles).all()


def test_negative_zero_is_zero_where_triangles_repeat(square):
    mesh = square()
    mirrored = with_extra(mesh, mesh.positions * (1, 1, -1.0), [(0, 1, 2)])
    assert drop_unusable(mirrored)[1] == {"that repeat another": 1}


def test_triangles_that_share_two_corners_do_not_repeat(square):
    assert drop_unusable(square())[1] == {}


def test_dropping_keeps_the_fields_of_the_triangles_that_stay(cube):
    mesh = with_extra(cube(), BAD_TRIANGLES["of zero area"], [(0, 1, 2)])
    order = np.array([12, *range(12)])
    fields = {"materials": np.arange(13), "corner_uvs": np.arange(78.0).reshape(13, 3, 2)}
    cleaned, _ = drop_unusable(TriangleMesh(mesh.positions, mesh.triangles[order], **fields))
    assert (cleaned.materials == np.arange(1, 13)).all() and (cleaned.corner_uvs == fields["corner_uvs"][1:]).all()


def test_unused_vertices_do_not_stretch_the_grid(cube):
    mesh = cube()
    stray = TriangleMesh(np.concatenate([mesh.positions, [(1e9, 0, np.nan)]]), mesh.triangles)
    assert grid_spacing(stray, resolution=10) == 0.1


def test_a_usable_mesh_is_not_looked_at_again(cube):
    cleaned, _ = drop_unusable(cube())
    assert drop_unusable(cleaned) == (cleaned, {})


def test_an_empty_mesh_gives_no_surfels():
    assert len(sample_mesh(EMPTY, resolution=8)) == 0 and predict_count(EMPTY, resolution=8) == 0


def test_a_mesh_of_bad_triangles_alone_gives_no_surfels(triangle):
    assert len(sample_mesh(triangle((0, 0, 0), (1, 1, 1), (2, 2, 2)), resolution=8)) == 0


def test_a_single_triangle_is_sampled(triangle):
    assert len(sample_mesh(triangle((0, 0, 0), (1, 0, 0), (0, 1, 0)), resolution=10)) in (45, 55)


def test_one_vertex_far_off_leaves_few_samples_and_no_error(cube):
    mesh = with_extra(cube(), [(0, 0, 0), (1e15, 0, 0), (0, 1, 0)], [(0, 1, 2)])
    assert len(sample_mesh(mesh, resolution=1024)) < 1024


@pytest.mark.parametrize(
    "density, sentence",
    [
        ({}, "not none of them"),
        ({"spacing": 0.1, "resolution": 8}, "not spacing and resolution"),
        ({"spacing": 0}, "spacing must be a finite number above 0, not 0"),
        ({"spacing": -1.0}, "spacing must be a finite number above 0, not -1.0"),
        ({"resolution": 0}, "resolution must be a finite number above 0, not 0"),
        ({"resolution": float("nan")}, "resolution must be a finite number above 0, not nan"),
        ({"count": -5}, "count must be a finite number above 0, not -5"),
        ({"spacing": float("inf")}, "spacing must be a finite number above 0, not inf"),
        ({"spacing": 1e-9}, "exact up to 524,288"),
        ({"resolution": 600_000}, "exact up to 524,288"),
    ],
)
def test_an_unusable_density_is_refused_in_a_sentence(cube, density, sentence):
    with pytest.raises(ValueError, match=sentence):
        sample_mesh(cube(), **density)


@pytest.mark.parametrize("what", ["resolution", "count"])
def test_what_an_empty_mesh_cannot_mean_is_refused_in_a_sentence(what):
    with pytest.raises(ValueError, match=f"A {what} means nothing .*; give a spacing instead"):
        grid_spacing(EMPTY, **{what: 8})


@pytest.mark.parametrize(
    "option",
    [
        {"reduction": "best"},
        {"splat_size": 0},
        {"splat_size": float("nan")},
        {"grazing_angle": 0.9},
        {"grazing_angle": 1.6},
        {"grazing_angle": float("nan")},
    ],
)
def test_an_unusable_option_is_refused_in_a_sentence(cube, option):
    with pytest.raises(ValueError, match=r"must .*, not .*\."):
        sample_mesh(cube(), resolution=8, **option)


@pytest.mark.parametrize(
    "fields",
    [
        {"positions": np.zeros((4, 2))},
        {"triangles": np.zeros((1, 4), int)},
        {"triangles": np.zeros((1, 3))},
        {"triangles": np.array([[0, 1, 8]])},
        {"triangles": np.array([[0, 1, -1]])},
        {"corner_normals": np.zeros((1, 3, 3))},
        {"corner_uvs": np.zeros((12, 3, 2), int)},
        {"materials": np.full(12, -1)},
    ],
)
def test_a_mesh_of_the_wrong_shape_is_refused_in_a_sentence(cube, fields):
    mesh = cube()
    with pytest.raises(ValueError, match=r"must .*, not .*\.$"):
        TriangleMesh(**{"positions": mesh.positions, "triangles": mesh.triangles, **fields})


def test_progress_rises_to_the_end(sphere):
    shares = []
    sample_mesh(sphere, resolution=64, progress=shares.append)
    assert shares == sorted(shares) and shares[-1] == 1 and len(shares) > 3


def test_progress_that_returns_false_cancels(sphere):
    with pytest.raises(SamplingCancelled):
        sample_mesh(sphere, resolution=64, progress=lambda share: share < 0.6)
