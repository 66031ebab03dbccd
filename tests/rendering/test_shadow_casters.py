# SPDX-License-Identifier: GPL-3.0-or-later
"""Shadow maps leave out what no seen surface can look up, and no picture shows that."""

import math
from dataclasses import replace

import numpy as np
import pytest

from splat_addon.reference import scenes
from splat_addon.rendering import Camera, Instance, Light, Scene, Settings, look_at, plan
from splat_addon.rendering.passes.decisions import shadows
from splat_addon.rendering.shadows import maps
from splat_addon.rendering.shadows.casters import hull_planes
from splat_addon.rendering.shadows.hexahedra import places_in_pyramid

SIZE = (64, 48)
SETTINGS = Settings(method="quad", supersampling=1, outputs=("color",), shadow_resolution=256)
BALL = scenes.sphere(1500, SIZE)[0].surfels[0].surfels
LIGHTS = {
    "sun": Light("sun", energy=3, direction=(-0.5, 0.6, -1)),
    "sized sun": Light("sun", energy=3, direction=(-1, 0.3, -0.5), size=0.2),
    "point": Light("point", energy=900, position=(0.5, 0.2, 2.5)),
    "ball": Light("point", energy=900, position=(0.5, 0.2, 2.5), size=0.3),
    "spot": Light("spot", energy=900, position=(2, -3, 4), direction=(-1, 1.2, -1.5), spot_angle=1.4),
    "area": Light(
        "area", energy=900, position=(2, -3, 4), direction=(-1, 1.2, -1.5), half_axes=((0.4, 0, 0), (0, 0.3, 0))
    ),
}
LIGHTS = {name: replace(light, casts_shadow=True) for name, light in LIGHTS.items()}
CAMERAS = {
    "near": Camera.perspective(look_at((2, -2.5, 1.5), (0.2, 0.3, 0)), 0.6, SIZE, near=0.1, far=100),
    "along": Camera.perspective(look_at((-9, 0.5, 1), (0, 0.5, 0.3)), 0.3, SIZE, near=0.1, far=100),
    "parallel": Camera.orthographic(look_at((2, -2.5, 4), (0.2, 0.3, 0)), 3.0, SIZE, 0.1, 100),
}


def balls(light: Light) -> Scene:
    """Balls that nearly touch, in three layers."""
    rng, made = np.random.default_rng(3), []
    for x in range(-4, 5):
        for y in range(-4, 5):
            place = np.diag((0.45, 0.45, 0.45, 1.0))
            place[:3, 3] = x, y, rng.choice((-0.5, 0.0, 0.8))
            made.append(Instance(BALL, place))
    return Scene(made, (light,))


#: Maps of suns and of points in every view; the other lights add to how their maps are read.
SEEN = [*((name, view) for name in ("sun", "point") for view in CAMERAS), ("sized sun", "near"), ("ball", "along"),
        ("spot", "parallel"), ("area", "near")]  # fmt: skip


@pytest.mark.parametrize(("name", "view"), SEEN)
def test_what_is_left_out_changes_no_picture(name, view, render, monkeypatch):
    scene, camera = balls(LIGHTS[name]), CAMERAS[view]
    bare = render(replace(scene, lights=(replace(LIGHTS[name], casts_shadow=False),)), camera, SETTINGS).color
    one, made = render(scene, camera, SETTINGS).color, plan(scene, camera, SETTINGS).find(shadows).maps
    monkeypatch.setattr(maps, "used_texels", lambda camera, _: (0, 0, *camera.size))
    monkeypatch.setattr(maps, "in_the_way", lambda *arguments: np.ones(len(scene.surfels), bool))
    every = render(scene, camera, SETTINGS).color
    assert np.abs(bare - one).max() > 0.1
    assert min(len(one.casters) for one in made) < len(scene.surfels) - 5
    assert np.count_nonzero(np.abs(one - every).max(axis=2) > 0.01 * every.max()) <= 2


@pytest.mark.parametrize("name", ["point", "ball", "area"])
def test_faces_of_a_cube_that_nobody_sees_are_not_drawn(name, render):
    scene = balls(LIGHTS[name])
    above = Camera.perspective(look_at((4, 4, 4), (4, 3.9, 0)), 0.1, SIZE, near=0.1, far=100)
    few, all_round = (plan(scene, camera, SETTINGS).find(shadows).maps for camera in (above, CAMERAS["along"]))
    assert 0 < len(few) < len(all_round)


def test_the_maps_of_a_tilted_area_light_leave_no_gaps():
    """They did between its front and its sides, where light came through walls."""
    scene = balls(replace(LIGHTS["area"], position=(4, 4, 0), half_axes=((0.4, 0, 0), (0, 0.3, 0))))
    made = plan(scene, Camera.perspective(look_at((4, 4, 40), (4, 3.9, 0)), 0.7, SIZE), SETTINGS).find(shadows).maps
    rays = np.random.default_rng(1).normal(size=(10000, 3))
    rays = rays[rays @ LIGHTS["area"].direction > 0]
    views = [rays @ one.camera.matrix_world[:3, :3] for one in made]
    seen = [
        np.abs(view[:, :2]).max(axis=1) < -view[:, 2] * one.camera.window[1]
        for view, one in zip(views, made, strict=True)
    ]
    assert len(made) == 5
    assert np.any(seen, axis=0).all()


def test_a_light_whose_receivers_are_not_seen_has_no_map():
    scene = balls(replace(LIGHTS["sun"], receivers=(1,)))
    assert not plan(scene, CAMERAS["near"], SETTINGS).find(shadows).maps
    middle = len(scene.surfels) // 2
    lit = replace(scene.surfels[middle], light_set=1)
    seen = replace(scene, surfels=(*scene.surfels[:middle], lit, *scene.surfels[middle + 1 :]))
    assert plan(seen, CAMERAS["near"], SETTINGS).find(shadows).maps


def test_whether_there_is_room_for_a_light_does_not_depend_on_the_camera(monkeypatch):
    """Otherwise its shadow would come and go while the camera moves."""
    lamp = replace(LIGHTS["point"], position=(0.5, 0.2, 0.0))
    scene = replace(balls(lamp), lights=(lamp,) * 7)
    monkeypatch.setattr(maps, "MAX_MAPS", 32)
    for camera in CAMERAS.values():
        made = plan(scene, camera, SETTINGS)
        assert "shadows of 2 lights" in dict(made.skipped)
        assert any(said.startswith("2 lights cast no shadows") for said in made.limits)


def test_suns_and_the_brightest_lamps_have_room_before_others(monkeypatch):
    monkeypatch.setattr(maps, "MAX_MAPS", 32)
    lamps = [replace(LIGHTS["point"], energy=900 + 10 * k, position=(0.1 * k, 0, 0)) for k in range(7)]
    scene = replace(balls(lamps[0]), lights=(*lamps, LIGHTS["sun"]))
    made = plan(scene, CAMERAS["near"], SETTINGS)
    assert {one.light for one in made.find(shadows).maps} == {*range(2, len(scene.lights))}
    assert made.find(shadows).without == 2


def test_a_black_light_needs_no_map():
    black = [replace(LIGHTS["point"], energy=0), replace(LIGHTS["sun"], color=(0, 0, 0))]
    scene = replace(balls(LIGHTS["point"]), lights=(*black, LIGHTS["point"]))
    assert {one.light for one in plan(scene, CAMERAS["near"], SETTINGS).find(shadows).maps} == {2}


@pytest.mark.parametrize(("lamps", "side"), [(12, 256), (13, 128)])
def test_the_maps_of_many_lamps_share_the_texels_of_fewer(lamps, side):
    """Five faces of each see casters."""
    scene = replace(balls(LIGHTS["sun"]), lights=(LIGHTS["sun"],) + (LIGHTS["point"],) * lamps)
    camera = replace(CAMERAS["near"], size=(640, 480))
    found = plan(scene, camera, SETTINGS).find(shadows).maps
    assert max(one.camera.size[0] for one in found if one.light) == side
    assert max(one.camera.size[0] for one in found if not one.light) >= 256


@pytest.mark.parametrize("lamp", [(0, 0, 9, 1), (3, 1, 0.5, 1), (0, 0, 0, 1), (1, -2, 0.5, 0), (-30, 2, 5, 1)])
def test_the_hull_holds_all_that_lies_between_a_lamp_and_what_is_seen(lamp):
    """It holds points on ways to the lamp, and of others around it leaves many out."""
    rng, space = (
        np.random.default_rng(1),
        np.array([(x * d, y * d, d) for d in (1, 4) for x in (-1, 1) for y in (-1, 1)]),
    )
    space = space - space.mean(axis=0)
    planes = hull_planes(space, np.array(lamp, np.float64))
    np.testing.assert_allclose(np.linalg.norm(planes[:, :3], axis=1), 1)
    weights = rng.dirichlet(np.full(8, 0.3), 2000)
    inside, t = weights @ space, rng.random((2000, 1))
    if lamp[3]:
        between = inside + t * (np.array(lamp[:3]) - inside)
    else:
        between = inside + 50 * t * np.array(lamp[:3])
    assert (between @ planes[:, :3].T + planes[:, 3] > -1e-9).all()
    around = rng.uniform(-40, 40, (2000, 3))
    share = np.mean((around @ planes[:, :3].T + planes[:, 3] > 0).all(axis=1))
    assert share < 0.1 and math.isfinite(share)


def test_places_in_a_pyramid_hold_all_of_a_body_that_is_there_and_bodies_beyond_have_none():
    rng, half = np.random.default_rng(5), 1.05
    bits = np.array([(k >> 2 & 1, k >> 1 & 1, k & 1) for k in range(8)]) * 2.0 - 1
    middles, axes, reach = rng.normal(0, 3, (200, 1, 3)), rng.normal(0, 0.7, (200, 3, 3)), rng.uniform(0, 0.3, 200)
    places, count = places_in_pyramid(middles + bits @ axes, half, reach)
    inside = middles + rng.uniform(-1, 1, (200, 4000, 3)) @ axes
    # distances to the sides of the pyramid, which is widened by so much
    x, y, z = (inside / math.hypot(1, half)).transpose(2, 0, 1)
    is_there = np.maximum(abs(x), abs(y)) + half * z < reach[:, None]
    for body, is_met, there, every in zip(places, count, is_there, inside, strict=True):
        assert is_met.any() or not there.any()
        if there.any():
            assert (every[there] >= body[is_met].min(axis=0) - 1e-9).all()
            assert (every[there] <= body[is_met].max(axis=0) + 1e-9).all()
    # and few are taken to be there that are not
    assert is_there.any(axis=1).sum() <= count.any(axis=1).sum() <= 1.1 * is_there.any(axis=1).sum() < 150
