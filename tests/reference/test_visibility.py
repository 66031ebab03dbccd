# SPDX-License-Identifier: GPL-3.0-or-later
"""A ray sees the nearest splat, and those behind it within its epsilon."""

import numpy as np
import pytest

from splat_addon.reference import render_exact
from splat_addon.rendering.scene import Scene
from splat_addon.rendering.scene.camera import Camera, look_at
from splat_addon.rendering.settings import Settings

RED, GREEN = (1, 0, 0), (0, 1, 0)


def sheets(ellipses, gap, radius=1.0):
    """A red disc at depth 4, and a green one of the same size `gap` behind it."""
    return Scene([ellipses([(0, 0, -4), (0, 0, -4 - gap)], (radius, 0, 0), (0, radius, 0), [RED, GREEN])])


def test_sheets_closer_than_epsilon_mix_evenly(ellipses, orthographic):
    frame = render_exact(sheets(ellipses, 0.49), orthographic(), Settings(shading="flat"))
    np.testing.assert_allclose(frame.color[16, 16, :3], (0.5, 0.5, 0), atol=1e-6)


def test_sheets_farther_apart_than_epsilon_hide_each_other(ellipses, orthographic):
    frame = render_exact(sheets(ellipses, 0.51), orthographic(), Settings(shading="flat"))
    np.testing.assert_array_equal(frame.color[16, 16, :3], RED)


def test_epsilon_zero_shows_the_nearest_sheet_alone(ellipses, perspective):
    frame = render_exact(sheets(ellipses, 1e-5), perspective(), Settings(shading="flat", epsilon=0))
    np.testing.assert_array_equal(frame.color[16, 16, :3], RED)


def test_epsilon_is_measured_along_the_ray(ellipses, perspective):
    camera = perspective((33, 33))
    frame = render_exact(sheets(ellipses, 2.4, radius=5), camera, Settings(shading="flat"), samples=1)
    x, y = np.meshgrid(*[(np.arange(33) + 0.5) / 16.5 - 1] * 2)
    reaches_green = 2.5 / np.sqrt(1 + x * x + y * y) >= 2.4
    np.testing.assert_array_equal(frame.color[..., 1] > 0, reaches_green)
    assert 0 < reaches_green.mean() < 1


def test_epsilon_is_half_the_longer_axis_of_the_nearer_splat(ellipses, orthographic):
    surfels = ellipses([(0, 0, -4), (0, 0, -4.9)], [(2, 0, 0), (0.1, 0, 0)], (0, 0.1, 0), [RED, GREEN])
    frame = render_exact(Scene([surfels]), orthographic((33, 33)), Settings(shading="flat"), samples=1)
    np.testing.assert_allclose(frame.color[16, 16, :3], (0.5, 0.5, 0), atol=1e-6)


def test_a_colour_is_the_kernel_weighted_mean(ellipses, orthographic):
    surfels = ellipses([(0, 0, -4), (0.5, 0, -4)], (1, 0, 0), (0, 1, 0), [RED, GREEN])
    frame = render_exact(Scene([surfels]), orthographic((33, 33)), Settings(shading="flat"), samples=1)
    weights = np.exp(-2 * np.array([0, 0.25]))
    np.testing.assert_allclose(frame.color[16, 16, :2], weights / weights.sum(), rtol=1e-6)


@pytest.mark.parametrize("turn", [1, -1])
@pytest.mark.parametrize("side", [1, -1])
@pytest.mark.parametrize("kind", ["perspective", "orthographic"])
def test_normals_face_the_viewer_whichever_side_is_seen(ellipses, request, kind, side, turn):
    tilt = np.array((0.6, 0.0, 0.8)) * turn
    surfels = ellipses((0, 0, -4), v=(0, side, 0), normals=tilt)
    frame = render_exact(Scene([surfels]), request.getfixturevalue(kind)())
    np.testing.assert_allclose(frame.normal[16, 16], (0.6, 0, 0.8), atol=1e-6)


def test_normals_are_in_world_space(ellipses):
    camera = Camera.perspective(look_at((3, -1, 2), (0, 0, 0)), 1.0, (9, 9))
    frame = render_exact(Scene([ellipses((0, 0, 0), normals=(0.6, 0.0, 0.8))]), camera)
    np.testing.assert_allclose(frame.normal[4, 4], (0.6, 0, 0.8), atol=1e-6)


def test_a_shading_normal_may_lean_away_from_the_viewer(ellipses, perspective):
    """The splat's plane decides which side is seen, so a shading normal that leans past the horizon is not reversed."""
    steep = np.radians(80)
    u, v = (1, 0, 0), (0, np.cos(steep), -np.sin(steep))
    bent = (0, np.sin(np.radians(100)), np.cos(np.radians(100)))
    frame = render_exact(Scene([ellipses((0, 0, -4), u, v, normals=bent)]), perspective((33, 33)), samples=1)
    np.testing.assert_allclose(frame.normal[16, 16], bent, atol=1e-6)


def test_a_front_hides_the_back_of_a_splat_in_its_place(ellipses, orthographic):
    """At a silhouette, splats of the back stick out by their radius; front splats that overlap them must win."""
    surfels = ellipses([(0, 0, -4), (0, 0, -4.2)], (1, 0, 0), [(0, -1, 0), (0, 1, 0)], [RED, GREEN])
    frame = render_exact(Scene([surfels]), orthographic((33, 33)), Settings(shading="flat"), samples=1)
    np.testing.assert_allclose(frame.color[16, 16, :3], GREEN, atol=2e-3)


def test_a_back_alone_is_drawn_as_any_splat(ellipses, orthographic):
    back, front = ((ellipses((0, 0, -4), (1, 0, 0), (0, y, 0), RED)) for y in (-1, 1))
    frames = [render_exact(Scene([s]), orthographic((33, 33)), Settings(shading="flat")) for s in (back, front)]
    np.testing.assert_allclose(frames[0].color, frames[1].color, atol=1e-6)


@pytest.mark.parametrize("degrees", [91, 105, 112])
def test_a_back_is_turned_to_the_viewer_however_flat_it_is_seen(ellipses, orthographic, degrees):
    """An open sheet has two sides, and even at a flat angle its back must not pass for the rim of a front."""
    outward = np.array((0, np.sin(np.radians(degrees)), np.cos(np.radians(degrees))))
    surfels = ellipses((0, 0, -4), (1, 0, 0), np.cross(outward, (1, 0, 0)))
    normal = render_exact(Scene([surfels]), orthographic((33, 33)), samples=1).normal[16, 16]
    np.testing.assert_allclose(normal, -outward, atol=1e-6)
