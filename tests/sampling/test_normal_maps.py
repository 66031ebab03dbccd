# SPDX-License-Identifier: GPL-3.0-or-later
"""Shading normals follow a normal map, in the texture's frame; the ellipses do not."""

import numpy as np
import pytest

from splat_addon.sampling import Channel, Image, NormalMap, Surface, Texture, TriangleMesh
from splat_addon.sampling.attributes.tangents import corner_tangents
from tests.plain import sample_mesh

UVS = np.array([[(0, 0), (1, 0), (1, 1)], [(0, 0), (1, 1), (0, 1)]], float)
TILTED = np.array((0.6, 0.0, 0.8))


def pixels(*normals):
    """One row of pixels that store these normals."""
    rgb = (np.array(normals, float) + 1) / 2
    return np.concatenate([rgb, np.ones((len(rgb), 1))], axis=1)[None]


def mapped(square, image, uvs=UVS, resolution=8, **settings):
    surface = Surface(normal_map=NormalMap(Channel((1, 1, 1), Texture(Image(image))), **settings))
    return sample_mesh(square(corner_uvs=uvs, surfaces=(surface,)), resolution=resolution)


def test_a_flat_map_changes_nothing(square):
    assert np.allclose(mapped(square, pixels((0, 0, 1))).normals, (0, 0, 1), atol=1e-6)


def test_a_tilted_map_tilts_the_shading_normal_and_not_the_ellipse(square):
    surfels = mapped(square, pixels(TILTED))
    assert np.allclose(surfels.normals, TILTED, atol=1e-6)
    assert np.allclose(surfels.geometric_normals(), (0, 0, 1), atol=1e-6)


@pytest.mark.parametrize(
    ("uvs", "expected"),
    [
        (UVS[..., ::-1] * (1, -1), (0, 0.6, 0.8)),  # u grows along y, v along -x: a quarter turn
        (UVS * (-1, 1), (-0.6, 0, 0.8)),  # mirrored: u grows along -x, v still along y
        (UVS * (5, 0.1), (0.6, 0, 0.8)),  # scaling leaves the directions
    ],
)
def test_the_map_follows_the_directions_of_the_texture(square, uvs, expected):
    assert np.allclose(mapped(square, pixels(TILTED), uvs).normals, expected, atol=1e-6)


def test_a_mirrored_texture_keeps_its_bitangent(square):
    """Green leans towards growing v, which is still +y where u grows along -x."""
    surfels = mapped(square, pixels((0, 0.6, 0.8)), UVS * (-1, 1))
    assert np.allclose(surfels.normals, (0, 0.6, 0.8), atol=1e-6)


@pytest.mark.parametrize(("strength", "tangent"), [(0, 0), (0.5, 0.3 / 0.9), (1, 0.75), (2, 1.5)])
def test_strength_scales_what_is_across_and_mixes_what_is_along(square, strength, tangent):
    """The part along the normal is 1 + (0.8 - 1) * min(strength, 1)."""
    x, y, z = mapped(square, pixels(TILTED), strength=strength).normals.T
    assert np.allclose(x / z, tangent, atol=1e-5) and np.allclose(y, 0, atol=1e-6)


def test_ripples_finer_than_the_spacing_give_the_mean_direction(square):
    """The normals lean to +x and -x alternately, and once to +y: the mean has only y and z."""
    ripples = np.tile(pixels((0.6, 0, 0.8), (-0.6, 0, 0.8), (0, 0.6, 0.8), (0, 0, 1)), (128, 32, 1))
    mean = np.array((0, 0.15, 0.85)) / np.hypot(0.15, 0.85)
    assert np.allclose(mapped(square, ripples).normals, mean, atol=1e-6)


def test_a_map_in_object_space_is_the_normal_itself(square):
    surfels = mapped(square, pixels((0, 0.6, -0.8)), space="OBJECT")
    assert np.allclose(surfels.normals, (0, 0.6, -0.8), atol=1e-6)


@pytest.mark.filterwarnings("error")
def test_a_vector_without_a_direction_leaves_the_normal(square):
    assert np.allclose(mapped(square, np.full((1, 1, 4), 0.5)).normals, (0, 0, 1), atol=1e-6)


@pytest.mark.filterwarnings("error")
def test_a_texture_without_area_leaves_what_is_along_the_normal(square):
    assert np.allclose(mapped(square, pixels(TILTED), UVS * 0).normals, (0, 0, 1), atol=1e-6)


def test_tangents_on_a_ball_are_unit_and_across_the_normals(sphere):
    """The coordinates are longitude and latitude, so the tangent of growing u points east."""
    x, y, z = np.moveaxis(sphere.corner_normals, 2, 0)
    uvs = np.stack([np.arctan2(y, x), np.arcsin(np.clip(z, -1, 1))], axis=2)
    seam = np.ptp(uvs[..., 0], axis=1) > 3
    tangents = corner_tangents(sphere, uvs)
    flat = (np.abs(z).max(axis=1) < 0.7) & ~seam
    east = np.stack([-y, x, np.zeros_like(x)], axis=2) / np.maximum(np.hypot(x, y), 1e-9)[..., None]
    assert flat.sum() > 40_000
    assert np.abs((tangents[..., :3] * sphere.corner_normals).sum(axis=2))[flat].max() < 1e-6
    assert ((tangents[..., :3] * east).sum(axis=2)[flat] > np.cos(np.radians(1.5))).all()
    assert (tangents[flat][..., 3] == 1).all()


def test_tangents_are_smooth_only_where_everything_is_shared():
    """Two triangles of a roof share an edge; they share tangents only if their normals and coordinates there
    are equal.
    """
    positions = np.array([(0, 0, 0), (1, 0, 0.5), (0, 1, 0), (-1, 0, 0.7)])
    triangles = np.array([(0, 1, 2), (0, 2, 3)])
    uvs = positions[triangles][..., :2]
    normals = np.broadcast_to((0.0, 0.0, 1.0), (2, 3, 3))
    shared = corner_tangents(TriangleMesh(positions, triangles, normals), uvs)
    assert np.allclose(shared[0, 0], shared[1, 0]) and np.allclose(shared[0, 2], shared[1, 1])
    own = corner_tangents(TriangleMesh(positions, triangles), uvs)
    assert not np.allclose(own[0, 0], own[1, 0])
