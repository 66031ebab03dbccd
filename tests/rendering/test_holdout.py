# SPDX-License-Identifier: GPL-3.0-or-later
"""Holdouts cut holes as in closed forms and as in the exact picture."""

from dataclasses import replace

import numpy as np
import pytest

from splat_addon.reference import render_exact, scenes
from splat_addon.rendering import (
    EMPTY_DEPTH,
    Camera,
    Instance,
    PolygonInstance,
    Scene,
    Settings,
    look_at,
    make_polygons,
    plan,
)
from splat_addon.surfels import Surfels

CAMERA = Camera.perspective(look_at((0, 0, 4), (0, 0, 0), (0, 1, 0)), 0.5, (32, 32), 0.1, 50)
WORLD = (0.2, 0.4, 0.8)
METHODS = ["quad", "mip", "homogeneous"]


def sheet(z: float, color=(1, 1, 1, 1), left=-3.0, **options) -> Instance:
    """Overlapping discs over a rectangle across the view, from x = left to 3."""
    x, y = (a.ravel() for a in np.meshgrid(np.linspace(left, 3, 24), np.linspace(-3, 3, 24)))
    count, up = len(x), np.tile((0.0, 0, 1), (576, 1))
    places = np.stack([x, y, np.full(count, z)], axis=1)
    turns = np.tile((1.0, 0, 0, 0), (count, 1))
    surfels = Surfels(places, turns, np.full((count, 2), 0.4), up, np.tile(color, (count, 1)), np.zeros(count, int))
    return Instance(surfels, **options)


def flat(**choices) -> Settings:
    return Settings(shading="flat", **choices)


@pytest.mark.parametrize("film", [False, True])
@pytest.mark.parametrize("method", METHODS)
def test_a_hole_has_no_alpha_where_it_is_seen_first(method, film, render):
    """On the left there is a wall, on the right a hole in front of it; objects in front of the hole stay visible."""
    wall, hole = sheet(-1, (1, 0.5, 0.2, 1)), sheet(0, left=0.8, is_holdout=True)
    settings = flat(method=method, transparent_film=film)
    frame = render(Scene([wall, hole], world=WORLD), CAMERA, settings)
    np.testing.assert_allclose(frame.color[:, :16], np.broadcast_to((1, 0.5, 0.2, 1), (32, 16, 4)), atol=1e-5)
    assert (frame.color[:, 28:] == 0).all() and (frame.depth[:, 28:] == EMPTY_DEPTH).all()
    before = render(Scene([sheet(1, (0, 1, 0, 1)), hole, wall], world=WORLD), CAMERA, settings)
    np.testing.assert_allclose(before.color, np.broadcast_to((0, 1, 0, 1), (32, 32, 4)), atol=1e-5)


@pytest.mark.parametrize("method", METHODS)
def test_a_hole_seen_through_glass_leaves_the_glass(method, render):
    hole, glass = sheet(0, is_holdout=True), sheet(1, (1, 0, 0, 0.25))
    behind = sheet(-1, (0, 1, 0, 0.5))
    frame = render(Scene([behind, glass, hole], world=WORLD), CAMERA, flat(method=method))
    np.testing.assert_allclose(frame.color, np.broadcast_to((0.25, 0, 0, 0.25), (32, 32, 4)), atol=1e-5)


def test_a_hole_cuts_the_world_out_too(render):
    frame = render(Scene([sheet(0, is_holdout=True)], world=WORLD), CAMERA, flat())
    assert (frame.color == 0).all()


def test_the_picture_is_the_exact_one(render):
    scene, camera = scenes.torus(count=6000, size=(96, 96))
    outer, inner = scene.surfels
    for cut in ((replace(outer, is_holdout=True), inner), (outer, replace(inner, is_holdout=True))):
        settings = Settings(method="quad", supersampling=2)
        frame = render(replace(scene, surfels=cut), camera, settings)
        exact = render_exact(replace(scene, surfels=cut), camera, settings, samples=2)
        assert np.count_nonzero(np.abs(frame.color - exact.color).max(axis=2) > 1e-4) <= 4
        assert (exact.color[..., 3] < 1).any() and (exact.color[..., 3] == 1).any()


BOARD = make_polygons([(-3, -3, 0), (3, -3, 0), (3, 3, 0), (-3, 3, 0)], [(0, 1, 2), (0, 2, 3)])


@pytest.mark.parametrize("kind", ["surfels", "polygons", "surfels, linear depth"])
@pytest.mark.parametrize("method", ["mip", "ewa", "raycast"])
def test_no_silhouette_of_what_is_behind_a_hole_shows_through_it(method, kind, render):
    """The rim of a ball is seen at a flat angle, where a filter extends the plane as far forward as the hole."""
    (ball,) = scenes.sphere(count=4000)[0].surfels
    for ahead in (0.15, 0.3):
        camera = Camera.perspective(look_at((2.2, 0.3, 3.2), (0, 0, 0.3), (0, 1, 0)), 0.7, (128, 128), 0.1, 50)
        placed = np.diag((0.6, 0.6, 0.6, 1.0))  # its splats are moved back by 0.12
        placed[2, 3] = 1.0 + ahead
        hole = replace(sheet(0, is_holdout=True), matrix_world=placed)
        scene = Scene([ball, hole], world=WORLD)
        if kind == "polygons":
            scene = Scene([ball], polygons=[PolygonInstance(BOARD, placed, is_holdout=True)], world=WORLD)
        if "linear" in kind:
            away = np.diag((1e5, 1e5, 1e5, 1.0))
            away[2, 3] = -1e5
            camera = replace(camera, far=1e6)
            scene = replace(scene, surfels=(*scene.surfels, replace(sheet(0), matrix_world=away)))
        assert plan(scene, camera, flat(method=method)).linear_depth is ("linear" in kind)
        assert (render(scene, camera, flat(method=method)).color == 0).all()


def test_the_plan_names_what_cuts_and_what_cannot():
    scene = Scene([sheet(0, is_holdout=True), sheet(-1)])
    assert dict(plan(scene, CAMERA, flat()).features)["HOLDOUT"] == "1 of 2 instances cut holes"
    assert "HOLDOUT" not in dict(plan(Scene([sheet(0)]), CAMERA, flat()).features)
    made = plan(scene, CAMERA, flat(method="sprites_unfiltered"))
    assert "draws objects that cut holes as others" in dict(made.skipped)["holdout"]
