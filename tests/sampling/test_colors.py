# SPDX-License-Identifier: GPL-3.0-or-later
"""The colour of a surfel comes from constants, vertex colours and textures, or products of them."""

import numpy as np
import pytest

from splat_addon.sampling import Channel, Image, Surface, Texture, VertexColors
from tests.plain import sample_mesh

#: The square's corners as its triangles use them: texture coordinates equal x, y.
UVS = np.array([[(0, 0), (1, 0), (1, 1)], [(0, 0), (1, 1), (0, 1)]], float)


def surfaced(square, *surfaces, **fields):
    return square(corner_uvs=UVS, surfaces=surfaces, **fields)


def test_a_material_without_texture_gives_its_own_colour(square):
    surfels = sample_mesh(surfaced(square, Surface(Channel((0.1, 0.2, 0.3, 0.5)))), resolution=8)
    assert (surfels.colors == np.float32((0.1, 0.2, 0.3, 0.5))).all()


def test_vertex_colours_are_linear_between_corners(square):
    corners = np.ones((2, 3, 4))
    corners[..., :2] = UVS
    surfels = sample_mesh(
        surfaced(square, Surface(Channel((1, 1, 1, 1), VertexColors())), corner_colors=corners), resolution=32
    )
    assert np.abs(surfels.colors[:, :2] - (surfels.origin + surfels.positions)[:, :2]).max() < 1e-6


def test_the_factors_multiply(square):
    image = Image(np.full((2, 2, 4), 0.5))
    surface = Surface(
        Channel(
            (0.5, 1, 1, 1),
            (
                Texture(image),
                VertexColors(),
            ),
        )
    )
    surfels = sample_mesh(surfaced(square, surface, corner_colors=np.full((2, 3, 4), 0.25)), resolution=8)
    assert np.allclose(surfels.colors, (0.0625, 0.125, 0.125, 0.125))


def test_a_ramp_in_a_texture_comes_back_unshifted(square):
    """The centre of pixel k is at (k + 1/2) / size; its value is the same number, so lookups return the coordinate."""
    ramp = np.ones((16, 16, 4))
    ramp[..., 0], ramp[..., 1] = np.meshgrid((np.arange(16) + 0.5) / 16, (np.arange(16) + 0.5) / 16)
    surfels = sample_mesh(surfaced(square, Surface(Channel((1, 1, 1, 1), Texture(Image(ramp))))), resolution=64)
    x, y = places = (surfels.origin + surfels.positions)[:, :2].T
    inner = (np.minimum(x, y) > 1 / 32) & (np.maximum(x, y) < 31 / 32)
    assert inner.sum() > 3000 and np.abs(surfels.colors[:, :2].T - places)[:, inner].max() < 1e-6


#: extension -> the red of pixels (0, 1) at u = -0.25 and 1.25, 1.75, pixel centres all.
OUTSIDE = {"REPEAT": (1, 0, 1), "EXTEND": (0, 1, 1), "MIRROR": (0, 1, 0), "CLIP": (0, 0, 0)}


@pytest.mark.parametrize("interpolation", ["Linear", "Closest"])
@pytest.mark.parametrize("extension", OUTSIDE)
def test_extension_modes_follow_the_image_texture_node(square, extension, interpolation):
    image = Image(np.array([[(0, 0, 0, 1), (1, 1, 1, 1)]], float), extension, interpolation)
    for u, red in zip((-0.25, 1.25, 1.75), OUTSIDE[extension], strict=True):
        surface = Surface(Channel((1, 1, 1, 1), Texture(image)))
        surfels = sample_mesh(square(corner_uvs=np.full((2, 3, 2), (u, 0.5)), surfaces=(surface,)), resolution=2)
        assert np.allclose(surfels.colors[:, 0], red, atol=1e-6)
        assert np.allclose(surfels.colors[:, 3], extension != "CLIP")


def test_a_texture_finer_than_the_spacing_does_not_alias(square):
    """The texture is a checker of single pixels, eight to a cell: point lookups would give pure black and white."""
    checker = np.ones((512, 512, 4))
    checker[..., :3] = (np.indices((512, 512)).sum(axis=0) % 2)[..., None]
    surfels = sample_mesh(surfaced(square, Surface(Channel((1, 1, 1, 1), Texture(Image(checker))))), resolution=64)
    assert np.allclose(surfels.colors[:, :3], 0.5)


@pytest.mark.parametrize("size", [(7, 13), (64, 3), (1, 100)])
def test_a_minified_texture_of_any_size_keeps_its_mean(square, size):
    pixels = np.random.default_rng(0).random((*size, 4))
    pixels[..., 3] = 1
    surfels = sample_mesh(surfaced(square, Surface(Channel((1, 1, 1, 1), Texture(Image(pixels))))), resolution=1)
    assert np.allclose(surfels.colors[0], pixels.mean(axis=(0, 1)), atol=1e-6)


def test_a_texture_at_its_own_size_is_not_blurred(square):
    pixels = np.random.default_rng(0).random((16, 16, 4))
    pixels[..., 3] = 1
    surfels = sample_mesh(surfaced(square, Surface(Channel((1, 1, 1, 1), Texture(Image(pixels))))), resolution=16)
    column, row = np.floor((surfels.origin + surfels.positions)[:, :2] * 16).astype(int).T
    assert np.abs(surfels.colors - pixels[row, column]).max() < 1e-5


def test_a_transparent_pixel_does_not_bleed_its_colour(square):
    image = Image(np.array([[(1, 0, 0, 1), (0, 1, 0, 0)]], float), "EXTEND")
    surfels = sample_mesh(surfaced(square, Surface(Channel((1, 1, 1, 1), Texture(image)))), resolution=32)
    seen = surfels.colors[:, 3] > 0
    assert seen.sum() > 500 and np.allclose(surfels.colors[seen, :3], (1, 0, 0))


def test_each_triangle_has_its_own_material(square):
    surfaces = Surface(Channel((1, 0, 0, 1))), Surface(Channel((0, 1, 0, 1)))
    surfels = sample_mesh(surfaced(square, *surfaces, materials=np.array([0, 1])), resolution=16)
    above = (surfels.origin + surfels.positions)[:, 1] > (surfels.origin + surfels.positions)[:, 0] + 1e-6
    assert (surfels.materials[above] == 1).all() and (surfels.colors[above] == (0, 1, 0, 1)).all()
    assert (surfels.colors[surfels.materials == 0] == (1, 0, 0, 1)).all()


def test_a_material_past_the_end_uses_the_last_surface_and_keeps_its_index(square):
    surfaces = Surface(Channel((1, 0, 0, 1))), Surface(Channel((0, 0, 1, 1)))
    surfels = sample_mesh(surfaced(square, *surfaces, materials=np.array([5, 5])), resolution=4)
    assert (surfels.materials == 5).all() and (surfels.colors == (0, 0, 1, 1)).all()


def test_a_factor_that_the_mesh_lacks_is_left_out(square):
    surface = Surface(
        Channel(
            (0.5, 0.5, 0.5, 1),
            (
                Texture(Image(np.zeros((1, 1, 4)))),
                VertexColors(),
            ),
        )
    )
    surfels = sample_mesh(square(surfaces=(surface,)), resolution=4)
    assert (surfels.colors == (0.5, 0.5, 0.5, 1)).all()


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("broken", [np.nan, np.inf, 1e300])
def test_a_broken_colour_falls_back_to_the_materials_own(square, broken):
    corners = np.ones((2, 3, 4))
    corners[:, :, 0] = broken
    surfels = sample_mesh(
        surfaced(square, Surface(Channel((0.5, 0, 0, 1), VertexColors())), corner_colors=corners), resolution=4
    )
    assert np.allclose(surfels.colors, (0.5, 0, 0, 1))


@pytest.mark.parametrize("broken", [np.inf, np.nan])
def test_a_pixel_that_is_no_colour_is_refused(broken):
    with pytest.raises(ValueError, match="An image's pixels must be finite; make others 0"):
        Image(np.where(np.arange(4) == 1, broken, np.zeros((4, 4, 4))))


@pytest.mark.filterwarnings("error")
def test_broken_texture_coordinates_look_up_the_corner(square):
    image = Image(np.array([[(0.5, 0, 0, 1)]]))
    uvs = np.full((2, 3, 2), np.nan)
    uvs[1] = 1e30
    surfels = sample_mesh(
        square(corner_uvs=uvs, surfaces=(Surface(Channel((1, 1, 1, 1), Texture(image))),)), resolution=4
    )
    assert np.allclose(surfels.colors, (0.5, 0, 0, 1))


@pytest.mark.parametrize("arguments", [(np.zeros((2, 2, 3)),), (np.zeros((0, 2, 4)),), (np.zeros((1, 1, 4)), "WRAP")])
def test_an_unusable_image_is_refused_in_a_sentence(arguments):
    with pytest.raises(ValueError, match=r"An image's .* not"):
        Image(*arguments)
