# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfels under an affine map are the images of their ellipses under it."""

import numpy as np
import pytest

from splat_addon.interchange import joined, transformed

MAPS = {
    "shift": np.array([[1, 0, 0, 5], [0, 1, 0, 6], [0, 0, 1, 7], [0, 0, 0, 1.0]]),
    "turn": np.array([[0, -1, 0, 0], [1, 0, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1.0]]),
    "mirror": np.diag([-2, 2, 2, 1.0]),
    "stretch": np.diag([1, 3, 0.2, 1]),
    "shear": np.array([[1, 0.7, 0, 1], [0, 1, 0.4, 2], [0.1, 0, 1, 3], [0, 0, 0, 1]]),
}


@pytest.mark.parametrize("name", MAPS)
def test_the_rim_of_every_ellipse_is_the_image_of_its_rim(surfels, name):
    before, matrix = surfels(50, origin=(1, 2, 3)), MAPS[name]
    after = transformed(before, matrix)
    (p, q), (x, y) = before.half_axes(), after.half_axes()
    for angle in np.linspace(0, np.pi, 5):
        image = (p * np.cos(angle) + q * np.sin(angle)) @ matrix[:3, :3].T
        radius = ((image * x).sum(1) / (x * x).sum(1)) ** 2 + ((image * y).sum(1) / (y * y).sum(1)) ** 2
        assert np.allclose(radius, 1, atol=1e-3)
    world = (before.origin + before.positions) @ matrix[:3, :3].T + matrix[:3, 3]
    assert np.allclose(after.origin + after.positions, world, atol=1e-5)


@pytest.mark.parametrize("name", MAPS)
def test_geometric_normals_stay_on_their_side(surfels, name):
    before, matrix = surfels(50), MAPS[name]
    wanted = before.geometric_normals() @ np.linalg.inv(matrix[:3, :3])
    after = transformed(before, matrix).geometric_normals()
    assert np.allclose(after, wanted / np.linalg.norm(wanted, axis=1, keepdims=True), atol=1e-5)


@pytest.mark.parametrize("name", MAPS)
def test_every_point_of_an_ellipse_keeps_its_texture_coordinate(surfels, name):
    random = np.random.default_rng(11)
    uvs = {field: random.normal(size=(50, 2)) for field in ("uvs", "uv_along_x", "uv_along_y")}
    before = surfels(50, **uvs)
    after = transformed(before, MAPS[name])
    p, q = before.half_axes()
    x, y = after.half_axes()
    across, up = random.uniform(-1, 1, (2, 50, 1))
    point = (p * across + q * up) @ MAPS[name][:3, :3].T
    place = [((point * axis).sum(1) / (axis * axis).sum(1))[:, None] for axis in (x, y)]
    wanted = before.uv_along_x * across + before.uv_along_y * up
    assert np.allclose(after.uv_along_x * place[0] + after.uv_along_y * place[1], wanted, atol=1e-4)


def test_a_map_that_flattens_is_an_error(surfels):
    with pytest.raises(ValueError, match="a scale of 0"):
        transformed(surfels(3), np.diag([1, 1, 0, 1]))


def test_sets_are_joined_where_they_stand(surfels):
    a, b = surfels(3, origin=(1, 0, 0)), surfels(4, origin=(0, 0, 5))
    both = joined([a, b])
    places = np.concatenate([a.origin + a.positions, b.origin + b.positions])
    assert np.allclose(both.origin + both.positions, places, atol=1e-6)
