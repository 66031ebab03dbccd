# SPDX-License-Identifier: GPL-3.0-or-later
"""Glossy objects reflect what stands around them: pictures of metal are compared with rays in closed form."""

from dataclasses import replace

import numpy as np
import pytest

from splat_addon.reference.brdf import dot, unit
from splat_addon.reference.reflections import map_at, met_directions, met_in_picture
from splat_addon.rendering import (
    Camera,
    Material,
    PolygonInstance,
    Scene,
    look_at,
    make_polygons,
)
from splat_addon.rendering.features import reflections
from splat_addon.rendering.scene.finish import Finish
from tests.rendering.reflecting_scenes import (
    CHROME,
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
    seen_by_probe,
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


def test_the_shader_meets_what_its_twin_meets(on_device):
    """Where rays meet something in the picture it is that, and else what they meet among what the probe sees."""
    view = camera()
    hits, place, direction = rays_of(view)
    frame, probe, (wider, pixels) = on_device(lambda device: seen_by_probe(device, MIRROR, view))
    ours = frame.color[hits][:, :3]
    met = map_at(probe.color, met_directions(probe, place - (0, 0, HEIGHT), direction))
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
