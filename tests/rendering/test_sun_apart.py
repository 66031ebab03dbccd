# SPDX-License-Identifier: GPL-3.0-or-later
"""The sun of a world's picture becomes a light of the same direction, irradiance and size, and lights only once."""

import math
from dataclasses import replace

import numpy as np
import pytest

from splat_addon.reference import render_exact
from splat_addon.reference.extremes import discs
from splat_addon.rendering import Camera, Environment, Renderer, Scene, Settings, plan
from splat_addon.rendering.scene import Instance
from splat_addon.rendering.scene import environment as module
from splat_addon.rendering.scene.environment import level_directions
from splat_addon.rendering.scene.equirectangular import equirectangular_directions
from splat_addon.rendering.scene.material import Material
from splat_addon.rendering.scene.picture_sun import excess_of
from splat_addon.rendering.scene.sun_apart import sun_apart

ROWS = 512
SKY, SUN = np.array((0.3, 0.5, 1.0)), np.array((1e4, 9e3, 7e3))


def direction(elevation, azimuth):
    up, turn = np.radians((elevation, azimuth))
    return np.array((np.cos(up) * np.cos(turn), np.cos(up) * np.sin(turn), np.sin(up)))


def sky_with_disc(toward, across, radiance=SUN, rows=ROWS):
    """A picture whose sky is brighter above, with an even disc, each of whose pixels has the share that it covers."""
    directions, _ = equirectangular_directions((rows, 2 * rows))
    pixels = SKY * (1 + 0.5 * directions[:, 2:])
    near = np.flatnonzero(directions @ toward > np.cos(across / 2 + 4 * np.pi / rows))
    row, column = (part[:, None, None] for part in np.divmod(near, 2 * rows))
    share = (np.arange(16) + 0.5) / 16
    latitude = ((row + share[:, None]) / rows - 0.5) * np.pi
    longitude = (0.5 - (column + share) / (2 * rows)) * 2 * np.pi
    inside = np.cos(latitude) * (np.cos(longitude) * toward[0] + np.sin(longitude) * toward[1])
    covered = (inside + np.sin(latitude) * toward[2] > np.cos(across / 2)).mean(axis=(1, 2))
    pixels[near] += covered[:, None] * radiance
    return Environment(pixels.reshape(rows, 2 * rows, 3))


@pytest.mark.parametrize("place", [(40, 30), (88, 10), (3, 179.9), (-60, -100)])
def test_a_disc_is_a_sun_of_its_direction_irradiance_and_angle(place):
    """An even disc of radiance L and half-angle a gives a surface that faces it pi L sin^2 a.

    Pixels and their interpolation blur its rim by half a pixel (standard deviation), so that the sum of squares lacks a
    ring of 0.28 pixels (0.5 / sqrt(pi)), and the disc seems wider by twice that.
    """
    toward, across, pixel = direction(*place), math.radians(2), math.pi / ROWS
    sun = sky_with_disc(toward, across).sun_above(10)
    assert math.degrees(math.acos(min(sun.toward @ toward, 1))) < 0.02
    np.testing.assert_allclose(sun.irradiance, SUN * np.pi * math.sin(across / 2) ** 2, rtol=0.005)
    assert sun.angle == pytest.approx(across + 0.56 * pixel, abs=0.35 * pixel)


def test_half_a_degree_in_a_coarse_picture_keeps_its_irradiance():
    across = math.radians(0.5)  # 1.4 pixels
    sun = sky_with_disc(direction(35, 20), across).sun_above(10)
    np.testing.assert_allclose(sun.irradiance, SUN * np.pi * math.sin(across / 2) ** 2, rtol=0.03)
    assert across < sun.angle < 1.8 * across


def test_sun_and_rest_light_as_the_picture_did(monkeypatch):
    """A matt surface has the irradiance of the whole picture, and the rest of it is the clipped picture's."""
    monkeypatch.setattr(module, "BLURRED_ROWS", 32)
    environment = sky_with_disc(direction(50, -70), math.radians(4), SUN / 10, rows=64)
    sun, normals = environment.sun_above(10), level_directions()
    whole, rest = (environment.level_texels(each) for each in (None, sun))
    excess, clipped = excess_of(environment.pixels, sun.middle, 10), environment.pixels.copy()
    clipped[excess.rows[:, None], excess.columns] -= excess.radiance.astype(np.float32)
    assert clipped.max() == pytest.approx(10) and environment.pixels.max() > 100
    np.testing.assert_allclose(rest, Environment(clipped).level_texels(), atol=1e-5)
    matt, without = (texels.reshape(6, 34, 34, 4)[-1, ..., :3] for texels in (whole, rest))
    lit = np.maximum(normals @ sun.toward, 0)[..., None] * sun.irradiance / np.pi
    # levels come from pixels of 5.6 degrees, some of which are farther round the rim of a surface's hemisphere
    np.testing.assert_allclose(without + lit, matt, atol=0.03 * matt.max())
    assert (matt - without).max() > 0.4 * matt.max()


@pytest.mark.parametrize(
    ("across", "radiance", "limit"),
    [(2, SUN, 2e4), (25, SUN, 10), (0.5, SUN / 1000, 5)],
    ids=["nothing is as bright", "a wide lamp", "a lamp that hardly lights"],
)
def test_what_is_no_sun_stays_in_the_picture(across, radiance, limit):
    assert sky_with_disc(direction(30, 0), math.radians(across), radiance).sun_above(limit) is None


@pytest.mark.parametrize("shape", [(1, 1), (8, 1), (1, 2), (32, 64)])
def test_an_even_picture_has_no_sun(shape):
    assert Environment(np.full((*shape, 3), 50, np.float32)).sun_above(10) is None


def test_the_light_shines_from_the_turned_picture_with_the_world_s_strength():
    turn = np.array(((0.0, 1, 0), (-1, 0, 0), (0, 0, 1)))  # from the world's directions to the picture's
    toward, across = direction(40, 30), math.radians(1)
    environment = replace(sky_with_disc(toward, across), rotation=turn)
    scene = Scene(world=(3, 3, 3), environment=environment)
    [light] = sun_apart(scene, 10).lights
    np.testing.assert_allclose(np.dot(turn, light.direction), -toward, atol=1e-3)
    np.testing.assert_allclose(
        light.energy * np.array(light.color), 3 * SUN * np.pi * math.sin(across / 2) ** 2, rtol=0.005
    )
    assert light.casts_shadow and light.receivers is None
    assert sun_apart(scene, 10).picture_sun is sun_apart(scene, 10).picture_sun  # so that devices keep its levels
    for same in (sun_apart(scene, 0), sun_apart(scene, 1e6), sun_apart(replace(scene, world=(0, 0, 0)), 10)):
        assert not same.lights and same.picture_sun is None


CAMERA = Camera.perspective(np.eye(4), 1.0, (32, 32), near=0.1, far=100)


def blocked(environment):
    """A matt wall that faces the camera, and a small disc before it that the camera sees beside its shadow."""
    white = np.ones((1, 3))
    wall = discs((0, 0, -6), (5, 0, 0), (0, 5, 0), white)
    small = discs((0.9, 0.4, -4.5), (0.3, 0, 0), (0, 0.3, 0), white)
    matt = (Material(ior=1.0),)
    return Scene(
        (Instance(wall, materials=matt), Instance(small, materials=matt)), world=(1, 1, 1), environment=environment
    )


def test_its_shadow_takes_exactly_the_sun_away(on_device):
    toward, across = np.array((0.6, 0.3, 1)) / np.linalg.norm((0.6, 0.3, 1)), math.radians(0.5)
    scene = blocked(sky_with_disc(toward, across, rows=256))
    apart = sun_apart(scene, 10)
    settings = Settings(method="quad", shading="principled", supersampling=1)
    before, frame = on_device(
        lambda device: [Renderer(device).render(s, CAMERA, settings).color for s in (scene, apart)]
    )
    truth = render_exact(apart, CAMERA, settings).color
    # the middle of the shadow on the wall: from the disc 1.5 away from the light
    at = np.array((0.9, 0.4)) - 1.5 * toward[:2] / toward[2]
    column, row = (int((v / (6 * math.tan(0.5)) + 1) * 16) for v in at)
    sky = SKY * (1 + 0.5 * 2 / 3)  # the wall faces the zenith
    sun = SUN * np.pi * math.sin(across / 2) ** 2 * toward[2] / np.pi
    np.testing.assert_allclose(frame[row, column, :3], sky, rtol=0.01)
    np.testing.assert_allclose(frame[4, 16, :3], sky + sun, rtol=0.02)
    np.testing.assert_allclose(before[row, column, :3], before[4, 16, :3], rtol=0.02)
    np.testing.assert_allclose(before[4, 16, :3], frame[4, 16, :3], rtol=0.03)
    assert np.abs(frame - truth).mean() < 1e-3


def test_the_background_keeps_it(on_device):
    toward = np.array((0.1, 0.2, -1)) / np.linalg.norm((0.1, 0.2, -1))
    environment = sky_with_disc(toward, math.radians(4), SUN / 50, rows=64)
    scene = Scene((discs((2, -2, -8), (1, 0, 0), (0, 1, 0)),), world=(1, 1, 1), environment=environment)
    assert sun_apart(scene, 10).lights
    settings = Settings(method="quad", supersampling=1)
    drawn = on_device(
        lambda device: [Renderer(device).render(s, CAMERA, settings) for s in (scene, sun_apart(scene, 10))]
    )
    before, frame = (np.where(f.coverage[..., None] == 0, f.color, 0) for f in drawn)
    assert before.max() > 100
    np.testing.assert_array_equal(frame, before)


def test_a_mirror_shows_it_once(on_device):
    """A polished metal that fills the picture mirrors the sun, by the light alone: without it the picture is clipped,
    as in the reference."""
    toward = np.array((0.15, 0.1, 1)) / np.linalg.norm((0.15, 0.1, 1))
    environment = sky_with_disc(toward, math.radians(4), SUN / 50, rows=64)
    mirror = Instance(discs((0, 0, -3), (9, 0, 0), (0, 9, 0)), materials=(Material(roughness=0.05, metallic=1.0),))
    scene = Scene((mirror,), world=(1, 1, 1), environment=environment)
    apart = sun_apart(scene, 10)
    settings = Settings(method="quad", shading="principled", supersampling=1)
    three = (scene, apart, replace(apart, lights=()))
    before, frame, unlit = on_device(lambda d: [Renderer(d).render(s, CAMERA, settings).color for s in three])
    assert before.max() > 50 and frame[..., :3].max() > 50 and 1 < unlit[..., :3].max() < 10
    truth = render_exact(replace(apart, lights=()), CAMERA, settings).color
    # the truth is a mean over each pixel, which differs round the sun
    assert np.abs(unlit - truth).mean() < 0.01 and np.median(np.abs(unlit - truth)) < 1e-4


def test_shaders_that_clip_the_picture_are_only_those_that_are_lit_by_one_with_a_sun():
    scene = blocked(sky_with_disc(direction(60, 0), math.radians(1), rows=64))
    for each, expected in ((scene, False), (sun_apart(scene, 10), True)):
        made = plan(each, CAMERA, Settings(shading="principled"))
        chosen = {choice for p in made.passes for part in p.parts for choice in part.choices}
        assert (("lighting_picture", "without_sun") in chosen) is expected
