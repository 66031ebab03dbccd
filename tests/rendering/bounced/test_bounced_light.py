# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures have bounced light: as the twin looks it up, kept while the scene stays, and without a trace where it is
off."""

from dataclasses import replace

import numpy as np
import pytest

from splat_addon.reference import scenes
from splat_addon.reference.bounced_light import bounced_at
from splat_addon.rendering import (
    Camera,
    Light,
    Material,
    PolygonInstance,
    Renderer,
    Scene,
    Settings,
    look_at,
    make_polygons,
    plan,
)
from splat_addon.rendering.bounced import kept
from splat_addon.rendering.bounced.light import bounced_light
from splat_addon.rendering.plan.programs import describe

MATT = Material(roughness=1.0, ior=1.0)
FLOOR = PolygonInstance(
    make_polygons([(-2, -2, 0), (2, -2, 0), (2, 2, 0), (-2, 2, 0)], [(0, 1, 2), (0, 2, 3)], color=(0.8, 0.3, 0.2, 1)),
    materials=(MATT,),
)
BALL = PolygonInstance(
    replace(scenes.round_polygons(24), is_solid=True),
    np.array([[0.6, 0, 0, 0.2], [0, 0.6, 0, 0.1], [0, 0, 0.6, 0.7], [0, 0, 0, 1]]),
    materials=(MATT,),
)
SCENE = Scene(polygons=[FLOOR, BALL], lights=[Light("sun", energy=2.0, direction=(1, 0.5, -2))], world=(0.2, 0.3, 0.5))
CAMERA = Camera.perspective(look_at((0, -4, 2), (0, 0, 0.3)), vertical_fov=0.7, size=(32, 32))
ON = Settings(method="quad", bounces=2)
#: Cubes, merged surfels and rays that suffice for small pictures.
COARSE = {"voxels": 1 << 14, "surfels": 500, "rays": 1 << 14}


@pytest.fixture(autouse=True)
def coarse(monkeypatch):
    """Gathers few rays, and counts how often."""
    calls = []

    def few(scene, solid, bounces, **draft):
        calls.append((bounces, "draft") if draft else bounces)
        return bounced_light(scene, solid, bounces, **COARSE)

    monkeypatch.setattr(kept, "bounced_light", few)
    return calls


@pytest.mark.parametrize("shading", ("principled", "phong", "toon"))
def test_matt_surfaces_show_what_the_twin_looks_up(render, shading):
    settings = replace(ON, shading=shading, outputs=("color", "depth", "normal", "position", "diffuse_color"))
    scene = replace(SCENE, lights=())
    frame = render(scene, CAMERA, settings)
    seen = frame.depth < 100
    if shading == "principled":
        light = bounced_light(scene, np.array([False, True]), 2, **COARSE)
        expected, _ = bounced_at(light, frame.position[seen], frame.normal[seen])
        expected = expected * frame.diffuse_color[seen][:, :3]
        assert np.abs(frame.color[seen][:, :3] - expected).max() < 2e-5
    else:
        plain = render(scene, CAMERA, replace(settings, bounces=0))
        assert (np.abs(plain.color - frame.color)[seen].max(axis=1) > 1e-3).mean() > 0.8


def test_a_view_begins_with_a_draft_that_serves_until_the_picture_is_refined(coarse):
    held, eye = kept.Bounced(), CAMERA.matrix_world[:3, 3]
    drafts = [held.of(SCENE, eye, 1, is_draft=True) for _ in range(2)]
    refined = held.of(SCENE, eye, 1)
    assert coarse == [(1, "draft"), 1] and drafts[0] is drafts[1]
    assert held.of(SCENE, eye, 1, is_draft=True) is refined


def test_light_is_kept_while_the_scene_stays(on_device, coarse):
    beside = Camera.perspective(look_at((1, -4, 2), (0, 0, 0.3)), vertical_fov=0.7, size=CAMERA.size)
    dim = replace(SCENE, world=(0.0, 0, 0.1))

    def draw(device):
        renderer = Renderer(device)
        renderer.render(SCENE, CAMERA, ON)
        renderer.render(replace(SCENE, background=(1.0, 0, 0)), beside, ON)
        assert coarse == [2]
        renderer.render(dim, CAMERA, ON)
        renderer.render(dim, CAMERA, replace(ON, bounces=1))
        assert coarse == [2, 2, 1]

    on_device(draw)


@pytest.mark.parametrize(
    ("settings", "why"),
    [
        ({"bounces": 0}, "it is switched off"),
        ({"shading": "flat"}, "flat shading has none"),
        ({"lights_splats": True, "outputs": ("color",)}, "splats are lit one by one"),
    ],
)
def test_where_there_is_none_nothing_is_there_and_the_plan_says_why(render, coarse, settings, why):
    settings = replace(ON, **settings)
    made, usual = (plan(SCENE, CAMERA, s) for s in (settings, replace(settings, bounces=0)))
    assert dict(made.skipped)["bounced light"] == why
    assert [str(p.parts) for p in made.passes] == [str(p.parts) for p in usual.passes]
    lit = next(p for p in made.passes if p.host == "shading.frag")
    described = describe(made, lit)
    assert "bounced" not in described.samplers and "bounced" not in described.fragment
    render(SCENE, CAMERA, settings)
    assert not coarse


def test_occlusion_of_the_picture_is_left_out_beside_it():
    found = plan(SCENE, CAMERA, replace(ON, ambient_occlusion=1.0))
    assert "occlusion" not in [p.name for p in found.passes]
    assert any("bounced light knows" in why for _, why in found.skipped)


def test_bounces_are_a_number_within_its_limits():
    with pytest.raises(ValueError, match="bounces must be 0 to 16"):
        Settings(bounces=17)
