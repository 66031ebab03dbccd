# SPDX-License-Identifier: GPL-3.0-or-later
"""Objects behind others are not drawn, and no bit of any picture differs."""

import math
from dataclasses import replace
from importlib import import_module

import numpy as np
import pytest

from splat_addon.reference import scenes
from splat_addon.rendering import (
    Camera,
    Equirectangular,
    Instance,
    Lens,
    Light,
    Panorama,
    PolygonInstance,
    Scene,
    Settings,
    look_at,
    make_polygons,
    plan,
)
from splat_addon.rendering.features import hidden_objects, visibility
from splat_addon.rendering.methods import METHODS
from tests.rendering.left_out import ALL, are_equal, pictures

SIZE = (64, 48)
WALL = make_polygons([(-1, 0, -1), (1, 0, -1), (1, 0, 1), (-1, 0, 1)], [(0, 1, 2), (0, 2, 3)])
EYE = look_at((0.2, -4, 0.4), (0, 4, 0))
BALL = scenes.sphere(800, SIZE)[0].surfels[0].surfels


def crowd(rows: int = 7, walls=(2.0,), gap: float = 0.0, step: float = 1.0) -> Scene:
    """Rows of balls behind one another and walls between them, in which there may be a gap, with no ball before it."""
    balls = [
        Instance(BALL, at((0.9 * (k - 3), step * row, 0.1 * k), 0.4), index=1 + 7 * row + k)
        for row in range(rows)
        for k in range(7)
        if k != 3 or step * row > 2
    ]
    halves = [PolygonInstance(WALL, at((side * (2 + gap / 2), y, 0), 2.0), index=99) for y in walls for side in (-1, 1)]
    sun = Light("sun", energy=3, direction=(0.4, 1, -0.7), casts_shadow=True)
    return Scene(tuple(balls[::-1]), (sun,), (0.2,) * 3, polygons=tuple(halves))


def at(place, scale: float) -> np.ndarray:
    matrix = np.diag([scale] * 3 + [1.0])
    matrix[:3, 3] = place
    return matrix


def perspective(**fields) -> Camera:
    return replace(Camera.perspective(EYE, 0.9, SIZE, 0.1, 100), **fields)


@pytest.fixture(autouse=True)
def few_suffice(monkeypatch):
    monkeypatch.setattr(hidden_objects, "LEAST_SURFELS", 1000)


@pytest.mark.parametrize("method", METHODS)
def test_no_method_draws_another_picture(method, render, monkeypatch):
    settings = Settings(method=method, outputs=ALL, detail_tolerance=0.0)
    scene = replace(crowd(), lights=(Light("sun", energy=3, direction=(0.4, 1, -0.7)),))
    one, every = pictures(scene, perspective(), settings, render, monkeypatch)
    assert are_equal(one, every)
    is_looked_for = METHODS[method].rasterizer != "point_sprite" and not METHODS[method].hides_within
    assert (one.stats["instances_hidden"] > 10) == is_looked_for
    assert (one.stats["splats_drawn"] < 0.75 * every.stats["splats_drawn"]) == is_looked_for


@pytest.mark.parametrize("method", ["mip", "ewa_object"])
def test_merged_surfels_are_larger_and_nothing_of_them_is_missing(method, render, monkeypatch):
    one, every = pictures(crowd(), perspective(), Settings(method=method, outputs=ALL), render, monkeypatch)
    assert are_equal(one, every) and one.stats["instances_hidden"] > 10


@pytest.mark.parametrize(
    ("camera", "settings"),
    [
        ("perspective", {"samples": 3}),
        ("parallel", {"samples": 2}),
        ("parallel", {"supersampling": 2}),
        ("far", {"supersampling": 2}),
        ("far", {"lights_splats": True}),
        ("perspective", {"sum_format": "float16"}),
        ("perspective", {"ambient_occlusion": 1.0}),
    ],
    ids=str,
)
def test_no_setting_draws_another_picture(camera, settings, render, monkeypatch):
    made = {
        "perspective": perspective(),
        "parallel": Camera.orthographic(EYE, 3.0, SIZE, 0.1, 100),
        "far": perspective(near=1e-3, far=1e5),
    }[camera]
    one, every = pictures(crowd(), made, Settings(**settings, outputs=ALL), render, monkeypatch)
    assert one.stats["instances_hidden"] > 10 and are_equal(one, every)


@pytest.mark.parametrize("gap", [0.1, 0.4])
def test_what_is_seen_through_a_gap_is_drawn(gap, render, monkeypatch):
    one, every = pictures(crowd(gap=gap), perspective(), Settings(outputs=ALL), render, monkeypatch)
    assert are_equal(one, every) and 0 < one.stats["instances_hidden"]
    assert {int(i) for i in np.unique(every.object_index)} & set(range(22, 50))


@pytest.mark.parametrize("step", [0.2, 0.3])
def test_objects_that_touch_what_hides_them_are_drawn(step, render, monkeypatch):
    scene = crowd(rows=14, walls=(2 - 5 * step,), step=step)
    settings = Settings(outputs=ALL, detail_tolerance=0.0)
    one, every = pictures(scene, perspective(), settings, render, monkeypatch)
    assert are_equal(one, every) and one.stats["instances_hidden"]


def test_hidden_objects_cast_shadows_and_transparent_ones_hide_nothing(render, monkeypatch):
    scene = crowd()
    glass = replace(BALL, colors=BALL.colors * np.float32((1, 1, 1, 0.3)))
    front = tuple(replace(i, shape=glass) if i.matrix_world[1, 3] < 1.5 else i for i in scene.surfels)
    lit = replace(scene, surfels=front, lights=(replace(scene.lights[0], direction=(0.2, -1, -0.3)),))
    one, every = pictures(lit, perspective(), Settings(outputs=ALL), render, monkeypatch)
    assert one.stats["instances_hidden"] and are_equal(one, every)
    alone = render(replace(lit, polygons=()), perspective(), Settings(outputs=ALL))
    assert not are_equal(alone, every)


LIGHTS = {
    "sun": Light("sun", energy=3, direction=(0.1, 1, -0.2), casts_shadow=True),
    "sized sun": Light("sun", energy=3, direction=(0.1, 1, -0.2), size=0.1, casts_shadow=True),
    "point": Light("point", energy=900, position=(0.3, -2, 0.5), size=0.1, casts_shadow=True),
}


@pytest.mark.parametrize("kind", LIGHTS)
def test_casters_behind_others_are_not_drawn_into_shadow_maps(kind, render, monkeypatch):
    """Lit through a gap in a wall, and seen from behind it; the lights have maps side by side."""
    counts, draw_splats = [], visibility.draw_splats

    def counted(tile, p, target, splats, *more, **named):
        counts[-1] += len(splats) if p.kind == "shadow" else 0
        yield from draw_splats(tile, p, target, splats, *more, **named)

    monkeypatch.setattr(visibility, "draw_splats", counted)
    scene, found = replace(crowd(gap=0.2), lights=(LIGHTS[kind], LIGHTS["point"])), []
    back = perspective(matrix_world=look_at((1.5, 9, 3), (0, 2, 0)))
    for least in (1000, math.inf):
        monkeypatch.setattr(hidden_objects, "LEAST_SURFELS", least)
        counts.append(0)
        found.append(render(scene, back, Settings(outputs=ALL, shadow_resolution=256)))
    assert are_equal(*found) and np.ptp(found[0].color[..., 0]) > 0.1
    assert 20 < counts[0] < 0.8 * counts[1]


def test_a_panorama_and_a_lens_draw_the_same_picture(render, monkeypatch):
    view = Panorama(EYE, Equirectangular(), (96, 48))
    through = perspective(lens=Lens(0.05, 4.0))
    for camera in (view, through):
        monkeypatch.setattr(hidden_objects, "LEAST_SURFELS", 1000)
        one, every = pictures(crowd(), camera, Settings(outputs=ALL, samples=2), render, monkeypatch)
        assert are_equal(one, every)
    assert one.stats["instances_hidden"]


def test_tiles_draw_the_same_picture(render, monkeypatch):
    monkeypatch.setattr(import_module("splat_addon.rendering.plan.tiles"), "MAX_TARGET_EDGE", 48)
    one, every = pictures(crowd(), perspective(), Settings(outputs=ALL), render, monkeypatch)
    assert len(one.stats["plan"].tiles) > 1 and one.stats["instances_hidden"] and are_equal(one, every)


def test_nothing_is_looked_for_among_few_objects_or_surfels():
    few = replace(crowd(), surfels=crowd().surfels[: hidden_objects.LEAST_OBJECTS - 1])
    made = plan(few, perspective(), Settings())
    assert not made.has("HIDDEN_OBJECTS") and "hidden objects" in dict(made.skipped)
    assert "hidden_objects" not in [p.name for p in made.passes]
    assert plan(crowd(), perspective(), Settings()).has("HIDDEN_OBJECTS")
