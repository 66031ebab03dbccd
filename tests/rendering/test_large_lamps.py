# SPDX-License-Identifier: GPL-3.0-or-later
"""Penumbrae of large lamps close above a floor with a post are right where they cross faces of a cube shadow map."""

import math
from dataclasses import replace

import numpy as np
import pytest

from splat_addon.rendering import Camera, Light, Scene, Settings, look_at
from tests.rendering.lamp_rays import floor_places, sampled, seen_share

SIZE, WIDTH, EYE = 64, 1.6, 5.0
SETTINGS = Settings(
    method="quad", supersampling=1, shadow_resolution=512, outputs=("color", "depth", "shadow"), blends_rest=False
)
#: Axes: away from the lamp, across, and up; the lamp is above the origin.
POST = np.array([(0.6, -0.1, 0.0), (0.8, 0.1, 0.6)])
PLACES = floor_places(SIZE, WIDTH, 1.2)

LAMPS = {
    "point": Light("point", energy=60, position=(0, 0, 1), size=0.3, casts_shadow=True),
    "large point": Light("point", energy=60, position=(0, 0, 1), size=0.6, casts_shadow=True),
    "spot": Light("spot", energy=60, position=(0, 0, 1), size=0.3, spot_angle=3.0, casts_shadow=True),
    "area": Light(
        "area", energy=60, position=(0, 0, 1), half_axes=((0.3, 0, 0), (0, 0.3, 0)), is_round=True, casts_shadow=True
    ),
}


@pytest.fixture(scope="module")
def casters():
    return sampled(*POST, 24), sampled((-5, -5, -0.2), (5, 5, 0), 80)


def turned(angle: float) -> np.ndarray:
    matrix = np.eye(4)
    matrix[:2, :2] = (math.cos(angle), -math.sin(angle)), (math.sin(angle), math.cos(angle))
    return matrix


def camera(angle: float) -> Camera:
    middle = turned(angle)[:3, :3] @ (1.2, 0, 0)
    up = turned(angle)[:3, 1]
    return Camera.orthographic(look_at((*middle[:2], EYE), middle, up), WIDTH, (SIZE, SIZE), 0.05, 20)


@pytest.fixture
def share(render, casters):
    """share(lamp, angle) -> (h, w): the share of the lamp's light that arrives around the post.

    Everything except the cube map's faces is turned by the angle.
    """

    def measure(lamp: Light, angle: float) -> np.ndarray:
        around = [replace(i, matrix_world=turned(angle)) for i in casters]
        half_axes = np.array(lamp.half_axes) @ turned(angle)[:3, :3].T
        return render(Scene(around, [replace(lamp, half_axes=half_axes)]), camera(angle), SETTINGS).shadow[..., 0]

    return measure


def on_the_floor() -> np.ndarray:
    """(h, w) bool: pixels that show neither the post nor splats that stick out of it."""
    x, y, _ = np.moveaxis(PLACES, 2, 0)
    return ~((np.abs(x - 0.7) < 0.14) & (np.abs(y) < 0.14))


@pytest.mark.parametrize("name", LAMPS)
def test_where_faces_of_the_cube_meet_shadows_are_as_elsewhere(name, share):
    """The scene is turned about the lamp's axis, but the faces are not; so only the faces can change the shadows.

    The mean difference is 0.003. A search that is aligned with the faces and ends at their edges has 0.03, and 0.08 for
    the large lamp.
    """
    usual = share(LAMPS[name], 0.0)
    for angle in (math.pi / 4, 0.6):
        difference = np.abs(share(LAMPS[name], angle) - usual)[on_the_floor()]
        assert difference.mean() < 0.006
        assert np.quantile(difference, 0.99) < 0.06


@pytest.mark.parametrize("name", LAMPS)
@pytest.mark.parametrize("angle", [0.0, 0.6])
def test_a_penumbra_is_what_rays_to_the_lamp_say(angle, name, share):
    """The mean error is 0.03 to 0.04, as elsewhere in the picture.

    A search that ends at a face's edge has 0.08 for the large lamp.
    """
    difference = (share(LAMPS[name], angle) - seen_share(LAMPS[name], POST, PLACES))[on_the_floor()]
    assert np.abs(difference).mean() < 0.042
    assert np.sqrt((difference**2).mean()) < 0.062
