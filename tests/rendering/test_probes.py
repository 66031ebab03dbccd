# SPDX-License-Identifier: GPL-3.0-or-later
"""Which objects have probes, how fine these are, what they see, and when they are drawn."""

import re
from dataclasses import replace

import numpy as np
import pytest

from splat_addon.reference import scenes
from splat_addon.rendering import (
    Camera,
    Frame,
    Light,
    Material,
    PolygonInstance,
    Renderer,
    Scene,
    look_at,
    plan,
)
from splat_addon.rendering.plan.programs import describe
from splat_addon.rendering.planner import Planner
from splat_addon.rendering.probes import drawing, pictures
from splat_addon.rendering.probes.pictures import LEVEL_SIDE, _lobes
from splat_addon.rendering.probes.places import MAX_PROBES, probes_of
from splat_addon.rendering.probes.screen import wider_camera
from splat_addon.rendering.scene.finish import Finish
from splat_addon.rendering.scene.light_probe import LightProbe
from splat_addon.rendering.scene.octahedral import Octahedral, bordered
from splat_addon.rendering.shadows.receivers import Viewers
from tests.rendering.reflecting_scenes import (
    DULL,
    FLOOR,
    GREEN,
    HEIGHT,
    MIRROR,
    RADIUS,
    SETTINGS,
    ball,
    camera,
    glowing,
    seen_by_probe,
)


def test_what_probes_saw_serves_as_long_as_it_is_fine_and_complete_enough():
    """A draft may lack what mirrors show of one another. Where pictures must be repeatable, finer ones do not serve."""
    scene, drawn, kept = replace(MIRROR, polygons=[ball(), ball(place=(2, 0, 1)), FLOOR]), [], drawing.Probes()
    (probes, _), small, large = probes_of(scene, camera()), pictures.BLUNT_SIDE, pictures.SHARP_SIDE

    def draw(seen, view, of, settings, known):
        drawn.append(known is not None)
        size = view.size[::-1]
        return Frame(color=np.zeros((*size, 4), np.float32), depth=np.ones(size, np.float32), stats={})

    def pictures_of(side, is_draft=False, is_repeatable=False):
        drawn.clear()
        made = kept.pictures(scene, probes, side, SETTINGS, draw, is_draft, is_repeatable)
        return made.side, sorted(set(drawn))

    assert all(probe.sees_others for probe in probes)
    assert pictures_of(small, is_draft=True) == (small, [False])
    assert pictures_of(small) == (small, [False, True])
    assert pictures_of(small, is_draft=True) == (small, [])
    assert pictures_of(large) == (large, [False, True])
    assert pictures_of(small) == (large, [])
    assert pictures_of(small, is_repeatable=True) == (small, [False, True])


def test_what_is_large_in_the_picture_has_finer_probes():
    sides = [pictures.side_of(probes_of(MIRROR, view)[0], view) for view in (camera((64, 64)), camera((512, 512)))]
    assert sides == [pictures.SHARP_SIDE, pictures.LARGE_SIDE]


@pytest.fixture
def coarse(monkeypatch):
    """Probes with few texels, where it does not matter what is seen in them."""
    monkeypatch.setattr(pictures, "SHARP_SIDE", pictures.BLUNT_SIDE)


def test_what_the_camera_sees_is_drawn_once_for_a_view_and_not_for_faces_of_panoramas(on_device, monkeypatch, coarse):
    made, real = [], drawing.ScreenPicture
    monkeypatch.setattr(drawing, "ScreenPicture", lambda *given: made.append(given) or real(*given))
    small = camera((8, 8))

    def draw(device):
        renderer = Renderer(device)
        for of, seen in ((MIRROR, small), (MIRROR, small), (MIRROR, camera((9, 7))), (Scene(polygons=[FLOOR]), small)):
            renderer.render(of, seen, replace(SETTINGS, samples=2))
            yield len(made)

    assert on_device(lambda device: list(draw(device))) == [1, 1, 2, 2]
    around = Viewers(small, (small, replace(small, matrix_world=look_at((0, 0, 0), (1, 0, 0)))))
    assert "reflections of what the camera sees" in dict(plan(MIRROR, small, SETTINGS, viewers=around).skipped)


def test_what_probes_see_through_glass_has_no_more_samples_than_what_they_see():
    """The frame shows what is behind its glass with 2 x 2 samples a pixel; in a probe that is blurred."""
    clear = Material(roughness=0.0, finish=Finish(transmission=1.0))
    seen, small, drawn = replace(MIRROR, polygons=[ball(), ball(clear, (2, 0, 1)), FLOOR]), camera((8, 8)), []

    def draw(shared, view):
        drawn.append((view.size, shared.plan.samples))
        size = view.size[::-1]
        return Frame(color=np.zeros((*size, 4), np.float32), depth=np.ones(size, np.float32), stats={})

    Planner(draw, most_samplers=32).planned(seen, small, replace(SETTINGS, refraction=True))
    *of_probes, behind = drawn
    assert behind == (wider_camera(small).size, 2)
    assert len({size for size, _ in of_probes}) == 2 and {samples for _, samples in of_probes} == {1}


def test_a_ball_does_not_see_itself_but_its_shadow(on_device, coarse):
    sunny = Scene(
        polygons=[ball(), PolygonInstance(scenes.polygons(10)[0].polygons[0].polygons)],
        lights=(Light("sun", energy=3, direction=(0, 0, -1), casts_shadow=True),),
    )
    _, probe, _ = on_device(lambda device: seen_by_probe(device, sunny, camera()))
    directions = Octahedral(len(probe.color) - 2).directions(*_places(len(probe.color)))
    below, aside = directions[..., 2] < -0.99, np.abs(directions[..., 2] + 0.85) < 0.01
    assert probe.depth[below].min() > 2 * RADIUS
    assert probe.color[below][:, 3].min() > 0.99 and probe.color[below][:, :3].max() < 0.01
    assert probe.color[aside & (probe.color[..., 3] > 0.99)][:, :3].max() > 0.1


def _places(count):
    ticks = (np.arange(count) + 0.5) / count
    return ticks[None, :], ticks[:, None]


def test_probes_are_drawn_once_for_a_scene(on_device, monkeypatch, coarse):
    """Another camera, another sample and an equal scene have the same; whatever changes is seen as it is."""
    drawn, real = [], drawing.panorama_frame
    monkeypatch.setattr(drawing, "panorama_frame", lambda *given: drawn.append(given) or real(*given))
    small, parts, moved = camera((8, 8)), MIRROR.polygons, np.eye(4)
    moved[2, 3] = -0.1
    same = [(MIRROR, small), (MIRROR, camera((9, 7))), (replace(MIRROR, polygons=[replace(p) for p in parts]), small)]
    others = (
        {"world": (1, 1, 1)},
        {"polygons": [parts[0], replace(FLOOR, matrix_world=moved)]},
        {"polygons": [parts[0], replace(FLOOR, materials=(glowing(GREEN),))]},
        {"lights": (Light("sun"),)},
    )

    def draw(device):
        renderer = Renderer(device)
        for scene, view in (*same, *((replace(MIRROR, **other), small) for other in others)):
            renderer.render(scene, view, replace(SETTINGS, samples=2))
            yield len(drawn)

    assert on_device(lambda device: list(draw(device))) == [1, 1, 1, 2, 3, 4, 5]


@pytest.mark.parametrize(
    ("scene", "settings", "why"),
    [
        (MIRROR, {"reflections": False}, "they are switched off"),
        (MIRROR, {"shading": "phong"}, "phong shading has none"),
        (replace(MIRROR, polygons=[ball(DULL), FLOOR]), {}, "nothing that is not flat is glossy"),
    ],
)
def test_where_there_are_none_nothing_is_there_and_the_plan_says_why(scene, settings, why):
    made = plan(scene, camera(), replace(SETTINGS, **settings))
    usual = plan(scene, camera(), replace(SETTINGS, **{**settings, "reflections": False}))
    assert dict(made.skipped)["reflections"] == why
    assert [str(p.parts) for p in made.passes] == [str(p.parts) for p in usual.passes]
    lit = next(p for p in made.passes if p.host == "shading.frag")
    described = describe(made, lit, "fullscreen.vert")
    assert not {"probes", "mirror_picture"} & set(described.samplers)
    assert not re.search("probe|mirroring|to_mirror", described.fragment)


@pytest.mark.parametrize(
    ("material", "is_glossy"),
    [
        (Material(roughness=0.9, metallic=1.0), True),
        (Material(roughness=0.1), True),
        (Material(roughness=0.1, ior=1.05), False),
        (DULL, False),
        (Material(roughness=0.8, finish=Finish(coat=1.0)), True),
    ],
)
def test_metals_coats_and_polished_surfaces_are_glossy(material, is_glossy):
    assert len(probes_of(Scene(polygons=[ball(material)]), camera())[0]) == is_glossy


def test_what_lies_in_an_object_is_left_out_with_it_unless_the_camera_is_inside():
    inner, outer = ball(DULL, radius=0.1), ball(radius=RADIUS)
    beside = ball(DULL, place=(0, 3, HEIGHT))
    scene = Scene(polygons=[inner, beside, outer])
    (probe,), _ = probes_of(scene, camera())
    assert probe.left_out == (0, 2) and probe.middle == pytest.approx((0, 0, HEIGHT), abs=1e-6)
    within = Camera.perspective(look_at((0, -0.3, HEIGHT), (0, 1, HEIGHT)), 0.5, (8, 8))
    assert probes_of(scene, within)[0][0].left_out == ()


def test_reflections_show_what_the_camera_does_not_see_but_not_what_they_are_told_not_to():
    hidden, shown = replace(FLOOR, is_seen=False), replace(FLOOR, is_reflected=False)
    scene = Scene(polygons=[ball(), hidden, shown])
    assert [one.is_seen for one in drawing._left_out(scene, (0,)).polygons] == [False, True, False]
    assert drawing._left_out(replace(scene, polygons=scene.polygons[:1]), ()).polygons[0] is scene.polygons[0]
    assert probes_of(Scene(polygons=[replace(ball(), is_seen=False)]), camera()) == ((), 0)


def test_a_light_probe_serves_what_is_in_its_box_in_the_place_of_a_probe_of_its_own():
    axes = np.diag((2.0, 2.0, 2.0))
    scene = Scene(polygons=[ball(), ball(place=(9, 0, 0)), FLOOR], light_probes=(LightProbe((0, 0, 1.2), axes),))
    chosen, own = sorted(probes_of(scene, camera())[0], key=lambda probe: -probe.radius)
    assert chosen.middle == (0, 0, 1.2) and chosen.left_out == (0,) and chosen.roughness == 0
    assert own.middle == pytest.approx((9, 0, 0), abs=1e-6) and own.left_out == (1,)
    assert probes_of(Scene(polygons=[FLOOR], light_probes=scene.light_probes), camera()) == ((), 0)
    with pytest.raises(ValueError, match="must span a box"):
        LightProbe((0, 0, 0), np.zeros((3, 3)))


def test_of_many_the_largest_have_probes_and_the_plan_counts_the_others():
    many = [ball(place=(3 * k, 0, 0), radius=0.1 + 0.01 * k) for k in range(MAX_PROBES + 3)]
    found, without = probes_of(Scene(polygons=many), camera())
    assert len(found) == MAX_PROBES and without == 3 and min(p.radius for p in found) > 0.129
    made = plan(Scene(polygons=many), camera(), SETTINGS)
    assert made.limits[0].startswith("3 glossy objects") and f"{MAX_PROBES} probes" in made.limits[0]


def test_the_border_of_a_map_is_beyond_its_edge():
    directions = Octahedral(8).directions(*_places(10))
    np.testing.assert_allclose(bordered(directions[1:-1, 1:-1]), directions, atol=1e-12)
    assert np.linalg.norm(directions, axis=2) == pytest.approx(1)


def test_lobes_are_around_their_direction_and_keep_what_is_even():
    ticks = _places(LEVEL_SIDE + 2)
    directions = Octahedral(LEVEL_SIDE).directions(*ticks)[1:-1, 1:-1].reshape(-1, 3)
    for weights in _lobes():
        assert weights.sum(axis=1) == pytest.approx(1, abs=1e-4)
        mean = weights @ directions
        mean /= np.linalg.norm(mean, axis=1, keepdims=True)
        assert (mean * directions).sum(axis=1).min() > 0.995
