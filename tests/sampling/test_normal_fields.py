# SPDX-License-Identifier: GPL-3.0-or-later
"""How normals change over surfels: on a sphere of radius R by (half-axis / R) along each half-axis, however they came
about."""

import math
from dataclasses import replace

import numpy as np
import pytest
import trimesh
from scipy.spatial import cKDTree

from splat_addon.hierarchy import build_hierarchy
from splat_addon.normal_fields import NORMAL_FIELDS, NORMAL_STEP, changes
from splat_addon.quaternions import axes_columns
from splat_addon.sampling import Tolerance, TriangleMesh, sample_mesh
from splat_addon.sampling.attributes.normal_changes import fields_on_triangles
from splat_addon.sampling.deform.deforming import DeformingSurfels
from splat_addon.surfels import concatenate

RADIUS = 2.0


def ball(radius=RADIUS, subdivisions=4):
    shape = trimesh.creation.icosphere(subdivisions, radius=radius)
    return TriangleMesh(shape.vertices, shape.faces, shape.vertices[shape.faces] / radius)


def off(surfels, radius=RADIUS):
    """(n,) relative difference of the changes from those of a sphere."""
    found = np.stack([getattr(surfels, name) for name in NORMAL_FIELDS], axis=1) * NORMAL_STEP
    wanted = np.einsum("nk,kc->nkc", surfels.scales / radius, np.eye(2))
    return np.linalg.norm(found - wanted, axis=(1, 2)) / np.linalg.norm(wanted, axis=(1, 2))


@pytest.fixture(scope="module")
def sampled():
    return sample_mesh(ball(), resolution=24, normal_fields=True)


def test_samples_have_the_change_of_their_triangles_normals(sampled):
    assert np.median(off(sampled)) < 0.02 and np.quantile(off(sampled), 0.98) < 0.15


def test_they_have_none_unless_it_is_asked_for_or_where_nothing_is_smooth(sampled):
    assert not sample_mesh(ball(), resolution=24).normals_change
    flat = TriangleMesh(ball().positions, ball().triangles)
    assert not sample_mesh(flat, resolution=24, normal_fields=True).normals_change
    cube = trimesh.creation.box()
    normals = np.repeat(cube.face_normals[:, None], 3, axis=1)
    flat = TriangleMesh(cube.vertices, cube.faces, normals)
    assert not sample_mesh(flat, resolution=8, normal_fields=True).normals_change


def test_surfels_that_fill_gaps_have_the_change_of_their_triangles(sampled):
    mesh = ball()
    middles = mesh.positions[mesh.triangles].mean(axis=1)
    near = cKDTree(middles).query(sampled.positions + sampled.origin)[1]
    fields = fields_on_triangles(mesh, near, sampled.arrays())
    assert np.median(off(replace(sampled, **fields))) < 0.03


def test_merged_discs_have_the_change_over_all_that_they_replace():
    tolerance = Tolerance(0.05 * RADIUS, angle=math.radians(30))
    merged = sample_mesh(ball(), resolution=48, normal_fields=True, tolerance=tolerance)
    least = merged.scales.min()
    larger = merged.scales.min(axis=1) > 1.5 * least
    assert larger.sum() > 100 and np.median(off(merged)[larger]) < 0.05


def test_levels_have_the_change_over_all_that_they_merge(sampled):
    nodes = build_hierarchy(sampled).nodes
    assert len(nodes) > 100
    assert np.median(off(nodes)) < 0.08
    assert build_hierarchy(sample_mesh(ball(), resolution=24)).nodes.normals_change is False


def test_levels_know_the_change_from_the_centres_too(sampled):
    """Samples whose own normals do not change: the merged ones find it from how these differ."""
    plain = {name: np.zeros_like(getattr(sampled, name)) for name in NORMAL_FIELDS}
    nodes = build_hierarchy(type(sampled)(**(sampled.arrays() | plain))).nodes
    coarse = nodes.scales.min(axis=1) > 6 * sampled.scales.min()
    assert coarse.any() and np.median(off(nodes)[coarse]) < 0.15


def test_a_shape_that_changes_takes_them_along():
    deforming = DeformingSurfels(ball(), resolution=24, normal_fields=True)
    turn = trimesh.transformations.rotation_matrix(0.7, (1, 2, 3))[:3, :3]
    rest = ball()
    moved, _ = deforming.at(TriangleMesh(3 * rest.positions @ turn.T, rest.triangles, rest.corner_normals @ turn.T))
    assert np.median(off(moved, 3 * RADIUS)) < 0.02
    flat = rest.positions * (1, 1, 0.5)
    normals = rest.positions * (1, 1, 2)
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    squashed = TriangleMesh(flat, rest.triangles, normals[rest.triangles])
    moved, _ = deforming.at(squashed)
    assert slope_error(moved) < 0.1


def slope_error(surfels) -> float:
    """The median relative error of what the fields say about an ellipsoid's normals half a half-axis away."""
    x, y = axes_columns(surfels.rotations.astype(float), 0, 1)
    along_x, _ = changes(surfels.arrays(), (x, y))
    places = (surfels.positions + surfels.origin).astype(float)

    def normals(points):
        found = points * (1, 1, 4)
        return found / np.linalg.norm(found, axis=1, keepdims=True)

    moved = normals(places + 0.1 * (x * surfels.scales[:, 0]).T)
    predicted = normals(places) + 0.1 * along_x.T
    predicted /= np.linalg.norm(predicted, axis=1, keepdims=True)
    change = np.linalg.norm(moved - normals(places), axis=1)
    return float(np.median(np.linalg.norm(moved - predicted, axis=1) / change))


def test_sets_with_and_without_can_be_joined(sampled):
    both = concatenate([sampled, sample_mesh(ball(), resolution=24)])
    assert not both.normal_along_x[len(sampled) :].any()
