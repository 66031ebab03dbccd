# SPDX-License-Identifier: GPL-3.0-or-later
"""With near and far planes from 1e-6 to 1e6 the depth buffer distinguishes splats wherever they are in between."""

from dataclasses import replace
from importlib import import_module

import numpy as np
import pytest

from splat_addon.reference import scenes
from splat_addon.reference.extremes import discs, sheet, speck
from splat_addon.reference.metrics import psnr
from splat_addon.rendering import Camera, Instance, Settings, look_at, plan
from splat_addon.rendering.view import build_view

NEARS = [1e-1, 1e-2, 1e-4, 1e-6]


def parallel(far=10.0, eye=(0.3, -3.6, 2.2), near=0.1):
    """A parallel camera."""
    matrix = look_at(eye, np.subtract(eye, (0.3, -3.6, 2.2)))
    return scenes.torus(6000, (64, 64))[0], Camera.orthographic(matrix, 3.2, (64, 64), near, far)


def with_disc_behind(scene, camera):
    """The scene with a disc just before the far plane."""
    matrix = camera.matrix_world.copy()
    matrix[:3, 3] += 0.5 * matrix[:3, 0] - 0.9 * camera.far * matrix[:3, 2]
    disc = Instance(discs((0, 0, 0), (0.1, 0, 0), (0, 0.1, 0), (1, 0, 0)), matrix)
    return replace(scene, surfels=(*scene.surfels, disc)), camera


WORLDS = {
    "torus": lambda: scenes.torus(6000, (64, 64)),
    "checker": lambda: scenes.checker_plane(count=6000, size=(64, 64)),
}


@pytest.fixture(params=WORLDS)
def world(request):
    return WORLDS[request.param]()


def with_speck(scene, camera, near):
    """The scene with a speck just behind the near plane, which keeps the clip range from being narrowed."""
    camera = replace(camera, near=near, far=1e6)
    return replace(scene, surfels=(*scene.surfels, speck(camera, 1.5 * near))), camera


@pytest.mark.parametrize("name", [*WORLDS, "parallel"])
def test_a_wide_clip_range_alone_costs_nothing(name, render_all):
    scene, camera = parallel() if name == "parallel" else WORLDS[name]()
    base, wide = render_all([(scene, camera, None), (scene, replace(camera, near=1e-6, far=1e6), None)])
    np.testing.assert_array_equal(wide.color, base.color)


@pytest.mark.parametrize("fov", [1e-3, 1e-5])
@pytest.mark.parametrize("depth", [0.3, 0.7, 1.0, 1.1, 3.7])
def test_a_wall_as_deep_as_its_distance_rounds_is_whole(depth, fov, hold, lit, camera):
    """A telescope sees the wall.

    The narrowed clip range must reach a little beyond it, or rounding would clip the wall.
    """
    half = 0.8 * depth * np.tan(np.radians(fov / 2))
    hold({f"{depth}": (lit(sheet(20, half, 0, depth)), camera(fov))})


def test_the_clip_range_ends_a_thousandth_beyond_what_is_there(lit, camera):
    seen = build_view(lit(discs([(0, 0, -0.7), (0, 0, -3.7)], (1e-5, 0, 0), (0, 1e-5, 0))).table, camera(far=1e6), 0.0)
    first, last = seen.first / seen.scale, seen.far / seen.scale
    assert 0.998 * 0.7 < first < 0.9995 * 0.7
    assert 1.0005 * 3.7 < last < 1.002 * 3.7


@pytest.mark.parametrize("distance", [1e-24, 1e24])
def test_a_few_surfels_far_from_the_others_do_not_set_the_scale(distance, hold):
    """The view's unit is the median depth.

    With a much larger or smaller unit, squares would leave the range of float32.
    """
    scene, camera = WORLDS["torus"]()
    camera = replace(camera, near=1e-26, far=1e26)
    hold({f"{distance:g}": (replace(scene, surfels=(*scene.surfels, speck(camera, distance))), camera)}, least=60)


@pytest.mark.parametrize("near", NEARS)
def test_something_at_the_near_plane_costs_nothing(near, world, hold):
    hold({"speck": with_speck(*world, near)}, least=60)


@pytest.mark.parametrize("distance", [10.0**k for k in range(-6, 7)])
def test_depth_is_known_to_a_millionth_at_any_distance(distance, render_all, lit, camera):
    """A disc fills the picture at the distance, with near at 1e-6 and far at 1e6 and a speck at both."""
    camera = camera(near=0.5e-6, far=2e6)
    wall = discs((0, 0, -distance), (distance, 0, 0), (0, distance, 0))
    (frame,) = render_all([(lit(wall, speck(camera, 0.6e-6), speck(camera, 1.9e6)), camera, None)])
    np.testing.assert_allclose(frame.depth[4:28, 4:12], distance, rtol=1e-6)


@pytest.mark.parametrize("is_half_behind", [False, True])
@pytest.mark.parametrize("far", [1e2, 1e4, 1e6])
def test_something_far_behind_costs_a_parallel_camera_nothing(far, is_half_behind, hold):
    """This holds even if the clip range reaches equally far behind the camera, as a viewport's does."""
    hold({"behind": with_disc_behind(*parallel(far, near=-far if is_half_behind else 0.1))}, least=60)


def test_a_parallel_camera_within_what_it_sees_reaches_to_a_thousand(hold):
    """Depths behind the camera are negative, so they cannot be stored relative to the farthest one.

    Their precision is 2^-24 of the whole range.
    """
    hold({"within": with_disc_behind(*parallel(1e3, (0, 0, 0), -1e3))}, least=60)


def test_hardware_depth_serves_where_it_is_fine_enough():
    assert not plan(*WORLDS["torus"](), Settings(supersampling=2)).linear_depth


@pytest.mark.parametrize(("nearest", "is_linear"), [(0.05, False), (0.02, True)])
def test_linear_depth_is_planned_where_the_hardwares_is_too_coarse(nearest, is_linear, lit, camera):
    """The splats are up to 3 away, and each is much smaller than its distance."""
    tiny = discs([(0, 0, -nearest), (0, 0, -3)], (1e-3, 0, 0), (0, 1e-3, 0))
    assert plan(lit(tiny), camera(near=1e-6), Settings(supersampling=2)).linear_depth == is_linear


def test_linear_depth_is_planned_where_a_splat_is_wide(lit, camera):
    """Moving each corner of a wide splat back along its own ray would deform the splat."""
    assert plan(lit(discs((0, 0, -3), (2, 0, 0), (0, 2, 0))), camera(), Settings(supersampling=2)).linear_depth


def test_both_depths_give_one_picture(render_all, monkeypatch):
    scene, camera = WORLDS["torus"]()
    (hardware,) = render_all([(scene, camera, None)])
    monkeypatch.setattr(import_module("splat_addon.rendering.passes.decisions"), "MAX_HARDWARE_DEPTH_RATIO", 0)
    (linear,) = render_all([(scene, camera, None)])
    assert psnr(linear.color, hardware.color) > 60
