# SPDX-License-Identifier: GPL-3.0-or-later
"""A part of a mesh that no ray hits gets one surfel; parts that are hit get none of these."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from splat_addon.sampling import Channel, Surface, Texture, TriangleMesh, VertexColors
from splat_addon.sampling.mesh.connectivity import part_labels
from tests.plain import sample_surface

#: With this spacing all rays miss a small part near the origin, because they are at odd multiples of half of it.
SPACING = 1.0


def joined(*meshes):
    """One mesh made of several, without optional fields."""
    starts = np.cumsum([0, *(len(mesh.positions) for mesh in meshes)])
    triangles = [mesh.triangles + start for mesh, start in zip(meshes, starts, strict=False)]
    return TriangleMesh(np.concatenate([mesh.positions for mesh in meshes]), np.concatenate(triangles))


def placed(mesh, scale, offset):
    return TriangleMesh(mesh.positions * scale + offset, mesh.triangles)


def test_a_patch_between_the_rays_gets_one_disc_of_its_area_at_its_centroid(square):
    sampling = sample_surface(placed(square(), 0.2, (5.0, 6.0, 7.0)), spacing=SPACING)
    surfels = sampling.surfels
    assert sampling.small_parts == len(surfels) == 1
    assert np.allclose(surfels.origin + surfels.positions, (5.1, 6.1, 7.0))
    assert np.allclose(surfels.geometric_normals(), (0, 0, 1))
    assert np.pi * surfels.radius[0] ** 2 == pytest.approx(0.2**2, rel=1e-5)


@pytest.mark.parametrize("axis", [0, 1, 2])
@pytest.mark.parametrize("sign", [1, -1])
def test_the_disc_faces_the_way_of_the_winding(square, axis, sign):
    turned = np.roll(square(0.2).positions, axis + 1, axis=1)
    patch = TriangleMesh(turned, square().triangles[:, ::sign])
    normal = sample_surface(patch, spacing=SPACING).surfels.geometric_normals()
    assert np.allclose(normal, sign * np.eye(3)[axis], atol=1e-6)


def test_a_closed_part_gets_a_disc_as_large_as_it_is_seen(cube):
    """Seen along an axis a cube shows one face, although its mean normal is zero."""
    surfels = sample_surface(placed(cube(), 0.2, 0.1), spacing=SPACING).surfels
    assert np.allclose(surfels.origin + surfels.positions, 0.2)
    assert np.pi * surfels.radius[0] ** 2 == pytest.approx(0.2**2, rel=1e-5)


def test_a_long_thin_part_gets_no_disc_beyond_the_size_of_a_splat(square):
    rod = TriangleMesh(square().positions * (0.3, 40, 1), square().triangles)
    surfels = sample_surface(rod, spacing=SPACING, splat_size=1.25).surfels
    assert len(surfels) == 1 and surfels.radius[0] == 1.25


def test_small_parts_come_last_and_are_counted(cube, square):
    bolts = [placed(square(), 0.2, (0.6 + 2 * k, 0.6, 5.0)) for k in range(4)]
    mesh = joined(*bolts, placed(cube(), 10, 0.0))
    sampling = sample_surface(mesh, spacing=SPACING)
    assert sampling.small_parts == 4 and len(sampling.surfels) == 600 + 4
    assert np.allclose(np.sort(sampling.surfels.positions[-4:, 0]), [0.7, 2.7, 4.7, 6.7])


@pytest.mark.parametrize("reduction", ["none", "grazing", "normal", "surfel_normal", "three_to_one"])
def test_every_reduction_finds_the_same_lost_part(cube, square, reduction):
    mesh = joined(placed(cube(), 10, 0.0), placed(square(), 0.2, (0.6, 0.6, 5.0)))
    assert sample_surface(mesh, spacing=SPACING, reduction=reduction).small_parts == 1


def test_an_unsampled_triangle_of_a_sampled_part_gets_nothing(sphere):
    """With 81,920 triangles and a few hundred samples, almost no triangle has a sample."""
    sampling = sample_surface(sphere, resolution=12)
    assert sampling.small_parts == 0 and len(sampling.surfels) < 1000


def test_triangles_that_share_positions_are_one_part_whatever_their_indices(sphere):
    loose = TriangleMesh(sphere.positions[sphere.triangles].reshape(-1, 3), np.arange(81920 * 3).reshape(-1, 3))
    assert sample_surface(loose, resolution=12).small_parts == 0
    assert sample_surface(placed(loose, 0.2, 0.3), spacing=SPACING).small_parts == 1


def test_a_part_without_measurable_area_is_still_one_finite_surfel(triangle):
    """On the grid all its corners are the same point."""
    mesh = triangle((0, 0, 0), (1e-25, 0, 0), (0, 1e-25, 0))
    sampling = sample_surface(mesh, spacing=SPACING)
    assert sampling.small_parts == 1 and 0 < sampling.surfels.radius[0] < 0.01


def test_a_small_part_has_the_material_colour_and_normal_of_its_faces(square):
    normals, colors = np.tile((0.6, 0, 0.8), (2, 3, 1)), np.tile((0.5, 1, 0, 1), (2, 3, 1))
    surfaces = Surface(), Surface(Channel((1, 0.5, 1, 1), VertexColors()))
    mesh = square(0.2, corner_normals=normals, corner_colors=colors, materials=np.ones(2, int), surfaces=surfaces)
    surfels = sample_surface(mesh, spacing=SPACING).surfels
    assert surfels.materials.tolist() == [1] and np.allclose(surfels.colors, (0.5, 0.5, 0, 1))
    assert np.allclose(surfels.normals, (0.6, 0, 0.8))


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("broken", [0, np.nan, np.inf, 1e300])
def test_a_broken_shading_normal_falls_back_to_the_parts_own(square, broken):
    surfels = sample_surface(square(0.2, corner_normals=np.full((2, 3, 3), float(broken))), spacing=SPACING).surfels
    assert np.allclose(surfels.normals, (0, 0, 1))


def test_a_textured_small_part_has_the_mean_of_its_texture(square):
    from splat_addon.sampling import Image

    checks = np.ones((64, 64, 4), np.float32)
    checks[::2, ::2, :3] = checks[1::2, 1::2, :3] = 0
    uvs = np.array([(0, 0), (1, 0), (1, 1), (0, 1)], float)[[[0, 1, 2], [0, 2, 3]]]
    mesh = square(0.2, corner_uvs=uvs, surfaces=(Surface(Channel((1, 1, 1, 1), Texture(Image(checks)))),))
    assert np.allclose(sample_surface(mesh, spacing=SPACING).surfels.colors[0, :3], 0.5, atol=0.01)


@given(st.lists(st.tuples(*[st.integers(0, 30)] * 3), min_size=1, max_size=40))
def test_parts_are_the_connected_components(triangles):
    """The expected components are scipy's, for the same edges."""
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import connected_components

    corners = np.array(triangles)
    labels = part_labels(corners)
    rows, columns = corners[:, [0, 1]].ravel(), corners[:, [1, 2]].ravel()
    graph = coo_matrix((np.ones(len(rows)), (rows, columns)), shape=(len(labels),) * 2)
    _, theirs = connected_components(graph, directed=False)
    pairs = {(a, b) for a, b in zip(labels, theirs, strict=True)}
    assert len(pairs) == len(set(labels)) == len(set(theirs))


def test_a_long_strip_is_one_part():
    count = 3000
    corners = np.random.default_rng(0).permutation(count + 2)[np.arange(count)[:, None] + np.arange(3)]
    assert len(set(part_labels(corners))) == 1


def test_vertices_that_are_one_beforehand_join_their_parts():
    corners = np.arange(12).reshape(4, 3)
    twins = np.array([0, 1, 2, 0, 4, 5, 6, 7, 8, 9, 6, 11, 12])
    assert part_labels(corners, twins).tolist() == [0] * 6 + [6] * 6 + [12]
