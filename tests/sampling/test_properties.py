# SPDX-License-Identifier: GPL-3.0-or-later
"""What holds for any mesh: random triangles, slivers, intersecting and touching ones."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from scripts.coverage import uncovered_points
from splat_addon.sampling import REDUCTIONS, TriangleMesh, drop_unusable, grid_spacing, sample_mesh, sample_surface

RESOLUTION = 64


def soup(kind: str, seed: int, count: int = 30) -> TriangleMesh:
    """Random triangles in the unit cube, each with vertices of its own."""
    random = np.random.default_rng(seed)
    corners = random.random((count, 3, 3))
    corners[0, :2] = (0, 0, 0), (1, 1, 1)
    return TriangleMesh(SHAPES[kind](corners, random).reshape(-1, 3), np.arange(3 * count).reshape(-1, 3))


def on_quarter_cells(corners, random):
    """Corners on multiples of a quarter of a cell, so that many edges run through cell centres."""
    return np.rint(corners * 4 * RESOLUTION) / (4 * RESOLUTION)


def slivers(corners, random):
    corners[1:, 2] = corners[1:, 0] + random.random((len(corners) - 1, 1)) * (corners[1:, 1] - corners[1:, 0])
    corners[1:, 2] += random.normal(size=(len(corners) - 1, 3)) * 10.0 ** random.integers(-9, -1, (len(corners) - 1, 1))
    return corners


def coincident(corners, random):
    """Coplanar and overlapping: all in one of three planes."""
    for triangle in corners[1:]:
        triangle[:, random.integers(3)] = 0.5
    return corners


SHAPES = {
    "intersecting": lambda corners, random: corners,
    "on quarter cells": on_quarter_cells,
    "slivers": slivers,
    "coincident": coincident,
}

meshes = st.builds(soup, st.sampled_from(sorted(SHAPES)), st.integers(0, 2**31))
fast = settings(deadline=None, max_examples=20)


def rows(surfels):
    """One line of bytes a surfel, sorted: the set, whatever its order."""
    fields = surfels.positions, surfels.rotations, surfels.scales, surfels.normals, surfels.colors
    return sorted(map(bytes, np.concatenate(fields, axis=1)))


@fast
@given(meshes, st.randoms(use_true_random=False))
def test_the_order_of_the_triangles_does_not_matter(mesh, random):
    """Up to the order of the surfels; the sets are equal bit by bit."""
    order = list(range(len(mesh)))
    random.shuffle(order)
    shuffled = TriangleMesh(mesh.positions, mesh.triangles[order])
    assert rows(sample_mesh(mesh, resolution=RESOLUTION)) == rows(sample_mesh(shuffled, resolution=RESOLUTION))


@fast
@given(meshes)
def test_reductions_by_normals_keep_subsets_and_3_to_1_merges(mesh):
    cells = {}
    for reduction in REDUCTIONS:
        sampling = sample_surface(mesh, resolution=RESOLUTION, reduction=reduction)
        kept = len(sampling.surfels) - sampling.small_parts
        cells[reduction] = set(map(bytes, sampling.surfels.scales[:kept])), sampling.surfels.positions[:kept]
    whole = set(map(bytes, cells["none"][1]))
    for reduction in ("normal", "grazing"):
        assert set(map(bytes, cells[reduction][1])) <= whole
    spacing = np.float32(grid_spacing(mesh, resolution=RESOLUTION))
    nodes = [set(map(tuple, np.floor(cells[r][1] / spacing).astype(int))) for r in ("none", "three_to_one")]
    assert nodes[0] == nodes[1] and len(nodes[1]) == len(cells["three_to_one"][1])


@fast
@given(st.integers(0, 2**31))
def test_surfels_lie_on_their_triangle_within_float32(seed):
    """1e-5 cells: what float32 leaves of a coordinate up to 64 cells is 4e-6."""
    mesh = drop_unusable(soup("intersecting", seed, count=1))[0]
    surfels = sample_mesh(mesh, resolution=RESOLUTION)
    spacing = grid_spacing(mesh, resolution=RESOLUTION)
    a, b, c = mesh.positions[mesh.triangles[0]]
    normal = np.cross(b - a, c - a)
    height = np.linalg.norm(normal) / max(np.linalg.norm(e) for e in (b - a, c - b, a - c))
    away = (surfels.origin + surfels.positions.astype(np.float64) - a) @ (normal / np.linalg.norm(normal)) / spacing
    # a sliver thinner than a cell is off by its snapping, 1 / 16384 of a cell along its edges
    assert np.abs(away).max() <= (1e-5 if height > spacing else 1e-3)


@fast
@given(meshes)
def test_each_ray_meets_each_triangle_at_most_once(mesh):
    """One sample per ray and surface: no two surfels of one triangle share a ray."""
    alone = TriangleMesh(mesh.positions, mesh.triangles[:1])
    sampling = sample_surface(alone, resolution=RESOLUTION)
    kept = len(sampling.surfels) - sampling.small_parts
    cells = np.floor(sampling.surfels.positions[:kept] / np.float32(grid_spacing(alone, resolution=RESOLUTION)))
    axis = np.abs(sampling.surfels.geometric_normals()[:kept].sum(axis=0)).argmax()
    assert len(np.unique(np.delete(cells, axis, axis=1), axis=0)) == kept


@pytest.mark.parametrize("resolution", [128, 256])
def test_the_default_splats_leave_at_most_1_point_in_10000_of_the_armadillo_bare(armadillo, resolution):
    surfels = sample_mesh(armadillo, resolution=resolution)
    bare = uncovered_points(armadillo, surfels, grid_spacing(armadillo, resolution=resolution), 100_000)
    assert len(bare) <= 10


def test_what_is_bare_of_the_truck_lies_on_faces_narrower_than_a_cell(truck):
    """Such a strip between creases may lie between all rays, and its neighbours' splats face another way."""
    import trimesh

    mesh, _ = drop_unusable(truck)
    spacing = grid_spacing(mesh, resolution=64)
    bare = uncovered_points(mesh, sample_mesh(mesh, resolution=64), spacing, 100_000)
    exact = trimesh.Trimesh(mesh.positions, mesh.triangles, process=False)
    corners = mesh.positions[mesh.triangles[trimesh.proximity.closest_point(exact, bare)[2]]]
    edges = corners - np.roll(corners, 1, axis=1)
    width = np.linalg.norm(np.cross(edges[:, 0], edges[:, 1]), axis=1) / np.linalg.norm(edges, axis=2).max(axis=1)
    assert 0 < len(bare) < 100 and (width < spacing).all()
