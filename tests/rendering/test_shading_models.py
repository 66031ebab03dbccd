# SPDX-License-Identifier: GPL-3.0-or-later
"""Each shading model agrees with values computed by hand and with its float64 twin."""

import math
from dataclasses import replace
from importlib import import_module

import numpy as np
import pytest

from splat_addon.reference import render_exact, scenes
from splat_addon.reference.metrics import psnr
from splat_addon.reference.shading_models import SHADERS, heat
from splat_addon.rendering import (
    Camera,
    Environment,
    Instance,
    Light,
    Matcap,
    Material,
    Ramp,
    Scene,
    Settings,
    look_at,
    plan,
)
from splat_addon.rendering.passes.decisions import extent
from splat_addon.rendering.scene.equirectangular import equirectangular_directions
from splat_addon.rendering.shading_models import SHADING_MODELS
from splat_addon.surfels import Surfels

COLOR = np.array((0.8, 0.4, 0.2))
SIZE = (16, 16)
ABOVE = Camera.orthographic(look_at((0, 0, 5), (0, 0.001, 0)), 1.0, SIZE, near=0.1, far=20)


#: Red grows to the right, green to the top.
BALL = Matcap(np.stack([*np.meshgrid(np.linspace(0, 1, 32), np.linspace(0, 1, 16)), np.full((16, 32), 0.5)], axis=2))


def floor(height=0.0, half=2.0, side=24):
    """Surfels of a square that faces up."""
    axis = (np.arange(side) + 0.5) * 2 * half / side - half
    x, y = (a.ravel() for a in np.meshgrid(axis, axis))
    count = len(x)
    return Surfels(
        positions=np.stack([x, y, np.full(count, height)], axis=1),
        rotations=np.tile((1.0, 0, 0, 0), (count, 1)),
        scales=np.full((count, 2), 3.2 * half / side),
        normals=np.tile((0.0, 0, 1), (count, 1)),
        colors=np.tile((*COLOR, 1.0), (count, 1)),
        materials=np.zeros(count, np.int32),
    )


def center(frame):
    return frame.color[SIZE[1] // 2, SIZE[0] // 2, :3]


def from_above(cosine, energy=2.0, **others):
    """A sun whose direction has that cosine with the floor's normal."""
    return Light("sun", energy=energy, direction=(math.sqrt(1 - cosine**2), 0, -cosine), **others)


def test_every_model_has_a_twin():
    assert SHADERS.keys() == SHADING_MODELS.keys()


def test_normals_are_those_of_the_world(render):
    frame = render(Scene([floor()]), ABOVE, Settings(shading="normals"))
    assert center(frame) == pytest.approx((0.5, 0.5, 1.0), abs=1e-5)
    below = Camera.orthographic(look_at((0, 0, -5), (0, 0.001, 0)), 1.0, SIZE, near=0.1, far=20)
    turned = render(Scene([floor()]), below, Settings(shading="normals"))
    assert center(turned) == pytest.approx((0.5, 0.5, 0.0), abs=1e-5)


@pytest.mark.parametrize("edge", [None, 4])
def test_depth_runs_from_the_nearest_to_the_farthest(edge, render, monkeypatch):
    """This also holds if tiles see different parts of the scene."""
    if edge:
        monkeypatch.setattr(import_module("splat_addon.rendering.plan.tiles"), "MAX_TARGET_EDGE", edge)
    step = replace(floor(2.0, half=0.5), positions=floor(2.0, half=0.5).positions + np.float32((-0.5, 0, 0)))
    frame = render(Scene([floor(), step]), ABOVE, Settings(method="quad", shading="depth", supersampling=1))
    found = frame.stats["plan"].find(extent)
    near, far = found.near, found.far
    assert 2.8 < near < 3 and 5 < far < 5.5  # of boxes around splats
    covered = frame.coverage > 0
    assert np.allclose(frame.color[covered, 0], ((frame.depth - near) / (far - near))[covered], atol=1e-4)
    assert frame.color[8, 1, 0] < 0.1 and frame.color[8, 14, 0] > 0.8


@pytest.mark.parametrize("metallic", [0.0, 1.0])
@pytest.mark.parametrize("roughness", [0.3, 1.0])
def test_phong_is_lambert_and_blinns_lobe(roughness, metallic, render):
    """Light, viewer and normal are in one line, so that all cosines are 1."""
    material = Material(roughness=roughness, metallic=metallic)
    scene = Scene([Instance(floor(), materials=(material,))], [from_above(1.0)], world=(0.1, 0.2, 0.3))
    seen = center(render(scene, ABOVE, Settings(shading="phong")))
    f0 = ((material.ior - 1) / (material.ior + 1)) ** 2
    specular = f0 + (COLOR - f0) * metallic
    exponent = 2 / roughness**4 - 2
    diffuse = COLOR * (1 - metallic)
    lit = 2.0 * (diffuse / math.pi + specular * (exponent + 8) / (8 * math.pi))
    assert seen == pytest.approx(lit + (diffuse + specular) * (0.1, 0.2, 0.3), rel=2e-3)


@pytest.mark.parametrize("world", [(0, 0, 0), (3, 2, 1)])
def test_a_captured_color_needs_no_light_and_lights_add_theirs(world, render):
    """It does not look at the world, and ambient occlusion darkens it even where that is dark."""
    settings = Settings(method="quad", shading="captured")
    assert center(render(Scene([floor()], world=world), ABOVE, settings)) == pytest.approx(COLOR, rel=1e-5)
    lit = Scene([floor()], [from_above(0.5)], world=world)
    assert center(render(lit, ABOVE, settings)) == pytest.approx(COLOR * (1 + 2 * 0.5 / math.pi), rel=1e-5)
    beside = np.eye(4)
    beside[0, 3] = 2.3  # of a floor that reaches 2.2 to both sides
    groove = Scene([Instance(floor()), Instance(floor(0.5), beside)], world=world)
    occluded = render(groove, ABOVE, replace(settings, ambient_occlusion=2.0))
    assert (center(occluded) < 0.95 * COLOR).all()


@pytest.mark.parametrize("steps", [2, 3, 5])
def test_toon_light_comes_in_even_levels(steps, render):
    levels = set()
    for cosine in np.linspace(0.05, 0.99, 8):
        scene = Scene([Instance(floor(), materials=(Material(roughness=1.0),))], [from_above(cosine)])
        settings = Settings(shading="toon", toon_steps=steps, toon_softness=0.0)
        seen = center(render(scene, ABOVE, settings))
        level = min(math.floor(cosine * steps), steps - 1) / (steps - 1)
        assert seen == pytest.approx(COLOR * level * 2.0 / math.pi, abs=1e-5)
        levels.add(level)
    assert len(levels) == steps


def test_a_toon_highlight_has_an_edge(render):
    """On a ball every sample is inside or outside the highlight, and all inside are equally bright."""
    scene, camera = scenes.sphere(size=(48, 48))
    (ball,) = scene.surfels
    white = replace(ball.surfels, colors=np.ones_like(ball.surfels.colors))
    scene = Scene([replace(ball, shape=white, materials=(Material(roughness=0.35),))], [from_above(0.6)])
    seen = render(scene, camera, Settings(method="quad", shading="toon", toon_softness=0.0, supersampling=1)).color
    values = {round(float(v), 4) for v in seen[..., 0].ravel()}
    highlight = 2 / math.pi * (1 + 1 - 0.35)
    assert round(highlight, 4) in values
    assert len(values) <= 6  # background, three levels, the highlight on two of them


@pytest.mark.parametrize("cosine", [0.1, 0.5, 0.9])
def test_a_ramp_is_looked_up_at_the_diffuse_light(cosine, render):
    """Where no light arrives, the start of the ramp is seen."""
    colors = np.array([(0.0, 0.1, 0.4), (0.8, 0.2, 0.2), (1, 1, 0.5)])
    settings = Settings(shading="ramp", ramp=Ramp(colors))
    seen = center(render(Scene([floor()], [from_above(cosine, math.pi)]), ABOVE, settings))
    expected = [np.interp(cosine, (0, 0.5, 1), channel) for channel in colors.T]
    assert seen == pytest.approx(COLOR * expected, abs=1e-4)
    assert center(render(Scene([floor()], [from_above(-0.5)]), ABOVE, settings)) == pytest.approx(COLOR * colors[0])


def test_the_default_ramp_has_the_toon_models_levels(render):
    for cosine in (0.2, 0.5, 0.9):
        scene = Scene([Instance(floor(), materials=(Material(roughness=1.0),))], [from_above(cosine, math.pi)])
        ramp, toon = (Settings(shading=shading, toon_softness=0.0) for shading in ("ramp", "toon"))
        assert center(render(scene, ABOVE, ramp)) == pytest.approx(center(render(scene, ABOVE, toon)), abs=1e-5)


def test_a_matcap_is_looked_up_where_its_ball_faces_the_same_way(render):
    """A floor seen from above faces as the middle of the ball does; seen at a slant, as its top."""
    scene, settings = Scene([floor()]), Settings(shading="matcap", matcap=BALL)
    assert center(render(scene, ABOVE, settings)) == pytest.approx(COLOR * (0.5, 0.5, 0.5), abs=1e-3)
    slant = Camera.orthographic(look_at((0, -5, 5 * math.tan(math.radians(30))), (0, 0, 0)), 1.0, SIZE, 0.1, 20)
    up = np.interp((0.496 * math.cos(math.radians(30)) + 0.5) * 16 - 0.5, np.arange(16), np.linspace(0, 1, 16))
    assert center(render(scene, slant, settings)) == pytest.approx(COLOR * (0.5, up, 0.5), abs=1e-3)


@pytest.mark.parametrize("count", [1, 4, 16, 64])
def test_overdraw_and_weight_are_counted(count, render):
    """That many splats lie at one place, and the pixel shows their centre."""
    names = ("rotations", "scales", "normals", "colors", "materials")
    splat = Surfels(np.zeros((count, 3)), **{name: getattr(floor(), name)[:count] for name in names})
    for shading, value in (("overdraw", count), ("weight", 16 * count)):
        frame = render(Scene([splat]), ABOVE, Settings(method="quad", supersampling=1, shading=shading))
        (expected,) = heat(np.log2([value]) / 8)
        assert center(frame) == pytest.approx(expected, abs=0.06 if shading == "weight" else 1e-5)
        assert np.ptp(frame.color[..., :3]) > 0


@pytest.mark.parametrize("name", [name for name in SHADING_MODELS if name != "principled"])
def test_picture_is_that_of_the_twin(name, render):
    scene, camera = scenes.torus(size=(64, 64))
    settings = Settings(method="quad", supersampling=2, shading=name, matcap=BALL, detail_tolerance=0)
    frame, exact = render(scene, camera, settings), render_exact(scene, camera, settings, samples=2)
    different = np.abs(frame.color - exact.color).max(axis=2) > 2e-4
    assert np.count_nonzero(different) <= 3
    assert np.ptp(exact.color[..., :3]) > 0.3


def test_models_plan_no_more_than_they_look_at():
    (thing,) = Scene([floor()]).surfels
    other = replace(thing, materials=(Material(roughness=0.1, emission=(1, 0, 0)),))
    sky = Environment(np.ones((4, 8, 3), np.float32))
    lights = [from_above(0.9, casts_shadow=True, size=0.1, receivers=(0,))]
    for model in SHADING_MODELS.values():
        planned = plan(Scene([thing, other], lights, environment=sky), ABOVE, Settings(shading=model.name, matcap=BALL))
        read = {name for p in planned.passes for name in p.reads if p.name == "deferred_lighting"}
        assert ("lights" in read) == ("gbuffer_light_set" in read) == ("shadow_maps" in read) == model.is_lit
        assert ("gbuffer_material" in read) == ("gbuffer_emission" in read) == model.has_material
        assert ("environment_levels" in read) == model.has_world
        assert ("brdf_table" in read) == (model.name == "principled")
        assert planned.has("SIZED_LIGHTS") == model.is_lit


@pytest.mark.parametrize(
    ("wrong", "why"),
    [
        ({"shading": "shiny"}, "shading must be one of principled"),
        ({"shading": "matcap"}, "needs a picture"),
        ({"ramp": object()}, "ramp must be a Ramp"),
        ({"toon_steps": 1}, "toon_steps must be 2 to"),
        ({"toon_softness": 1.5}, "toon_softness must be 0 to 1"),
    ],
)
def test_unusable_settings_are_refused(wrong, why):
    with pytest.raises(ValueError, match=why):
        Settings(**wrong)


@pytest.mark.parametrize("shading", ["phong", "principled"])
def test_the_picture_of_the_world_is_a_light_map(shading, render):
    """A small sun in the picture of a dark world, whose light is looked up by the normal (Botsch and Kobbelt 2003,
    section 4; Botsch et al. 2005, section 6), lights as a sun does that is computed for every sample."""
    scene, camera = scenes.sphere(size=(64, 64))
    (ball,) = scene.surfels
    matt = replace(ball, materials=(Material(roughness=1.0, ior=1.0),))
    directions, share = equirectangular_directions((64, 128))
    toward = np.array((-0.6, -0.64, 0.48))
    disc = directions @ toward > math.cos(0.15)
    pixels = np.where(disc, 3.0 / (share * disc).sum(), 0)[:, None].repeat(3, axis=1).reshape(64, 128, 3)
    sky = replace(scene, surfels=(matt,), world=(1, 1, 1), environment=Environment(pixels), lights=())
    sun = replace(scene, surfels=(matt,), world=(0, 0, 0), lights=(Light("sun", energy=3.0, direction=-toward),))
    settings = Settings(method="quad", supersampling=1, shading=shading, shadow_resolution=0, transparent_film=True)
    looked_up, computed = (render(one, camera, settings).color for one in (sky, sun))
    assert computed[..., 0].max() > 0.4
    assert psnr(looked_up, computed) > 35
