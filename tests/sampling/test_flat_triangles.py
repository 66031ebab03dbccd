# SPDX-License-Identifier: GPL-3.0-or-later
"""Large surfels inside flat triangles: they cover what they replace, stay away from edges, and look like it."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from splat_addon.images import Image
from splat_addon.reference.bare import uncovered_points
from splat_addon.sampling import (
    Channel,
    Surface,
    Texture,
    Tolerance,
    TriangleMesh,
    VertexColors,
    grid_spacing,
    sample_surface,
)

OPTIONS = {"tolerance": Tolerance(0.0), "crease_angle": 0.35, "fits_blending": True, "fits_planes": True}


def made(mesh, resolution=100, **options):
    return sample_surface(mesh, resolution=resolution, **OPTIONS, **options)


def are_large(surfels, spacing):
    return surfels.scales[:, 1] > 2 * spacing


def triangles_of(mesh, places):
    """(n,) the triangle that each place lies in, and (n,) how far it is from that triangle's outline, within it."""
    corners = mesh.positions[mesh.triangles]
    edges = np.roll(corners, -1, axis=1) - corners
    normals = np.cross(edges[:, 0], edges[:, 1])
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    inward = np.cross(normals[:, None], edges)
    inward /= np.linalg.norm(inward, axis=2, keepdims=True)
    offset = places[:, None, None] - corners
    inside = np.einsum("ntck,tck->ntc", offset, inward).min(axis=2)
    off = np.abs(np.einsum("ntk,tk->nt", offset[:, :, 0], normals))
    inside[off > 1e-5] = -np.inf
    best = inside.argmax(axis=1)
    return best, inside[np.arange(len(places)), best]


def test_a_flat_square_needs_few(square):
    sampling = made(square(), 200)
    surfels, spacing = sampling.surfels, 1 / 200
    assert len(surfels) + sampling.saved == 200**2 and len(surfels) < 200**2 / 6
    sizes, counts = np.unique(np.round(surfels.scales[:, 0] / spacing, 3), return_counts=True)
    assert sizes.tolist() == pytest.approx([1.25, 2.55, 7.65]) and counts[2] * 81 > 200**2 / 2
    assert np.abs((surfels.origin + surfels.positions)[:, 2]).max() < 1e-7
    assert (surfels.normals == (0, 0, 1)).all()


@settings(deadline=None, max_examples=10)
@given(angles=st.tuples(*[st.floats(-3, 3)] * 3), resolution=st.sampled_from([40, 97, 160]))
def test_nothing_is_bare_and_no_large_surfel_reaches_an_edge(angles, resolution, box):
    from scipy.spatial.transform import Rotation

    mesh = TriangleMesh(Rotation.from_euler("xyz", angles).apply(box.positions), box.triangles)
    sampling, spacing = made(mesh, resolution), grid_spacing(mesh, resolution=resolution)
    assert sampling.saved
    assert len(uncovered_points(mesh, sampling.surfels, spacing)) == 0
    large = are_large(sampling.surfels, spacing)
    places = (sampling.surfels.origin + sampling.surfels.positions)[large]
    _, inside = triangles_of(mesh, places)
    # seen along the image's axis they are discs, which slanting faces stretch at most to their larger half-axis
    assert (inside > sampling.surfels.scales[large, 1]).all()


@pytest.fixture(scope="module")
def box():
    """A box of 1 x 0.8 x 0.6."""
    import trimesh

    shape = trimesh.creation.box((1, 0.8, 0.6))
    return TriangleMesh(shape.vertices, shape.faces)


@pytest.mark.parametrize("count", [2, 5])
def test_blocks_of_the_grid_give_the_same_bit_by_bit(count, box):
    from splat_addon.sampling import joined_blocks, sample_block

    options = {"resolution": 90, **OPTIONS}
    whole = sample_surface(box, **options)
    joined = joined_blocks(box, [sample_block(box, k, count, **options) for k in range(count)], **options)
    assert joined.saved == whole.saved > 1000
    mine, other = joined.surfels.arrays(), whole.surfels.arrays()
    assert all(mine[field].tobytes() == other[field].tobytes() for field in other)


def turning(mesh):
    normals = np.tile(mesh.corner_normals if mesh.corner_normals is not None else (0, 0, 1.0), (len(mesh), 3, 1))
    normals[:, 1, 0] = 0.02
    return {"corner_normals": normals}


def fading(mesh):
    colors = np.full((len(mesh), 3, 4), 0.5)
    colors[:, 1, 0] = 0.51
    return {"corner_colors": colors, "surfaces": (Surface(Channel((1, 1, 1, 1), VertexColors())),)}


def painted(mesh):
    image = Image(np.random.default_rng(3).uniform(size=(16, 16, 4)).astype(np.float32))
    uvs = mesh.positions[mesh.triangles][..., :2]
    return {"corner_uvs": uvs, "surfaces": (Surface(Channel((1, 1, 1, 1), Texture(image))),)}


@pytest.mark.parametrize("fields", [turning, fading, painted])
def test_what_varies_inside_a_triangle_stays_small(fields, square):
    plain = square()
    mesh = TriangleMesh(plain.positions, plain.triangles, **fields(plain))
    assert made(mesh).saved == 0


def test_an_image_that_is_looked_up_may_vary(square):
    plain = square()
    mesh = TriangleMesh(plain.positions, plain.triangles, **painted(plain))
    sampling = made(mesh, texture_mapped=True)
    surfels, spacing = sampling.surfels, 1 / 100
    large = are_large(surfels, spacing)
    assert sampling.saved and large.any()
    # texture coordinates are the place on the square, and change with it along the half-axes
    places, half_axes = surfels.origin + surfels.positions, surfels.half_axes()
    np.testing.assert_allclose(surfels.uvs, places[:, :2], atol=1e-6)
    for along, half_axis in zip((surfels.uv_along_x, surfels.uv_along_y), half_axes, strict=True):
        np.testing.assert_allclose(along, half_axis[:, :2], atol=1e-6)


def test_an_image_with_mirrored_coordinates_stays_in_small_surfels(square):
    """Along a disc, its coordinates would go on where they turn back."""
    plain = square()
    fields = painted(plain)
    (texture,) = fields["surfaces"][0].color.factors
    mirrored = Surface(Channel((1, 1, 1, 1), replace(texture, wraps=("MIRROR", "REPEAT"))))
    mesh = TriangleMesh(plain.positions, plain.triangles, **fields | {"surfaces": (mirrored,)})
    sampling = made(mesh, texture_mapped=True)
    assert sampling.surfels.has_uvs and sampling.saved == 0


def test_large_surfels_blend_with_none_but_their_own_plane(square):
    surfels = made(square(), 200).surfels
    depths = surfels.blend_depth * surfels.scales[:, 0]
    assert depths.max() < 0.1 / 200


def test_without_blend_depths_or_a_tolerance_all_have_the_same_size(square):
    assert sample_surface(square(), resolution=100, tolerance=Tolerance(0.0)).saved == 0
    assert sample_surface(square(), resolution=100, crease_angle=0.35, fits_blending=True).saved == 0


def test_a_tolerance_merges_what_is_left(box):
    spacing = grid_spacing(box, resolution=150)
    options = OPTIONS | {"tolerance": Tolerance(0.1 * spacing)}
    both = sample_surface(box, resolution=150, **options)
    assert len(both.surfels) < len(made(box, 150).surfels)
    assert len(uncovered_points(box, both.surfels, spacing)) == 0
