# SPDX-License-Identifier: GPL-3.0-or-later
"""Eye-dome lighting darkens a step in depth as its closed form says, and planes keep their colour."""

import math
from dataclasses import replace
from importlib import import_module

import numpy as np
import pytest

from splat_addon.reference import scenes
from splat_addon.reference.eye_dome import darkening
from splat_addon.rendering import (
    Camera,
    Equirectangular,
    EyeDome,
    Instance,
    Panorama,
    PolygonInstance,
    Scene,
    Settings,
    look_at,
    make_polygons,
    plan,
)
from splat_addon.rendering.assembly.panorama_faces import DENSITY
from splat_addon.rendering.plan.programs import describe
from splat_addon.surfels import Surfels

DOME = EyeDome(strength=0.5, radius=1.0)
SETTINGS = Settings(method="quad", shading="flat", eye_dome=DOME)
SIZE = (24, 16)
#: Distances of the camera from the lower and the upper floor.
FAR, NEAR = 5.0, 4.8


def squares(*corners):
    """A scene of rectangles, each (left, right, z) from y = -90 to 90."""
    points = [(x, y, z) for left, right, z in corners for x, y in ((left, -90), (right, -90), (right, 90), (left, 90))]
    faces = [(k, k + a, k + a + 1) for k in range(0, len(points), 4) for a in (1, 2)]
    return Scene(polygons=[PolygonInstance(make_polygons(points, faces))])


def above(is_parallel, eye=(0, 0, FAR), target=(0, 1e-6, 0), size=SIZE):
    matrix = look_at(eye, target, up=(0, 1, 0))
    if is_parallel:
        return Camera.orthographic(matrix, 2.0, size)
    return Camera.perspective(matrix, 2 * math.atan(0.2), size)


def darkened(scene, camera, settings, render):
    """(h, w) the factor of the colour, nan where nothing is seen, and the frame without it."""
    frames = [render(scene, camera, one) for one in (settings, replace(settings, eye_dome=None))]
    with np.errstate(invalid="ignore", divide="ignore"):
        return frames[0].color[..., 1] / frames[1].color[..., 1], frames[1]


@pytest.mark.parametrize("is_parallel", [True, False])
def test_a_step_is_as_dark_as_three_of_eight_neighbours_make_it(is_parallel, render):
    """Beside the edge, one neighbour along the axis and two along the diagonals are higher by the step."""
    factor, frame = darkened(squares((-9, 9, 0), (-9, 0.01, FAR - NEAR)), above(is_parallel), SETTINGS, render)
    pixel = 2.0 / SIZE[1]
    height = FAR - NEAR if is_parallel else (FAR / NEAR - 1) * FAR
    rise = height / pixel * (1 + 2 / math.sqrt(2)) / 8
    edge = np.flatnonzero(np.diff(frame.depth[8]) > 0.1).item() + 1
    assert factor[8, edge] == pytest.approx(math.exp(-DOME.gain * rise), rel=1e-4)
    np.testing.assert_allclose(np.delete(factor, edge, axis=1), 1, rtol=1e-5)


@pytest.mark.parametrize("radius", [1.0, 6.0])
@pytest.mark.parametrize("is_parallel", [True, False])
def test_an_oblique_plane_is_not_darkened(is_parallel, radius, render):
    """It is seen at 3 to 25 degrees."""
    camera = above(is_parallel, (0, -20, 5), (0, 0, 0))
    factor, frame = darkened(squares((-90, 90, 0)), camera, replace(SETTINGS, eye_dome=EyeDome(9, radius)), render)
    assert np.ptp(frame.depth) > 3
    np.testing.assert_allclose(factor, 1, rtol=2e-3)


def test_splats_and_polygons_are_darkened_as_the_twin_says(render):
    scene, camera = scenes.torus(count=4000, size=(48, 32))
    floor = make_polygons([(-4, -4, -1), (4, -4, -1), (4, 4, -1), (-4, 4, -1)], [(0, 1, 2), (0, 2, 3)])
    scene = replace(scene, polygons=(PolygonInstance(floor),))
    for dome in (EyeDome(), EyeDome(0.2, 4.0)):
        factor, frame = darkened(scene, camera, replace(SETTINGS, eye_dome=dome), render)
        expected = darkening(frame.depth.astype(np.float64), camera, dome)
        inside = np.isfinite(factor)
        edge = math.ceil(dome.radius)  # the picture ends there for the twin, and not for the renderer
        inside[[*range(edge), *range(-edge, 0)]] = inside[:, [*range(edge), *range(-edge, 0)]] = False
        assert (expected[inside] < 0.8).mean() > 0.02
        np.testing.assert_allclose(factor[inside], expected[inside], atol=2e-4)


def test_a_picture_in_tiles_has_no_seam(render, monkeypatch):
    scene, camera = scenes.torus(count=1000, size=(40, 12))
    settings = replace(SETTINGS, eye_dome=EyeDome(1.0, 3.0))
    whole = render(scene, camera, settings).color
    monkeypatch.setattr(import_module("splat_addon.rendering.plan.tiles"), "MAX_TARGET_EDGE", 16)
    made = plan(scene, camera, settings)
    assert len(made.tiles) == 3 and made.margin == 3
    np.testing.assert_allclose(render(scene, camera, settings).color, whole, atol=1e-5)


def test_a_panorama_has_no_seam_where_faces_meet(render):
    """Its radius is in pixels of the panorama; a room's walls are planes in every face."""
    points = [(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]
    walls = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    room = make_polygons(points, [(a, b, c) for w in walls for a, b, c in ((w[0], w[1], w[2]), (w[0], w[2], w[3]))])
    turned = look_at((0, 0, 0), (1, 0.4, 0.2))  # so that faces of the panorama meet in the middle of walls
    panorama = Panorama(turned, Equirectangular(), (64, 32))
    scene = Scene(polygons=[PolygonInstance(room)])
    factor, _ = darkened(scene, panorama, replace(SETTINGS, eye_dome=EyeDome(1.0, 1.0)), render)
    directions = panorama.directions(slice(None)) @ turned[:3, :3].T
    two = np.sort(np.abs(directions), axis=-1)[..., 1:]
    is_wall = two[..., 0] < 0.8 * two[..., 1]
    np.testing.assert_allclose(factor[is_wall], 1, rtol=5e-3)
    assert factor[~is_wall].min() < 0.9 and DENSITY > 1


def test_the_radius_is_in_pixels_with_any_number_of_samples(render):
    settings = replace(SETTINGS, supersampling=3, eye_dome=EyeDome(9.0, 2.0))
    factor, frame = darkened(squares((-9, 9, 0), (-9, 0.01, FAR - NEAR)), above(True), settings, render)
    is_dark = factor[8] < 0.9
    assert np.count_nonzero(is_dark) in (2, 3) and np.flatnonzero(is_dark)[0] >= np.argmax(frame.depth[8] > 4.9)


UP = np.tile((0.0, 0, 1), (2, 1))
DISCS = Surfels(UP * 0.1, np.tile((1.0, 0, 0, 0), (2, 1)), np.full((2, 2), 0.5), UP, np.ones((2, 4)), [0, 0])
CLEAR = replace(DISCS, colors=np.full((2, 4), 0.5))


@pytest.mark.parametrize(
    ("surfels", "options", "why"),
    [
        (DISCS, {"eye_dome": None}, "none is asked for"),
        (DISCS, {"shading": "overdraw"}, "overdraw shading shows how the picture is made"),
        (CLEAR, {}, "transparent layers have none"),
    ],
)
def test_where_it_is_not_nothing_is_there_and_the_plan_says_why(surfels, options, why):
    scene, settings = Scene([Instance(surfels)]), replace(SETTINGS, **options)
    made, usual = (plan(scene, above(True), one) for one in (settings, replace(settings, eye_dome=None)))
    assert why in dict(made.skipped)["eye-dome lighting"]
    assert [str(p.parts) for p in made.passes] == [str(p.parts) for p in usual.passes]
    assert made.margin == usual.margin and "sample_depths" not in made.textures
    texts = [describe(made, p).fragment for p in made.passes if p.host == "shading.frag"]
    assert not any("dome" in text for text in texts)


@pytest.mark.parametrize("fields", [{"strength": 0.0}, {"strength": math.nan}, {"radius": 0.5}, {"radius": math.inf}])
def test_what_is_no_strength_or_radius_is_refused(fields):
    with pytest.raises(ValueError, match=f"{next(iter(fields))} of eye-dome lighting must be"):
        EyeDome(**fields)
