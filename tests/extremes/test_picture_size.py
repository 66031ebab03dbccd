# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures of one pixel, one row, and 8192 x 16."""

from dataclasses import replace

import pytest

from splat_addon.reference import scenes
from splat_addon.rendering import Settings


@pytest.mark.parametrize("size", [(1, 1), (1, 64), (64, 1), (8192, 16), (16, 8192)])
def test_any_size_is_the_true_picture(size, hold):
    scene, camera = scenes.sphere(1000)
    hold({f"{size}": (scene, replace(camera, size=size), Settings(supersampling=1))})
