# SPDX-License-Identifier: GPL-3.0-or-later
"""Large surfels inside flat faces: they cover what they replace, stay away from edges, and look like it."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from splat_addon.images import Image
from splat_addon.reference.bare import uncovered_points
from splat_addon.sampling import Channel, Surface, Texture, Tolerance, TriangleMesh, VertexColors, grid_spacing
from tests.plain import sample_surface

OPTIONS = {"tolerance": Tolerance(0.0), "crease_angle": 0.35, "fits_blending": True, "fits_planes": True}


def made(mesh, resolution=100, **options):
    return sample_surface(mesh, resolution=resolution, **OPTIONS, **options)


def are_large(surfels, spacing):
    return surfels.scales[:, 1] > 2 * spacing


def test_a_flat_square_needs_few(square):
    sampling = made(square(), 200)
    surfels, spacing = sampling.surfels, 1 / 200
    assert len(surfels) + sampling.saved == 200**2 and len(surfels) < 200**2 / 6
    sizes, counts = np.unique(np.round(surfels.scales[:, 0] / spacing, 3), return_counts=True)
    assert sizes.tolist() == pytest.approx([1.25, 2.55, 7.65]) and counts[2] * 81 > 200**2 / 2
    assert np.abs((surfels.origin + surfels.positions)[:, 2]).max() < 1e-7
    assert (surfels.normals == (0, 0, 1)).all()


@settings(max_examples=settings.default.max_examples // 5)
@given(angles=st.tuples(*[st.floats(-3, 3)] * 3), resolution=st.sampled_from([40, 97, 160]))
def test_nothing_is_bare_and_no_large_surfel_reaches_an_edge(angles, resolution, box):
    from scipy.spatial.transform import Rotation

    turn = Rotation.from_euler("xyz", angles)
    mesh = TriangleMesh(turn.apply(box.positions), box.triangles)
    sampling, spacing = made(mesh, resolution), grid_spacing(mesh, resolution=resolution)
    assert sampling.saved
    assert len(uncovered_points(mesh, sampling.surfels, spacing)) == 0
    large = are_large(sampling.surfels, spacing)
    places = (sampling.surfels.origin + sampling.surfels.positions)[large]
    # of the distances from three planes of the box, one is 0, and the next one that from the nearest edge
    inside = np.sort(np.abs(box.positions).max(axis=0) - np.abs(turn.inv().apply(places)), axis=1)[:, 1]
    # seen along the image's axis they are discs, which slanting faces stretch at most to their larger half-axis
    assert (inside > sampling.surfels.scales[large, 1]).all()


@pytest.fixture(scope="module")
def box():
    """A box of 1 x 0.8 x 0.6."""
    import trimesh

    shape = trimesh.creation.box((1, 0.8, 0.6))
    return TriangleMesh(shape.vertices, shape.faces)


@pytest.fixture(scope="module")
def plate():
    """A square of 1 with a round hole of 0.2 in the middle: 64 narrow triangles around it, in one plane."""
    turns = np.linspace(0, 2 * np.pi, 32, endpoint=False)
    around = np.stack([np.cos(turns), np.sin(turns), 0 * turns], axis=1)
    outer = 0.5 * around / np.abs(around).max(axis=1, keepdims=True)
    k, after = np.arange(32), (np.arange(32) + 1) % 32
    triangles = np.concatenate([np.stack([k, 32 + k, 32 + after], 1), np.stack([k, 32 + after, after], 1)])
    return TriangleMesh(np.concatenate([0.1 * around, outer]), triangles)


@pytest.mark.parametrize("count", [2, 5])
@pytest.mark.parametrize("shape", ["box", "plate"])
def test_blocks_of_the_grid_give_the_same_bit_by_bit(shape, count, request):
    from splat_addon.sampling import joined_blocks, sample_block

    mesh, options = request.getfixturevalue(shape), {"resolution": 90, **OPTIONS}
    whole = sample_surface(mesh, **options)
    joined = joined_blocks(mesh, [sample_block(mesh, k, count, **options) for k in range(count)], **options)
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


def painted(mesh, channels: int = 3):
    pixels = np.ones((16, 16, 4), np.float32)
    pixels[..., :channels] = np.random.default_rng(3).uniform(size=(16, 16, channels))
    image = Image(pixels)
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


def test_what_an_image_cuts_out_stays_in_small_surfels(square):
    """Its alpha is not looked up."""
    plain = square()
    cut_out = TriangleMesh(plain.positions, plain.triangles, **painted(plain, channels=4))
    sampling = made(cut_out, texture_mapped=True)
    assert sampling.surfels.has_uvs and sampling.saved == 0


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


def test_a_tolerance_merges_what_is_left():
    import trimesh

    can = trimesh.creation.cylinder(1, 1, sections=48)
    mesh = TriangleMesh(can.vertices, can.faces)
    spacing = grid_spacing(mesh, resolution=150)
    options = OPTIONS | {"tolerance": Tolerance(0.1 * spacing)}
    both = sample_surface(mesh, resolution=150, **options)
    assert len(both.surfels) < len(made(mesh, 150).surfels)
    assert len(uncovered_points(mesh, both.surfels, spacing)) == 0


def test_a_face_may_have_many_triangles_and_a_hole(plate):
    mesh, spacing = plate, 1 / 300
    sampling = made(mesh, 300)
    surfels = sampling.surfels
    assert len(surfels) + sampling.saved == len(sample_surface(mesh, resolution=300).surfels)
    assert len(surfels) < 0.3 * (len(surfels) + sampling.saved)
    assert len(uncovered_points(mesh, surfels, spacing)) == 0
    large = are_large(surfels, spacing)
    places = np.abs((surfels.origin + surfels.positions)[large])
    sizes = surfels.scales[large, 0]
    assert (0.5 - places.max(axis=1) > sizes).all() and (np.linalg.norm(places, axis=1) - 0.1 > sizes).all()


def test_triangles_that_will_be_moved_are_faces_of_their_own():
    """Two halves of a square may fold along their diagonal, over which no large surfel may reach."""
    mesh, spacing = (
        TriangleMesh([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)], np.array([(0, 1, 2), (0, 2, 3)])),
        1 / 200,
    )
    whole, halves = made(mesh, 200).surfels, made(mesh, 200, deforms=True).surfels

    def least_from_diagonal(surfels):
        large = are_large(surfels, spacing)
        x, y, _ = (surfels.origin + surfels.positions)[large].T
        return (np.abs(x - y) / np.sqrt(2) - surfels.scales[large, 0]).min()

    assert least_from_diagonal(whole) < 0 < least_from_diagonal(halves)


def striped(mesh):
    colors = np.ones((len(mesh), 3, 4))
    colors[1::2, :, 0] = 0.99
    return {"corner_colors": colors, "surfaces": (Surface(Channel((1, 1, 1, 1), VertexColors())),)}


def slotted(mesh):
    return {"materials": np.arange(len(mesh)) % 2, "surfaces": (Surface(), Surface())}


def leaning(mesh):
    normals = np.tile((0, 0, 1.0), (len(mesh), 3, 1))
    normals[1::2, :, 0] = 0.01
    return {"corner_normals": normals}


@pytest.mark.parametrize("fields", [striped, slotted, leaning])
def test_a_face_ends_where_its_look_changes(fields):
    triangles = np.array([(0, 1, 2), (0, 2, 3)])
    corners = np.array([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)], float)
    plain = TriangleMesh(corners, triangles)
    ended = made(TriangleMesh(corners, triangles, **fields(plain)), 100)
    assert ended.saved == made(plain, 100, deforms=True).saved < made(plain, 100).saved


def test_of_a_mapped_mesh_faces_without_an_image_go_on():
    """Two squares side by side, of two triangles each; the second one has an image."""
    corners = np.array([(x + dx, y, 0) for dx in (0, 2) for x, y in ((0, 0), (1, 0), (1, 1), (0, 1))], float)
    triangles = np.array([(0, 1, 2), (0, 2, 3), (4, 5, 6), (4, 6, 7)])
    fields = painted(TriangleMesh(corners, triangles))
    surfaces = (Surface(), *fields.pop("surfaces"))
    mesh = TriangleMesh(corners, triangles, materials=np.array([0, 0, 1, 1]), surfaces=surfaces, **fields)
    surfels, spacing = made(mesh, 300, texture_mapped=True).surfels, 3 / 300
    large = are_large(surfels, spacing)
    x, y, _ = (surfels.origin + surfels.positions)[large].T
    off = np.abs(x % 2 - y) / np.sqrt(2) - surfels.scales[large, 0]
    assert off[x < 1].min() < 0 < off[x > 2].min()


def test_a_wall_ends_the_floor_that_it_stands_on():
    """The surfels of either half of the floor end at the edge that they share with the wall."""
    corners = np.array([(0, 0, 0), (1, 0, 0), (2, 0, 0), (0, 1, 0), (1, 1, 0), (2, 1, 0), (1, 0, 1), (1, 1, 1)], float)
    floor = [(0, 1, 4), (0, 4, 3), (1, 2, 5), (1, 5, 4)]
    mesh, spacing = TriangleMesh(corners, np.array([*floor, (1, 4, 7), (1, 7, 6)])), 2 / 200
    surfels = made(mesh, 200).surfels
    large = are_large(surfels, spacing) & (surfels.normals[:, 2] > 0.5)
    x = (surfels.origin + surfels.positions)[large, 0]
    assert large.any() and (np.abs(x - 1) > surfels.scales[large, 0]).all()


def test_rows_in_which_a_face_lies_over_itself_keep_their_samples():
    """A strip that goes once and a half around the middle in one plane; nothing is bare, and all count."""
    turns = np.linspace(0, 3 * np.pi, 51)
    around = np.stack([np.cos(turns), np.sin(turns), 0 * turns], axis=1)
    k = np.arange(50)
    triangles = np.concatenate([np.stack([k, 51 + k, 52 + k], 1), np.stack([k, 52 + k, k + 1], 1)])
    mesh = TriangleMesh(np.concatenate([0.5 * around, around]), triangles)
    sampling = made(mesh, 200)
    replaced = len(sampling.surfels) - sampling.gaps + sampling.saved
    assert replaced == len(sample_surface(mesh, resolution=200).surfels)
    assert len(uncovered_points(mesh, sampling.surfels, 2 / 200)) == 0
    large = are_large(sampling.surfels, 2 / 200)
    _, y, _ = (sampling.surfels.origin + sampling.surfels.positions)[large].T
    assert large.any() and y.max() < 0.05  # below, the strip lies once
