# SPDX-License-Identifier: GPL-3.0-or-later
"""Leaves within a crown keep the world's light from one another: as a turbid medium does, at any distance and place."""

import math
from dataclasses import replace

import numpy as np
import pytest

from splat_addon.images import Image
from splat_addon.rendering import Camera, PolygonInstance, Scene, Settings, look_at, make_polygons, plan
from splat_addon.rendering.bounced.crowns import crown_of, crowns_of
from splat_addon.rendering.scene.material import Material, SurfaceTexture

MATT = Material(roughness=1.0, ior=1.0)
#: An image of which half is clear, so that leaves are half as large as their cards.
HALF = np.concatenate([np.ones((8, 8, 3)), np.repeat([[[1.0]], [[0.0]]], 4, axis=0).repeat(8, axis=1)], axis=2)
CARD = np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)])


def ball_of_leaves(count: int, edge: float) -> PolygonInstance:
    """White cards in a ball of radius 1, turned at random."""
    random = np.random.default_rng(1)
    middles = random.normal(size=(count, 3))
    middles *= random.uniform(size=(count, 1)) ** (1 / 3) / np.linalg.norm(middles, axis=1, keepdims=True)
    x, y, _ = np.linalg.qr(random.normal(size=(count, 3, 3)))[0].transpose(1, 0, 2)
    places = middles[:, None] + edge / 2 * (CARD[:, :1] * x[:, None] + CARD[:, 1:] * y[:, None])
    triangles = (4 * np.arange(count)[:, None, None] + [[0, 1, 2], [0, 2, 3]]).reshape(-1, 3)
    uvs = np.tile((CARD + 1) / 2, (count, 1))[triangles.ravel()]
    shape = make_polygons(places.reshape(-1, 3), triangles, color=(1, 1, 1, 1), uvs=uvs)
    return PolygonInstance(shape, textures=(SurfaceTexture(Image(HALF), is_cut_out=True),), materials=(MATT,))


@pytest.fixture(scope="module")
def leaves() -> PolygonInstance:
    return ball_of_leaves(1500, 0.12)


def test_share_in_the_middle_is_that_of_a_turbid_medium(leaves):
    crown = crown_of(leaves)
    area = 1500 * 0.12**2 / 2
    assert crown.areas.sum() == pytest.approx(area, rel=0.03)
    depth = 0.5 * area / (4 / 3 * math.pi)
    middles = crown.low + (crown.cells + 0.5) * crown.edge
    away = np.linalg.norm(middles, axis=1)
    in_middle = crown.open[away < 0.25]
    assert in_middle.mean() == pytest.approx(math.exp(-depth * (1 - crown.edge / 2)), rel=0.17)
    outer = middles[(middles[:, 2] > 0.7) & (away < 1)]
    above = crown.open[(middles[:, 2] > 0.7) & (away < 1)].mean(axis=0)
    assert len(outer) and above[4] > 2 * above[5]  # more light from above than through the crown


def test_crowns_that_are_turned_scaled_and_many_have_the_same_shares(leaves):
    alone = crowns_of(Scene(polygons=[leaves]))
    turn = np.eye(4)
    turn[:3, :3] = 3 * np.array([[0.0, -1, 0], [1, 0, 0], [0, 0, 1]])
    turn[:3, 3] = 100, 20, -7
    moved = crowns_of(Scene(polygons=[replace(leaves, matrix_world=turn)]))
    assert moved.cell == pytest.approx(3 * alone.cell)
    means = [[light.open[light.sides == side].mean() for side in range(6)] for light in (alone, moved)]
    assert np.allclose(np.array(means[0])[[3, 2, 0, 1, 4, 5]], means[1], atol=0.02)
    places = np.tile(np.eye(4), (400, 1, 1))
    places[:, 0, 3] = 4 * np.arange(400)
    many = crowns_of(Scene(polygons=[replace(leaves, matrix_world=place) for place in places]))
    assert len(many.open) < 6 * (1 << 18)
    assert many.open.mean() == pytest.approx(alone.open.mean(), abs=0.05)


#: Mean light of the leaves that are seen from 4 or 30 units: rays to 24 directions from each of 4,700 places, and the
#: bounces of Ambient Occlusion.
SEEN_BY_RAYS = 0.846


def test_crown_is_as_bright_from_afar_as_rays_find_it_and_at_most_so_from_near(render, leaves):
    scene, means = Scene(polygons=[leaves], world=(1.0, 1, 1), background=(0.0, 0, 0)), []
    for distance in (4.0, 30.0):
        camera = Camera.perspective(look_at((0, -distance, 0), (0, 0, 0)), vertical_fov=0.6, size=(32, 32))
        frame = render(scene, camera, Settings(method="quad", ambient_occlusion=math.inf))
        means.append(frame.color[..., 0].sum() / frame.coverage.sum())
    near, far = means
    assert far == pytest.approx(SEEN_BY_RAYS, rel=0.05)
    assert 0.75 * far < near < 1.1 * far and 0.3 < near < 0.8  # there the picture's own occlusion is darker


@pytest.mark.parametrize("settings", ({"ambient_occlusion": 0.0}, {"bounces": 1}))
def test_where_the_picture_has_no_occlusion_crowns_have_none(leaves, settings):
    camera = Camera.perspective(look_at((0, -4, 0), (0, 0, 0)), vertical_fov=0.6, size=(32, 32))
    scene = Scene(polygons=[leaves], world=(1.0, 1, 1))
    on = Settings(ambient_occlusion=1.0)
    assert "crowns" in str(plan(scene, camera, on))
    whole = replace(scene, polygons=[replace(leaves, textures=())])
    for other in (plan(scene, camera, replace(on, **settings)), plan(whole, camera, on)):
        assert not any("crowns" in str(p.parts) for p in other.passes)
