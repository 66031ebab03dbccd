# SPDX-License-Identifier: GPL-3.0-or-later
"""Each reduction keeps the right samples of the full cube: subsets, a merge on a lattice, and counts predicted by
areas.
"""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from splat_addon.sampling import REDUCTIONS, TriangleMesh, predict_count, projected_area
from splat_addon.sampling.ldc.merging import nearest_to_lattice
from splat_addon.sampling.ldc.reductions import LEAST_GRAZING_ANGLE, keep_dominant, keep_facing
from tests.plain import sample_mesh

normals = st.tuples(*[st.floats(0, 1)] * 3).filter(any).map(lambda n: np.array(n)[:, None])


def rows(surfels):
    """The surfels as a set of tuples of bits."""
    return set(map(bytes, np.concatenate([surfels.positions, surfels.scales, surfels.normals], axis=1)))


@given(normals)
def test_the_normal_reduction_keeps_the_one_image_that_faces_the_surface_most(normal):
    kept = keep_dominant(normal, 0)
    assert kept.sum() == 1 and normal[kept] == normal.max()


@given(normals, st.floats(LEAST_GRAZING_ANGLE, math.pi / 2))
def test_no_surface_is_refused_by_all_images(normal, angle):
    assert keep_facing(normal, angle).any()


def test_grazing_rejection_keeps_what_is_seen_within_the_angle():
    tilted = np.array([[math.cos(math.radians(a)), math.sin(math.radians(a)), 0] for a in (10, 25, 65)]).T
    assert keep_facing(5 * tilted, math.radians(70)).tolist() == [[True] * 3, [False, True, True], [False] * 3]


def test_by_its_own_normal_a_surfel_stays_in_the_image_that_this_faces_most(armadillo):
    """With the triangle's normal this is the normal-based reduction; with smooth normals other samples stay."""
    flat = replace(armadillo, corner_normals=None)
    by_face, by_own = (sample_mesh(flat, resolution=64, reduction=r) for r in ("normal", "surfel_normal"))
    assert rows(by_face) == rows(by_own)
    smooth = replace(armadillo, corner_normals=smoothed(armadillo))
    by_face, by_own = (sample_mesh(smooth, resolution=64, reduction=r) for r in ("normal", "surfel_normal"))
    assert 10 < len(rows(by_own) - rows(by_face)) < 0.2 * len(by_own)
    axes = np.abs(by_own.normals).argmax(axis=1)
    seen = np.abs(by_own.geometric_normals()).argmax(axis=1)
    assert np.count_nonzero(axes != seen) > 10


def smoothed(mesh):
    """(T, 3, 3) corner normals: area-weighted means of the triangles around each vertex."""
    corners = mesh.positions[mesh.triangles]
    of_faces = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    sums = np.zeros_like(mesh.positions)
    np.add.at(sums, mesh.triangles, of_faces[:, None])
    return (sums / np.linalg.norm(sums, axis=1, keepdims=True))[mesh.triangles]


@pytest.mark.parametrize("reduction", ["normal", "surfel_normal", "grazing"])
def test_a_reduction_by_normals_keeps_a_subset_of_the_cube(armadillo, reduction):
    whole, reduced = (sample_mesh(armadillo, resolution=64, reduction=r) for r in ("none", reduction))
    assert rows(reduced) < rows(whole)


@pytest.mark.parametrize("reduction", REDUCTIONS)
def test_the_count_is_predicted_from_areas(sphere, reduction):
    count = len(sample_mesh(sphere, resolution=100, reduction=reduction))
    assert predict_count(sphere, resolution=100, reduction=reduction) == pytest.approx(count, rel=0.01)


@pytest.mark.parametrize("angle", [56, 70, 85])
def test_the_count_of_grazing_rejection_is_predicted_at_every_angle(sphere, angle):
    how = {"resolution": 100, "reduction": "grazing", "grazing_angle": math.radians(angle)}
    assert predict_count(sphere, **how) == pytest.approx(len(sample_mesh(sphere, **how)), rel=0.01)


def test_grazing_rejection_lies_between_the_other_two(sphere):
    angles = [math.radians(a) for a in (54.8, 60, 75, 90)]
    areas = [projected_area(sphere, "grazing", angle) for angle in angles]
    assert areas == sorted(areas) and areas[0] >= projected_area(sphere, "normal")
    assert areas[-1] == pytest.approx(projected_area(sphere, "none"))


def test_3_to_1_leaves_one_surfel_on_each_node_that_had_any(armadillo):
    spacing = float(np.ptp(armadillo.positions, axis=0).max()) / 64
    whole, merged = (sample_mesh(armadillo, spacing=spacing, reduction=r) for r in ("none", "three_to_one"))
    nodes = [np.floor(s.positions / np.float32(spacing)).astype(int) for s in (whole, merged)]
    assert len(np.unique(nodes[1], axis=0)) == len(merged)
    assert set(map(tuple, nodes[0])) == set(map(tuple, nodes[1]))
    assert np.abs(merged.positions / spacing - nodes[1] - 0.5).max() < 1e-4


def test_3_to_1_keeps_the_surfel_nearest_to_the_node():
    positions = np.array([(0.5, 0.5, 0.9), (0.5, 0.5, 0.6), (0.5, 0.5, 0.1), (1.5, 0.5, 0.5)], np.float32)
    merged = nearest_to_lattice({"positions": positions, "materials": np.arange(4)}, np.zeros(4, int), 1.0)
    assert merged["materials"].tolist() == [1, 3]
    assert merged["positions"].tolist() == [[0.5, 0.5, 0.5], [1.5, 0.5, 0.5]]


def test_3_to_1_of_nothing_is_nothing():
    assert len(nearest_to_lattice({"positions": np.zeros((0, 3), np.float32)}, np.zeros(0, int), 1.0)["positions"]) == 0


def test_3_to_1_merges_two_sheets_closer_than_a_cell_and_normal_does_not(square):
    near = square()
    far = TriangleMesh(
        np.concatenate([near.positions, near.positions + np.array([0, 0, 0.01])]),
        np.concatenate([near.triangles, near.triangles[:, ::-1] + 4]),
    )
    counts = {r: len(sample_mesh(far, resolution=10, reduction=r)) for r in ("three_to_one", "normal")}
    assert counts == {"three_to_one": 100, "normal": 200}
