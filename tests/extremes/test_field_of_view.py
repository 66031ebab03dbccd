# SPDX-License-Identifier: GPL-3.0-or-later
"""Fields of view from 1 to 170 degrees, and windows far off the axis, give the true picture."""

import numpy as np
import pytest

from splat_addon.reference import scenes
from splat_addon.reference.extremes import sheet
from splat_addon.rendering import Camera, look_at

SIZE = (32, 32)
ANGLES = [1, 10, 60, 120, 150, 165, 170]
SHIFTS = [0.5, 2, 5, 20, 100]


@pytest.fixture
def sphere():
    return scenes.sphere(1500, SIZE)[0]


def filling(angle):
    """A camera so close to the unit sphere that the sphere fills its picture."""
    distance = max(1.1 / np.sin(np.radians(angle / 2)), 1.3)
    eye = distance * np.array((0, -1, 0.1))
    return Camera.perspective(look_at(eye, (0, 0, 0)), np.radians(angle), SIZE, distance / 100, 10 * distance)


def shifted(shift):
    """A camera far to the side, with its window shifted back, in picture widths."""
    matrix = look_at((0, -4, 0), (0, 0, 0))
    width = 4 * 2 * np.tan(np.radians(30))
    matrix[:3, 3] -= shift * width * matrix[:3, 0]
    return Camera.perspective(matrix, np.radians(60), SIZE, 0.1, 100, shift=(shift, 0))


@pytest.mark.parametrize("angle", ANGLES)
def test_any_field_of_view_is_the_true_one(angle, hold, sphere):
    hold({f"{angle} degrees": (sphere, filling(angle))})


@pytest.mark.parametrize("shift", SHIFTS)
def test_a_window_far_off_the_axis_is_the_true_one(shift, hold, sphere):
    ((frame, _),) = hold({f"shift {shift}": (sphere, shifted(shift))}).values()
    assert frame.coverage.any()


@pytest.mark.parametrize("angle", [120, 150, 170])
def test_splats_across_a_wide_field_are_the_true_ones(angle, hold, lit, camera):
    """At 170 degrees the outermost pixels are 85 degrees off the axis, where affine approximations fail."""
    hold({f"{angle} degrees": (lit(sheet(40, 8.0, 0, 1.0)), camera(angle))})
