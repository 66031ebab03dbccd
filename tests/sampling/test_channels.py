# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfels have roughness, metallic, emission and opacity only if a texture or vertex colours define them."""

import numpy as np
import pytest

from splat_addon.sampling import Channel, Computed, Image, Surface, Texture, Tolerance, TriangleMesh, VertexColors
from splat_addon.sampling.materials.surfaces import ALPHA, BLUE, GREEN, RED
from splat_addon.shading_nodes import ATTRIBUTE, Graph, Step
from tests.plain import sample_mesh, sample_surface

UVS = np.array([[(0, 0), (1, 0), (1, 1)], [(0, 0), (1, 1), (0, 1)]], float)


def noise(size, seed=0):
    pixels = np.random.default_rng(seed).random((size, size, 4))
    pixels[..., 3] = 1
    return pixels


def texel(surfels, size):
    column, row = np.floor((surfels.origin + surfels.positions)[:, :2] * size).astype(int).T
    return row, column


def sampled(square, surface, resolution=16, **fields):
    return sample_mesh(square(corner_uvs=UVS, surfaces=(surface,), **fields), resolution=resolution)


def test_constants_add_no_fields(square):
    surface = Surface(roughness=Channel((0.3,)), metallic=Channel((1,)), emission=Channel((1, 2, 3)))
    surfels = sampled(square, surface)
    assert surfels.roughness is None and surfels.metallic is None and surfels.emission is None


def test_green_is_the_roughness_and_blue_the_metallic_of_one_image(square):
    pixels = noise(16)
    image = Image(pixels)
    surface = Surface(
        roughness=Channel((0.5,), Texture(image, weights=GREEN)), metallic=Channel((1,), Texture(image, weights=BLUE))
    )
    surfels = sampled(square, surface)
    at = texel(surfels, 16)
    assert np.allclose(surfels.roughness, 0.5 * pixels[at][:, 1], atol=1e-5)
    assert np.allclose(surfels.metallic, pixels[at][:, 2], atol=1e-5)
    assert surfels.emission is None


@pytest.mark.parametrize("per_cell", [4, 16])
def test_a_texture_finer_than_the_spacing_gives_its_mean_roughness(square, per_cell):
    """The texture is a checker of single pixels, 4 or 16 to a cell: each surfel gets 0.5, not the 0 or 1 of a single
    pixel.
    """
    checker = np.ones((8 * per_cell, 8 * per_cell, 4))
    checker[..., 1] = np.indices(checker.shape[:2]).sum(axis=0) % 2
    surfels = sampled(square, Surface(roughness=Channel((1,), Texture(Image(checker), weights=GREEN))), 8)
    assert np.allclose(surfels.roughness, 0.5)


def test_a_texture_coarser_than_the_spacing_keeps_its_checks(square):
    checker = np.ones((4, 4, 4))
    checker[..., 1] = np.indices((4, 4)).sum(axis=0) % 2
    image = Image(checker, interpolation="Closest")
    surfels = sampled(square, Surface(roughness=Channel((1,), Texture(image, weights=GREEN))), 64)
    assert np.array_equal(surfels.roughness, checker[texel(surfels, 4)][:, 1].astype(np.float32))


def test_emission_is_not_bound_to_1(square):
    pixels = noise(16) * (50, 50, 50, 1)
    surfels = sampled(square, Surface(emission=Channel((1, 2, 0.5), Texture(Image(pixels), uses_alpha=False))))
    assert np.allclose(surfels.emission, pixels[texel(surfels, 16)][:, :3] * (1, 2, 0.5), atol=1e-3)


def test_opacity_from_another_image_multiplies_the_alpha(square):
    pixels = noise(16)
    weights = (0.2, 0.7, 0.1)
    surface = Surface(Channel((1, 1, 1, 0.5)), opacity=Channel((1,), Texture(Image(pixels), weights=(*weights, 0))))
    surfels = sampled(square, surface)
    number = pixels[texel(surfels, 16)][:, :3] @ weights
    assert np.allclose(surfels.colors[:, 3], 0.5 * number, atol=1e-5)
    assert (surfels.colors[:, :3] == 1).all()


def test_a_clipped_texture_is_black_and_opaque_where_its_alpha_is_not_looked_at(square):
    image = Image(np.ones((2, 2, 4)), "CLIP", "Closest")
    for uses_alpha, alpha in ((True, 0), (False, 1)):
        surface = Surface(Channel((1, 1, 1, 1), Texture(image, uses_alpha=uses_alpha)))
        surfels = sample_mesh(square(corner_uvs=UVS + 3, surfaces=(surface,)), resolution=4)
        assert (surfels.colors == (0, 0, 0, alpha)).all()


def test_a_grey_of_one_component_leaves_the_alpha(square):
    image = Image(np.full((1, 1, 4), 0.25))
    surfels = sampled(square, Surface(Channel((1, 1, 1, 1), Texture(image, weights=RED))))
    assert np.allclose(surfels.colors, (0.25, 0.25, 0.25, 1))


def test_a_placement_moves_turns_and_scales_the_image(square):
    """The image's coordinates are (2 - y, x / 2): a quarter turn, a shift and two scales."""
    ramp = np.ones((32, 32, 4))
    ramp[..., 0], ramp[..., 1] = np.meshgrid((np.arange(32) + 0.5) / 32, (np.arange(32) + 0.5) / 32)
    texture = Texture(Image(ramp, "EXTEND"), placement=((0, -1, 1), (0.5, 0, 0.25)))
    surfels = sampled(square, Surface(Channel((1, 1, 1, 1), texture)), 32)
    x, y, _ = (surfels.origin + surfels.positions).T
    inner = (np.minimum(x, y) > 0.1) & (np.maximum(x, y) < 0.9)
    assert np.abs(surfels.colors[:, 0] - (1 - y))[inner].max() < 1e-5
    assert np.abs(surfels.colors[:, 1] - (0.25 + x / 2))[inner].max() < 1e-5


def test_each_texture_uses_its_own_layer_of_coordinates_and_colours(square):
    pixels = noise(16)
    uvs = np.concatenate([UVS, UVS[..., ::-1]], axis=2)
    colors = np.zeros((2, 3, 8))
    colors[..., 7], colors[..., 4] = 0.25, 0.75
    surface = Surface(
        Channel((1, 1, 1, 1), Texture(Image(pixels), layer=1)),
        roughness=Channel((1,), VertexColors(1, weights=ALPHA)),
        metallic=Channel((1,), VertexColors(1, weights=RED)),
    )
    surfels = sample_mesh(square(corner_uvs=uvs, corner_colors=colors, surfaces=(surface,)), resolution=16)
    row, column = texel(surfels, 16)
    assert np.allclose(surfels.colors, pixels[column, row], atol=1e-5)
    assert np.allclose(surfels.roughness, 0.25) and np.allclose(surfels.metallic, 0.75)


def test_where_one_material_has_a_texture_the_others_have_their_constants(square):
    rough = Channel((1,), Texture(Image(np.full((1, 1, 4), 0.125)), weights=GREEN))
    surfaces = Surface(roughness=rough), Surface(roughness=Channel((0.75,))), Surface()
    for material, value in ((1, 0.75), (2, 0.5)):
        mesh = square(corner_uvs=UVS, materials=np.array([0, material]), surfaces=surfaces)
        surfels = sample_mesh(mesh, resolution=16)
        assert np.allclose(surfels.roughness, np.where(surfels.materials == 0, 0.125, value))


def test_a_part_between_the_rays_has_the_fields_too(square):
    surface = Surface(roughness=Channel((1,), Texture(Image(np.full((4, 4, 4), 0.25)), weights=GREEN)))
    small = square(0.1, corner_uvs=UVS, surfaces=(surface,))
    far = small.positions + 10
    both = sample_surface(
        type(small)(
            np.concatenate([small.positions, far]),
            np.concatenate([small.triangles, small.triangles + 4]),
            corner_uvs=np.concatenate([UVS, UVS]),
            surfaces=(surface,),
        ),
        resolution=4,
    )
    assert both.small_parts == 2 and np.allclose(both.surfels.roughness, 0.25)


def test_adaptive_sampling_keeps_what_a_texture_changes_and_averages_what_it_does_not(square):
    step = np.full((2, 2, 4), 0.5)
    step[:, 1, 1] = 1
    image = Image(step, "EXTEND", "Closest")
    mesh = square(corner_uvs=UVS, surfaces=(Surface(roughness=Channel((1,), Texture(image, weights=GREEN))),))
    sampling = sample_surface(mesh, resolution=64, tolerance=Tolerance(0.001))
    surfels = sampling.surfels
    assert sampling.saved > 1000
    assert np.allclose(surfels.roughness, np.where((surfels.origin + surfels.positions)[:, 0] < 0.5, 0.5, 1))
    reach = (surfels.origin + surfels.positions)[:, 0] - 0.5, surfels.scales[:, 0]
    assert (np.abs(reach[0]) > 0.6 * reach[1])[surfels.scales[:, 0] > 2 / 64].all()


@pytest.mark.parametrize("wrong", [{"roughness": (1, 1, 1)}, {"emission": (1,)}, {"color": (1, 1, 1)}])
def test_a_channel_of_the_wrong_width_is_refused(wrong):
    with pytest.raises(ValueError, match=r"has . numbers?, not"):
        Surface(**{name: Channel(value) for name, value in wrong.items()})


def test_nodes_of_many_materials_colour_each_sample_by_its_place_and_its_own():
    """Samples are evaluated in the order of their materials, and stay where they were."""
    side, random = 12, np.random.default_rng(4)
    x, y = (values.ravel().astype(np.float32) for values in np.meshgrid(np.arange(side + 1), np.arange(side + 1)))
    first = (np.arange(side)[:, None] * (side + 1) + np.arange(side)).ravel()
    triangles = np.concatenate([first[:, None] + (0, 1, side + 2), first[:, None] + (0, side + 2, side + 1)])
    positions = np.stack([x, y, 0 * x], axis=1)
    factors = random.random(5).astype(np.float32)
    graphs = [Graph((Step(ATTRIBUTE, (), (0,)), Step("multiplied", (0, (float(f),))))) for f in factors]
    mesh = TriangleMesh(
        positions,
        triangles,
        corner_colors=np.concatenate([positions, np.ones_like(positions[:, :1])], axis=1)[triangles],
        materials=random.integers(0, 5, len(triangles)).astype(np.int32),
        surfaces=tuple(Surface(Channel((1.0, 1.0, 1.0, 1.0), Computed(graph))) for graph in graphs),
    )
    surfels = sample_mesh(mesh, spacing=0.2)
    places = surfels.positions + surfels.origin.astype(np.float32)
    assert len(np.unique(surfels.materials)) == 5
    assert np.allclose(surfels.colors[:, :3], places * factors[surfels.materials][:, None], atol=1e-4)
