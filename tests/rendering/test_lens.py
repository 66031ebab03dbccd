# SPDX-License-Identifier: GPL-3.0-or-later
"""A point out of focus becomes the circle of confusion of a thin lens, as in the closed form."""

import math
from dataclasses import replace

import numpy as np
import pytest

from splat_addon.rendering import Camera, Scene, Settings
from splat_addon.rendering.scene.lens import Lens
from splat_addon.surfels import Surfels

SIZE = 48
FIELD = 1.0  # height of the picture at distance 1
FOCUS = 4.0
SHARP = Settings(method="quad", shading="flat", transparent_film=True)
MANY = replace(SHARP, samples=256)
RADIUS = 2.0  # of the disc, pixels


def disc(distance, x=0.0):
    """A disc of RADIUS pixels that faces the camera, `x` pixels from the middle of the picture."""
    pixel = FIELD / SIZE * distance
    return Surfels(
        positions=[(x * pixel, 0, -distance)],
        rotations=[(1, 0, 0, 0)],
        scales=[(RADIUS * pixel, RADIUS * pixel)],
        normals=[(0, 0, 1)],
        colors=[(1, 1, 1, 1)],
        materials=[0],
    )


def camera(**lens):
    made = Camera.perspective(np.eye(4), 2 * math.atan(FIELD / 2), (SIZE, SIZE))
    return replace(made, lens=Lens(focus_distance=FOCUS, **lens))


def moments(alpha):
    """Sum, centre (x, y) from the middle, and variance along x and y, in pixels."""
    y, x = np.indices(alpha.shape) + 0.5 - SIZE / 2
    total = alpha.sum()
    center = np.array([(alpha * x).sum(), (alpha * y).sum()]) / total
    return total, center, np.array([(alpha * x * x).sum(), (alpha * y * y).sum()]) / total - center**2


def confusion(radius, distance):
    """The radius in pixels of the circle of confusion: R |1/d - 1/f| on the plane at distance 1."""
    return radius * abs(1 / distance - 1 / FOCUS) * SIZE / FIELD


#: The variances of a disc of RADIUS and of a pixel, which add to that of the blur.
SHARP_VARIANCE = RADIUS**2 / 4 + 1 / 12


@pytest.mark.parametrize(("distance", "x"), [(2.0, 0.0), (3.0, 7.0), (60.0, -5.0)])
def test_the_circle_of_confusion_has_its_diameter(distance, x, render):
    """A disc has the variance radius^2 / 4 along each axis, and the variances of disc and blur add up."""
    total, center, variance = moments(render(Scene((disc(distance, x),)), camera(radius=0.6), MANY).color[..., 3])
    blur = confusion(0.6, distance)
    assert total == pytest.approx(math.pi * RADIUS**2, rel=0.03)
    np.testing.assert_allclose(center, (x, 0), atol=0.1)
    np.testing.assert_allclose(variance, blur**2 / 4 + SHARP_VARIANCE, rtol=0.03)


def test_what_is_in_focus_stays_sharp(render):
    seen = [render(Scene((disc(FOCUS),)), made, MANY).color for made in (camera(radius=0.6), pinhole())]
    assert np.abs(seen[0] - seen[1]).max() < 0.03


def pinhole():
    return replace(camera(radius=1.0), lens=None)


@pytest.mark.parametrize(("blades", "rotation"), [(3, 0.4), (6, 1.0)])
def test_an_opening_with_corners_has_its_moments(blades, rotation, render):
    """A regular polygon has, along any axis, the variance (2 + cos(2 pi / n)) / 12 times its circumradius squared."""
    made = camera(radius=0.6, blades=blades, rotation=rotation)
    _, center, variance = moments(render(Scene((disc(2.0),)), made, MANY).color[..., 3])
    share = (2 + math.cos(2 * math.pi / blades)) / 12
    np.testing.assert_allclose(center, 0, atol=0.15)
    np.testing.assert_allclose(variance, share * confusion(0.6, 2.0) ** 2 + SHARP_VARIANCE, rtol=0.05)


def test_a_narrow_opening_blurs_less_across(render):
    _, _, variance = moments(render(Scene((disc(2.0),)), camera(radius=0.6, ratio=2.0), MANY).color[..., 3])
    blur = confusion(0.6, 2.0)
    np.testing.assert_allclose(variance, np.array([blur / 2, blur]) ** 2 / 4 + SHARP_VARIANCE, rtol=0.03)


def test_one_sample_is_a_pinholes(render):
    scene = Scene((disc(2.0),))
    np.testing.assert_array_equal(*(render(scene, made, SHARP).color for made in (camera(radius=0.6), pinhole())))


@pytest.mark.parametrize("corners", [0, 3, 5, 8])
def test_places_stay_on_the_opening(corners):
    places = Lens(2.0, FOCUS, corners, 0.3).points(np.random.default_rng(0).uniform(size=(10_000, 2)))
    assert 1.9 < np.hypot(*places.T).max() <= 2 + 1e-12
    np.testing.assert_allclose(places.mean(axis=0), 0, atol=0.05)


@pytest.mark.parametrize(
    ("values", "what"),
    [
        ({"radius": 0.0}, "radius above 0"),
        ({"focus_distance": 0.0}, "cannot focus at the distance 0"),
        ({"focus_distance": math.nan}, "cannot focus"),
        ({"ratio": 0.0}, "ratio above 0"),
    ],
)
def test_an_impossible_lens_is_refused(values, what):
    with pytest.raises(ValueError, match=what):
        Lens(**({"radius": 1.0, "focus_distance": 1.0} | values))


def test_a_parallel_camera_has_no_lens():
    with pytest.raises(ValueError, match="perspective"):
        replace(Camera.orthographic(np.eye(4), 2.0, (4, 4)), lens=Lens(1.0, 1.0))
