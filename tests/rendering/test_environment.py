# SPDX-License-Identifier: GPL-3.0-or-later
"""The blurred levels of a world image agree with the integrals that they stand for."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from splat_addon.reference import render_exact
from splat_addon.reference.extremes import discs
from splat_addon.rendering import Camera, Environment, Renderer, Scene, Settings, plan
from splat_addon.rendering.scene.environment import LEVEL_SIDE, LEVELS, level_directions
from splat_addon.rendering.scene.equirectangular import equirectangular_directions

CAMERA = Camera.perspective(np.eye(4), 1.0, (16, 16), near=0.1, far=100)


def levels(pixels):
    texels = Environment(pixels).level_texels()
    return texels.reshape(-1, LEVEL_SIDE + 2, LEVEL_SIDE + 2, 4)[..., :3]


def test_an_even_picture_stays_even():
    np.testing.assert_allclose(levels(np.full((32, 64, 3), 0.7, np.float32)), 0.7, rtol=1e-5)


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("shape", [(1, 1), (8, 1), (1, 2), (2, 64)])
def test_so_does_a_picture_of_few_pixels(shape):
    np.testing.assert_allclose(levels(np.full((*shape, 3), 0.7, np.float32)), 0.7, rtol=1e-5)


def test_solid_angles_add_up_to_the_sphere():
    directions, share = equirectangular_directions((31, 50))
    assert share.sum() == pytest.approx(4 * np.pi)
    np.testing.assert_allclose(np.linalg.norm(directions, axis=1), 1)


def test_a_linear_sky_gives_a_matt_surface_two_thirds_of_its_slope():
    """The cosine-weighted mean of the radiance 1 + d.z is 1 + 2/3 n.z (the first order of spherical harmonics)."""
    directions, _ = equirectangular_directions((64, 128))
    sky = np.repeat(1 + directions[:, 2:], 3, axis=1).reshape(64, 128, 3)
    expected = 1 + 2 / 3 * level_directions()[..., 2]
    np.testing.assert_allclose(levels(sky)[-1][..., 0], expected, atol=2e-3)


def lamp():
    """A small bright patch."""
    pixels = np.zeros((64, 128, 3), np.float32)
    pixels[40:44, 30:34] = 100
    return pixels


@cache
def lamp_levels():
    return levels(lamp())


@pytest.mark.parametrize("level", range(len(LEVELS)))
def test_rougher_levels_spread_a_lamp_and_keep_its_light(level):
    pixels = lamp()
    directions, share = equirectangular_directions((64, 128))
    mean = (pixels.reshape(-1, 3) * share[:, None]).sum(axis=0)[0] / (4 * np.pi)
    every = lamp_levels()
    made = every[level]
    toward = level_directions()[1:-1, 1:-1].reshape(-1, 3)
    cosines = directions @ toward.T
    own = made[1:-1, 1:-1].reshape(-1, 3)[cosines.argmax(axis=1), 0]
    assert (own * share).sum() / (4 * np.pi) == pytest.approx(mean, rel=0.15)
    assert level == 0 or made.max() < every[level - 1].max()


def test_a_picture_without_surfels_is_the_world(on_device):
    directions, _ = equirectangular_directions((64, 128))
    environment = Environment((directions * 0.5 + 0.5).reshape(64, 128, 3))
    scene = Scene(world=(1, 1, 1), environment=environment)
    frame = on_device(lambda device: Renderer(device).render(scene, CAMERA, Settings(method="quad", supersampling=1)))
    tick = (np.arange(16) + 0.5) / 8 - 1
    x, y = np.meshgrid(tick * np.tan(0.5), tick * np.tan(0.5))
    seen = np.stack([x, y, -np.ones_like(x)], axis=2)
    seen /= np.linalg.norm(seen, axis=2, keepdims=True)
    np.testing.assert_allclose(frame.color[..., :3], seen * 0.5 + 0.5, atol=2e-3)
    assert (frame.coverage == 0).all() and (frame.depth == 1e10).all()


@pytest.mark.parametrize("hides", [False, True])
def test_a_background_of_its_own_is_seen_and_does_not_light(on_device, hides):
    sky = Environment(np.full((4, 8, 3), 0.5))
    disc = discs((0, 0, -3), (0.8, 0, 0), (0, 0.8, 0))
    lit = Scene([disc], world=(1, 1, 1), environment=sky)
    seen = replace(lit, background=(0.2, 0.4, 0.6), hides_environment=hides)
    settings = Settings(method="quad", shading="phong", supersampling=1)
    plain, frame = on_device(lambda device: [Renderer(device).render(s, CAMERA, settings).color for s in (lit, seen)])
    np.testing.assert_allclose(frame[0, 0, :3], np.multiply((0.2, 0.4, 0.6), 1 if hides else 0.5), atol=1e-4)
    np.testing.assert_array_equal(frame[8, 8], plain[8, 8])
    truth = render_exact(seen, CAMERA, settings).color
    np.testing.assert_allclose(frame[0, 0], truth[0, 0], atol=1e-4)


def test_only_a_picture_that_is_seen_or_lights_is_planned():
    environment = Environment(np.ones((4, 8, 3)))
    empty = plan(Scene(environment=environment), CAMERA, Settings(transparent_film=True))
    assert not empty.passes
    assert [p.name for p in plan(Scene(environment=environment), CAMERA, Settings()).passes] == ["background"]


@pytest.mark.parametrize(("pixels", "said"), [(np.ones((4, 8)), "shape"), (np.full((4, 8, 3), np.nan), "not finite")])
def test_bad_pictures_are_refused(pixels, said):
    with pytest.raises(ValueError, match=said):
        Environment(pixels)
