# SPDX-License-Identifier: GPL-3.0-or-later
"""Facts that hold for every mesh: random, degenerate, sliver, coincident and self-intersecting triangles, closed or
not.
"""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial import cKDTree

from splat_addon.reference.bare import uncovered_points
from splat_addon.sampling import REDUCTIONS, Channel, Surface, TriangleMesh, VertexColors, drop_unusable, grid_spacing
from splat_addon.sampling import sample as sample_module
from splat_addon.sampling.ldc import scan_conversion
from splat_addon.sampling.mesh import triangle_mesh as mesh_module
from tests.plain import sample_mesh, sample_surface
from tests.sampling.distances import distances

RESOLUTION = 64

PAINTED = (Surface(color=Channel((1.0, 1.0, 1.0, 1.0), VertexColors())),)


def soup(kind: str, seed: int, count: int = 30) -> TriangleMesh:
    """Random triangles in the unit cube that share no vertices."""
    random = np.random.default_rng(seed)
    corners = random.random((count, 3, 3))
    corners[0, :2] = (0, 0, 0), (1, 1, 1)
    return TriangleMesh(SHAPES[kind](corners, random).reshape(-1, 3), np.arange(3 * count).reshape(-1, 3))


def on_quarter_cells(corners, random):
    """Triangles with corners at multiples of a quarter of a cell, so that many edges run through cell centres."""
    return np.rint(corners * 4 * RESOLUTION) / (4 * RESOLUTION)


def slivers(corners, random):
    corners[1:, 2] = corners[1:, 0] + random.random((len(corners) - 1, 1)) * (corners[1:, 1] - corners[1:, 0])
    corners[1:, 2] += random.normal(size=(len(corners) - 1, 3)) * 10.0 ** random.integers(-9, -1, (len(corners) - 1, 1))
    return corners


def coincident(corners, random):
    """Coplanar, overlapping triangles, each in one of three planes."""
    for triangle in corners[1:]:
        triangle[:, random.integers(3)] = 0.5
    return corners


def degenerate(corners, random):
    """Triangles with collinear corners, or with two or three corners at one place; one in four is sound."""
    a, b = corners[1::4], corners[2::4]
    a[:, 2] = a[:, 0] + random.random((len(a), 1)) * (a[:, 1] - a[:, 0])
    b[:, 2] = b[:, random.integers(2)]
    corners[3::4, 1:] = corners[3::4, :1]
    return corners


SHAPES = {
    "intersecting": lambda corners, random: corners,
    "degenerate": degenerate,
    "on quarter cells": on_quarter_cells,
    "slivers": slivers,
    "coincident": coincident,
}

meshes = st.builds(soup, st.sampled_from(sorted(SHAPES)), st.integers(0, 2**31))
few = settings(max_examples=settings.default.max_examples // 5)


def rows(surfels):
    """The bytes of each surfel, sorted: equal for equal sets of surfels in any order."""
    fields = surfels.positions, surfels.rotations, surfels.scales, surfels.normals, surfels.colors
    return sorted(map(bytes, np.concatenate(fields, axis=1)))


@few
@given(meshes, st.randoms(use_true_random=False))
def test_the_order_of_the_triangles_does_not_matter(mesh, random):
    """Only the order of the surfels may change; the sets are equal bit by bit."""
    order = list(range(len(mesh)))
    random.shuffle(order)
    shuffled = TriangleMesh(mesh.positions, mesh.triangles[order])
    assert rows(sample_mesh(mesh, resolution=RESOLUTION)) == rows(sample_mesh(shuffled, resolution=RESOLUTION))


@few
@given(meshes)
def test_reductions_by_normals_keep_subsets_and_3_to_1_merges(mesh):
    cells = {}
    for reduction in REDUCTIONS:
        sampling = sample_surface(mesh, resolution=RESOLUTION, reduction=reduction)
        kept = len(sampling.surfels) - sampling.small_parts
        cells[reduction] = set(map(bytes, sampling.surfels.scales[:kept])), sampling.surfels.positions[:kept]
    whole = set(map(bytes, cells["none"][1]))
    for reduction in ("normal", "surfel_normal", "grazing"):
        assert set(map(bytes, cells[reduction][1])) <= whole
    spacing = np.float32(grid_spacing(mesh, resolution=RESOLUTION))
    nodes = [set(map(tuple, np.floor(cells[r][1] / spacing).astype(int))) for r in ("none", "three_to_one")]
    assert nodes[0] == nodes[1] and len(nodes[1]) == len(cells["three_to_one"][1])


def farthest(resolution):
    """The largest distance, in H, of a surfel from its triangle.

    Float32 rounds a coordinate by 2^-25 or 2^-24 of its value, which is at most half the longest edge plus 8 cells.
    Snapping moves the outline by 0.71 sub-cells, of which there are at least 2^24 along the longest edge. See
    docs/evidence/conversion.md.
    """
    return (np.sqrt(3) * min(resolution, resolution / 2 + 8) + 0.71 * resolution) * 2.0**-24


@settings(max_examples=settings.default.max_examples // 2)
@given(meshes, st.sampled_from([7, 64, 97, 256, 1024]))
def test_surfels_lie_on_their_triangles_within_float32(mesh, resolution):
    """This is 1e-5 H up to resolution 97, for triangles of any shape, including slivers."""
    few = 8 if resolution < 100 else 3
    mesh, _ = drop_unusable(TriangleMesh(mesh.positions[: 3 * few], mesh.triangles[:few]))
    sampling = sample_surface(mesh, resolution=resolution)
    kept = len(sampling.surfels) - sampling.small_parts
    spacing = grid_spacing(mesh, resolution=resolution)
    points = sampling.surfels.origin + sampling.surfels.positions[:kept].astype(np.float64)
    points = points[:: max(len(points) // 20_000, 1)]
    corners = np.moveaxis(mesh.positions[mesh.triangles], 1, 0)
    away = np.min([distances(points, *triangle) for triangle in np.moveaxis(corners, 1, 0)], axis=0, initial=np.inf)
    bound = farthest(resolution)
    assert resolution > 97 or bound < 1e-5
    # the origin, in float64, is rounded too
    assert away.max(initial=0) / spacing <= bound + 1e-9


@few
@given(meshes)
def test_normals_and_frames_are_unit_vectors(mesh):
    surfels = sample_mesh(mesh, resolution=RESOLUTION, reduction="none")
    for vectors in (surfels.normals, surfels.rotations, surfels.geometric_normals()):
        assert np.abs(np.linalg.norm(vectors.astype(np.float64), axis=1) - 1).max(initial=0) < 5e-7


@few
@given(
    st.sampled_from(["random", "flat", "needles", "on quarter cells"]),
    st.integers(0, 2**31),
    st.floats(-6, 6),
    st.sampled_from([0.0, 1e7, -1e7]),
)
def test_no_ray_meets_closed_surfaces_an_odd_number_of_times(rays, shape, seed, power, offset):
    """The surfaces are tetrahedra that intersect and touch; moving and scaling them in float64 keeps them closed."""
    mesh = tetrahedra(shape, seed)
    scale = 10.0**power
    _, images = rays(TriangleMesh(mesh.positions * scale + offset * scale, mesh.triangles), RESOLUTION)
    counts = [np.unique(hits, axis=0, return_counts=True)[1] for hits in images if len(hits)]
    assert sum(map(len, counts)) > 0 and not any((count % 2).any() for count in counts)


def tetrahedra(shape: str, seed: int, count: int = 8) -> TriangleMesh:
    """Closed tetrahedra that share no vertices."""
    random = np.random.default_rng(seed)
    corners = random.random((count, 4, 3))
    corners[0, :2] = (0, 0, 0), (1, 1, 1)
    if shape == "flat":
        corners[1:, :, random.integers(3)] *= 1e-9
    if shape == "needles":
        corners[1:, 1:] = corners[1:, :1] + (corners[1:, 1:] - corners[1:, :1]) * (1, 1e-7, 1e-7)
    if shape == "on quarter cells":
        corners = np.rint(corners * 4 * RESOLUTION) / (4 * RESOLUTION)
    faces = np.array([(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)])
    triangles = (faces + 4 * np.arange(count)[:, None, None]).reshape(-1, 3)
    return TriangleMesh(corners.reshape(-1, 3), triangles)


@few
@given(meshes, st.integers(-20, 20), st.sampled_from([0, 1, -1]))
def test_scale_and_place_change_nothing_but_the_numbers(mesh, power, side):
    """Vertices at multiples of 2^-27 of the box can be scaled and moved without rounding.

    So after scales of 2^-20 to 2^20 or 1e-6 to 1e6, and moves by 1e7 times the size, surfels are equal bit by bit,
    except for the scale.
    """
    near = TriangleMesh(np.rint(mesh.positions * 2**27) / 2**27, mesh.triangles)
    scale, offset = 2.0**power, side * 1e7
    far = TriangleMesh((near.positions + offset) * scale, near.triangles)
    a, b = (sample_mesh(m, resolution=RESOLUTION) for m in (near, far))
    assert len(a) == len(b) > 0
    assert (a.positions * np.float32(scale) == b.positions).all() and (a.scales * np.float32(scale) == b.scales).all()
    assert (a.rotations == b.rotations).all() and (a.normals == b.normals).all()
    assert (b.origin == (a.origin + offset) * scale).all()


@few
@given(meshes, st.floats(-6, 6))
def test_any_scale_gives_the_same_within_rounding(mesh, power):
    """A scale that is not a power of two rounds vertices in their 16th digit, which may move a sample across an
    edge.
    """
    scale, spacing = 10.0**power, np.float32(grid_spacing(mesh, resolution=RESOLUTION))
    samplings = [
        sample_surface(TriangleMesh(mesh.positions * factor, mesh.triangles), resolution=RESOLUTION)
        for factor in (1.0, scale)
    ]
    near, far = (s.surfels.positions[: len(s.surfels) - s.small_parts] for s in samplings)
    near, far = near / spacing, far / np.float32(spacing * scale)
    alone = sum(
        np.isinf(cKDTree(b).query(a, distance_upper_bound=0.01)[0]).sum() for a, b in ((near, far), (far, near))
    )
    assert alone <= 2 + len(near) // 100


@few
@given(meshes, st.integers(1, 40), st.integers(1, 3000), st.integers(1, 3000))
def test_chunks_and_batches_of_any_size_give_the_same(mesh, chunk, rows, samples):
    colors = np.random.default_rng(0).random((len(mesh), 3, 4))
    mesh = TriangleMesh(
        mesh.positions, mesh.triangles, corner_normals=colors[..., :3] - 0.5, corner_colors=colors, surfaces=PAINTED
    )
    whole = sample_mesh(mesh, resolution=RESOLUTION)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(mesh_module.triangle_chunks, "__defaults__", (chunk,))
        patch.setattr(scan_conversion, "BATCH", rows)
        patch.setattr(sample_module, "BATCH", samples)
        parts = sample_mesh(mesh, resolution=RESOLUTION)
    assert all((array == parts.arrays()[name]).all() for name, array in whole.arrays().items())


@few
@given(meshes)
def test_each_ray_meets_each_triangle_at_most_once(mesh):
    """There is one sample per ray and surface, so no two surfels of a triangle share a ray."""
    alone = TriangleMesh(mesh.positions, mesh.triangles[:1])
    sampling = sample_surface(alone, resolution=RESOLUTION)
    kept = len(sampling.surfels) - sampling.small_parts
    cells = np.floor(sampling.surfels.positions[:kept] / np.float32(grid_spacing(alone, resolution=RESOLUTION)))
    axis = np.abs(sampling.surfels.geometric_normals()[:kept].sum(axis=0)).argmax()
    assert len(np.unique(np.delete(cells, axis, axis=1), axis=0)) == kept


@settings(max_examples=settings.default.max_examples // 10)
@given(st.integers(0, 2**31), st.sampled_from([0.0, 0.1, 0.3]))
def test_at_most_3_points_in_10000_of_a_random_closed_surface_are_bare(seed, roughness):
    """The surfaces are stretched, turned and dented spheres; creases of the dents cross the regions of all axes."""
    import trimesh

    random = np.random.default_rng(seed)
    ball = trimesh.creation.icosphere(subdivisions=3)
    waves = np.sin(ball.vertices @ random.normal(size=(3, 4)) * 5).sum(axis=1)
    linear = np.linalg.qr(random.normal(size=(3, 3)))[0] * random.uniform(0.3, 1, 3)
    mesh = TriangleMesh(ball.vertices * (1 + roughness * waves[:, None] / 4) @ linear, ball.faces)
    bare = uncovered_points(mesh, sample_mesh(mesh, resolution=96), grid_spacing(mesh, resolution=96), 20_000)
    assert len(bare) <= 6


@pytest.mark.parametrize("resolution", [128, 256])
def test_the_default_splats_leave_at_most_1_point_in_10000_of_the_armadillo_bare(armadillo, resolution):
    surfels = sample_mesh(armadillo, resolution=resolution)
    bare = uncovered_points(armadillo, surfels, grid_spacing(armadillo, resolution=resolution), 100_000)
    assert len(bare) <= 10


def test_what_is_bare_of_the_truck_lies_on_faces_narrower_than_a_cell(truck):
    """A narrow strip between creases may lie between all rays, and the splats beside it face another way."""
    import trimesh

    mesh, _ = drop_unusable(truck)
    spacing = grid_spacing(mesh, resolution=64)
    bare = uncovered_points(mesh, sample_mesh(mesh, resolution=64), spacing, 100_000)
    exact = trimesh.Trimesh(mesh.positions, mesh.triangles, process=False)
    corners = mesh.positions[mesh.triangles[trimesh.proximity.closest_point(exact, bare)[2]]]
    edges = corners - np.roll(corners, 1, axis=1)
    width = np.linalg.norm(np.cross(edges[:, 0], edges[:, 1]), axis=1) / np.linalg.norm(edges, axis=2).max(axis=1)
    assert 0 < len(bare) < 100 and (width < spacing).all()
