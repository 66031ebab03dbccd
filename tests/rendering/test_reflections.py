# SPDX-License-Identifier: GPL-3.0-or-later
"""Glossy objects reflect what stands around them: a ball of metal is compared with rays in closed form."""

import re
from dataclasses import replace

import numpy as np
import pytest

from splat_addon.reference import scenes
from splat_addon.reference.brdf import dot, unit
from splat_addon.reference.reflections import map_at, met_directions, met_in_picture
from splat_addon.rendering import (
    Camera,
    Frame,
    Light,
    Material,
    PolygonInstance,
    Renderer,
    Scene,
    look_at,
    make_polygons,
    plan,
)
from splat_addon.rendering.features import reflections
from splat_addon.rendering.plan.programs import describe
from splat_addon.rendering.probes import drawing, pictures
from splat_addon.rendering.probes.pictures import LEVEL_SIDE, _lobes
from splat_addon.rendering.probes.places import MAX_PROBES, probes_of
from splat_addon.rendering.probes.screen import wider_camera
from splat_addon.rendering.scene.finish import Finish
from splat_addon.rendering.scene.light_probe import LightProbe
from splat_addon.rendering.scene.octahedral import Octahedral, bordered
from splat_addon.rendering.shadows.receivers import Viewers
from tests.rendering.reflecting_scenes import (
    CHROME,
    DULL,
    FLOOR,
    GREEN,
    HEIGHT,
    MIRROR,
    RADIUS,
    RED,
    SETTINGS,
    SKY,
    ball,
    camera,
    floor,
    glowing,
    rays_of,
    true_colors,
)


def test_a_ball_of_metal_reflects_what_rays_meet(render):
    """The border of the two colours lies where rays say, and not where the middle of the ball sees it."""
    view = camera()
    hits, place, direction = rays_of(view)
    ours, true = render(MIRROR, view, SETTINGS).color[hits][:, :3], true_colors(place, direction)
    assert len({tuple(color) for color in true}) == 3
    off = np.abs(ours - true).max(axis=1)
    assert np.mean(off < 0.05) > 0.95 and np.median(off) < 0.01
    from_middle = true_colors(np.tile((0, 0, HEIGHT), (len(place), 1)), direction)
    apart = (from_middle != true).any(axis=1)
    assert apart.sum() > 10
    assert off[apart].mean() < 0.35 * np.abs(ours - from_middle)[apart].max(axis=1).mean()
    bare = render(MIRROR, view, replace(SETTINGS, reflections=False)).color[hits][:, :3]
    assert np.mean(np.abs(bare - true).max(axis=1) < 0.05) < 0.6


def test_the_rim_of_what_is_near_a_ball_lies_where_rays_pass_it(render):
    """Rays meet a board up to its rim and not beyond."""
    corner, wide, high = np.array([(-0.576, 0.387, 0.5), (-0.737, -0.311, 0.0), (0.0, 0.0, 1.2)])
    board = make_polygons([corner, corner + wide, corner + wide + high, corner + high], [(0, 1, 2), (0, 2, 3)])
    board = replace(board, colors=np.tile((0.0, 0, 0, 1), (6, 1)))
    view = camera((128, 128))
    hits, place, direction = rays_of(view)
    scene = Scene(polygons=[ball(), PolygonInstance(board, materials=(glowing(RED),))], world=tuple(SKY))
    ours = render(scene, view, SETTINGS).color[hits][:, :3]
    system = np.stack(np.broadcast_arrays(wide, high, -direction), axis=2)
    across, up, along = np.linalg.solve(system, (place - corner)[..., None])[..., 0].T
    inside = np.min([across, 1 - across, up, 1 - up], axis=0)
    meets = (along > 0) & (inside > 0)
    assert 200 < meets.sum() < 0.5 * len(meets)
    is_red = np.abs(ours - RED).max(axis=1) < np.abs(ours - SKY).max(axis=1)
    assert np.count_nonzero(is_red != meets) < 0.05 * meets.sum()


def test_a_mirror_in_a_mirror_shows_what_stands_around(render):
    """Rays that meet the second ball are reflected once more, and do not end in the world's colour."""
    second = np.array((-0.55, -0.85, HEIGHT + 0.1))
    scene, view = replace(MIRROR, polygons=[ball(), ball(place=second, radius=0.4), FLOOR]), camera((96, 96))
    hits, place, direction = rays_of(view)
    frame = render(scene, view, SETTINGS)
    shown = np.linalg.norm(view.points_at(frame.depth)[hits] - place, axis=1) < 0.01  # not hidden by the second ball
    along = ((second - place) * direction).sum(axis=1)
    square = 0.4**2 - (((second - place) ** 2).sum(axis=1) - along**2)
    meets = shown & (along > 0) & (square > 0.15**2)  # not at the rim
    at = place[meets] + (along[meets] - np.sqrt(square[meets]))[:, None] * direction[meets]
    normal = (at - second) / 0.4
    again = direction[meets] - 2 * (direction[meets] * normal).sum(axis=1, keepdims=True) * normal
    true, ours = true_colors(at, again), frame.color[hits][meets][:, :3]
    is_close, is_ground = np.abs(ours - true).max(axis=1) < 0.1, (true != SKY).any(axis=1)
    assert is_ground.sum() > 50 and is_close[is_ground].mean() > 0.5


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


@pytest.fixture
def seeing(on_device):
    """seeing(scene, camera) -> its frame, that of its first probe, and what the camera sees, with its camera."""

    def draw(device, scene, view):
        renderer, wider = Renderer(device), wider_camera(view)
        frame = renderer.render(scene, view, SETTINGS)
        return frame, renderer.planner.probes._kept[1]._frames[0], (wider, renderer.planner.probes._screen[1]._seen)

    return lambda *what: on_device(lambda device: draw(device, *what))


def test_the_shader_meets_what_its_twin_meets(seeing):
    """Where rays meet something in the picture it is that, and else what they meet among what the probe sees."""
    view = camera()
    hits, place, direction = rays_of(view)
    frame, seen, (wider, pixels) = seeing(MIRROR, view)
    ours = frame.color[hits][:, :3]
    met = map_at(seen.color, met_directions(seen, place - (0, 0, HEIGHT), direction))
    on_screen = met_in_picture(wider, pixels.depth, place, direction)
    inside = (np.minimum(on_screen, wider.size - on_screen) > 0.09 * np.array(wider.size)).all(axis=1)
    column, row = on_screen[inside].astype(int).T
    met[inside] = pixels.color[row, column]
    twin = met[:, :3] + (1 - met[:, 3:]) * SKY
    off = np.abs(ours - twin).max(axis=1)
    assert np.mean(off < 0.03) > 0.95 and inside.sum() > 100


def striped(count=80, width=0.1):
    """A floor of stripes along the Y axis, which glow red and green in turn."""
    edges = (np.arange(count + 1) - count // 2) * width
    places = [(x, y, 0) for x in edges for y in (-30, 30)]
    faces = [(2 * k + a, 2 * k + b, 2 * k + c) for k in range(count) for a, b, c in ((0, 2, 3), (0, 3, 1))]
    made = make_polygons(places, faces, colors=np.tile((0.0, 0, 0, 1), (3 * len(faces), 1)))
    made = replace(made, materials=np.repeat(np.arange(count, dtype=np.int32) % 2, 6))
    return PolygonInstance(made, materials=(glowing(RED), glowing(GREEN))), lambda x: np.floor(x / width) % 2 < 1


def test_what_the_camera_sees_is_reflected_from_there(render, monkeypatch):
    """Stripes that are finer than a probe's texels have their places where rays meet the visible floor."""
    ground, is_red = striped()
    scene = replace(MIRROR, polygons=[ball(), ground])
    view = Camera.perspective(look_at((0.4, -4, 2.4), (0, 0, 0.6)), 0.7, (160, 160), near=0.1, far=500)
    hits, place, direction = rays_of(view)
    on = render(scene, view, SETTINGS).color[hits][:, :3]
    monkeypatch.setattr(reflections, "sees_screen", lambda planning: False)
    off = render(scene, view, SETTINGS).color[hits][:, :3]
    at = place - direction * (place[:, 2:] / direction[:, 2:])
    to_view = view.world_to_view()
    seen = at @ to_view[:3, :3].T + to_view[:3, 3]
    beside = np.abs(seen[:, :2] / seen[:, 2:]).max(axis=1)
    visible = (direction[:, 2] < -0.05) & (beside < 0.36) & (seen[:, 2] < 0) & (np.abs(at[:, 0]) < 3.5)
    true = np.where(is_red(at[:, :1]), RED, GREEN)[visible]
    wrong = [np.mean(np.abs(one[visible] - true).max(axis=1) > 0.3) for one in (on, off)]
    assert visible.sum() > 300 and wrong[0] < 0.7 * wrong[1]


def test_rays_of_many_samples_fill_a_rough_lobe(render):
    """Their mean is that of the GGX lobe, over the normals that face the viewer (Heitz 2018)."""
    view = camera((32, 32))
    hits, place, _ = rays_of(view)
    rough = replace(MIRROR, polygons=[ball(Material(roughness=0.4, metallic=1.0)), FLOOR])
    ours = render(rough, view, replace(SETTINGS, samples=16)).color[hits][:, :3]
    normal = (place - (0, 0, HEIGHT)) / RADIUS
    to_eye = unit(view.matrix_world[:3, 3] - place)
    random = np.random.default_rng(1)
    total, weights = np.zeros((len(place), 3)), np.zeros((len(place), 1))
    for _ in range(600):
        slope = 0.4**2 * np.sqrt(1 / random.uniform(size=len(place)) - 1)
        turn = random.uniform(0, 2 * np.pi, len(place))
        u = unit(np.cross(normal, (1.0, 0.1, 0.0)))
        v = np.cross(normal, u)
        half = unit(normal + (slope * np.cos(turn))[:, None] * u + (slope * np.sin(turn))[:, None] * v)
        cosine = dot(half, to_eye)[:, None]
        out = 2 * cosine * half - to_eye
        facing = np.maximum(dot(out, normal), 0)[:, None] * np.maximum(cosine, 0) / dot(half, normal)[:, None]
        total += facing * true_colors(place, out)
        weights += facing
    off = np.abs(ours - total / weights)[dot(to_eye, normal) > 0.4].max(axis=1)
    assert off.mean() < 0.04 and np.quantile(off, 0.95) < 0.12


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


def test_a_rough_metal_reflects_the_mean_of_its_lobe(render):
    """Halfway up, a very rough ball mixes floor and sky, and a smooth one shows either."""
    view = camera()
    hits, _, direction = rays_of(view)
    rough = replace(MIRROR, polygons=[ball(Material(roughness=0.7, metallic=1.0)), FLOOR])
    ours = render(rough, view, SETTINGS).color[hits][:, :3]
    up, down = direction[:, 2] > 0.8, direction[:, 2] < -0.5
    assert ours[up].mean(axis=0) == pytest.approx(SKY, abs=0.12)
    assert ours[down, 2].mean() < 0.25 < ours[np.abs(direction[:, 2]) < 0.2, 2].mean() < 0.7
    assert np.abs(np.diff(np.sort(ours[:, 2]))).max() < 0.05


def test_a_ball_does_not_see_itself_but_its_shadow(seeing, coarse):
    sunny = Scene(
        polygons=[ball(), PolygonInstance(scenes.polygons(10)[0].polygons[0].polygons)],
        lights=(Light("sun", energy=3, direction=(0, 0, -1), casts_shadow=True),),
    )
    _, seen, _ = seeing(sunny, camera())
    directions = Octahedral(len(seen.color) - 2).directions(*_places(len(seen.color)))
    below, aside = directions[..., 2] < -0.99, np.abs(directions[..., 2] + 0.85) < 0.01
    assert seen.depth[below].min() > 2 * RADIUS
    assert seen.color[below][:, 3].min() > 0.99 and seen.color[below][:, :3].max() < 0.01
    assert seen.color[aside & (seen.color[..., 3] > 0.99)][:, :3].max() > 0.1


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
    assert drawing._left_out(replace(scene, polygons=scene.polygons[:1]), ()).polygons == scene.polygons[:1]
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
    assert dict(made.skipped)["reflections of 3 objects"] == f"there is room for {MAX_PROBES} probes"


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


def test_no_rim_of_a_box_shows_on_a_floor_in_it(render):
    """A floor through the lower part of the ball and its box, whose corner is seen from above, below another ball."""
    ground = replace(floor(), positions=floor().positions + np.float32((0, 0, HEIGHT - 0.8 * RADIUS)))
    ground = replace(ground, colors=np.ones_like(ground.colors))
    rough = PolygonInstance(ground, materials=(Material(roughness=0.6, ior=4.0),) * 2)
    red = ball(glowing(RED), (-0.45, -0.45, 2.2), RADIUS)
    above = look_at((-0.45, -0.45, 1.5), (-0.45, -0.45, 0), (0, 1, 0))
    view = Camera.orthographic(above, 0.2, (64, 64))
    scene = Scene(polygons=[ball(), rough, red], world=tuple(SKY))
    row = render(scene, view, SETTINGS).color[32, :, :3]
    bare = render(scene, view, replace(SETTINGS, reflections=False)).color[32, :, :3]
    assert np.abs(row - bare).max() > 0.01
    assert np.abs(np.diff(row, axis=0)).max() < 0.25 * np.abs(row - bare).max()


@pytest.mark.parametrize("kind", ["a mirror", "a probe"])
def test_reflections_show_what_is_behind_glass(kind, render):
    """Behind the camera glows a wall, in front of which stands a pane that only tints, from both sides."""
    tint = np.array((0.5, 0.9, 0.7))
    clear = Material(roughness=0.0, ior=1.0, finish=Finish(transmission=1.0, tint_power=1.0))

    def wall(y, turned, material, color):
        places = [(-9, y, -9), (9, y, -9), (9, y, 9), (-9, y, 9)]
        faces = [(0, 1, 2), (0, 2, 3)] if turned else [(0, 2, 1), (0, 3, 2)]
        return PolygonInstance(make_polygons(places, faces, color=(*color, 1)), materials=(material,))

    shiny = ball(radius=0.5) if kind == "a probe" else wall(0.0, True, CHROME, (1, 1, 1))
    sides = [wall(-5.0, False, clear, tint), wall(-5.1, True, clear, tint)]
    seen = Scene(polygons=[shiny, *sides, wall(-6.0, False, glowing(RED), (0, 0, 0))], world=(0.2, 0.2, 0.2))
    view = Camera.perspective(look_at((0.0, -4, 1.0), (0, 0, 1)), 0.05, (8, 8), near=0.1, far=50)
    ours = render(seen, view, replace(SETTINGS, refraction=True)).color[..., :3].reshape(-1, 3)
    assert ours == pytest.approx(np.tile(tint**2 * RED, (64, 1)), abs=0.02)
