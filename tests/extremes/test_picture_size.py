# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures may have one pixel, one row, or 8192 x 16 pixels."""

from dataclasses import replace

import pytest

from splat_addon.reference import scenes
from splat_addon.reference.extremes import sheet
from splat_addon.rendering import Settings

NARROW = [(1, 1), (1, 64), (64, 1)]
LONG = [(8192, 16), (16, 8192)]


@pytest.mark.parametrize("size", NARROW, ids="{0[0]}x{0[1]}".format)
def test_any_shape_of_pixel_is_the_true_picture(size, hold):
    """All sizes share one window, so that pixels are up to 64 times wider than high, or higher than wide."""
    scene, camera = scenes.sphere(1000)
    hold({f"{size}": (scene, replace(camera, size=size))})


@pytest.mark.parametrize("size", LONG, ids="{0[0]}x{0[1]}".format)
def test_a_long_picture_is_the_true_one(size, hold, lit, camera):
    window = tuple(side * length / 8192 for length in size for side in (-1, 1))
    wall = lit(sheet(60, 0.9, 20, 1.0))
    hold({f"{size}": (wall, replace(camera(), window=window, size=size), Settings(supersampling=1))})
