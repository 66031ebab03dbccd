# SPDX-License-Identifier: GPL-3.0-or-later
"""A sheet has two sides: its back is lit as the front of the same sheet turned over, however flat it is seen."""

from dataclasses import replace

import numpy as np
import pytest

from splat_addon.reference import render_exact
from splat_addon.reference.extremes import sheet
from splat_addon.rendering import Camera, Light, Scene, Settings, look_at

CAMERA = Camera.perspective(look_at((0, 0, 0), (0, 0, -1), (0, 1, 0)), 0.6, (40, 40), 0.1, 100)
FROM_BELOW = Light("sun", energy=3, direction=(0.2, 1, -0.3))


def turned_over(surfels):
    """Each about its first axis."""
    w, x, y, z = surfels.rotations.T
    return replace(surfels, rotations=np.stack([-x, w, z, -y], axis=1), normals=-surfels.normals)


def colors_of(draw, surfels):
    return draw(Scene((surfels,), (FROM_BELOW,), (0.1, 0.1, 0.1)), CAMERA, Settings(transparent_film=True)).color


@pytest.mark.parametrize("tilt", [98, 100, 105, 120])
def test_a_lone_back_is_lit_as_a_front(tilt, render):
    """Tilted by more than 90 degrees it shows its back, from below where the sun is. Were its normals left as they are,
    they would be in the dark."""
    back = sheet(24, 1.5, tilt, 5, (0.8, 0.7, 0.6))
    for draw in (render, render_exact):
        picture, front = colors_of(draw, back), colors_of(draw, turned_over(back))
        inside = np.minimum(picture[..., 3], front[..., 3]) > 0.999
        assert inside.sum() > 50 and picture[inside][:, :3].min() > 0.15
        assert np.abs(picture - front)[inside].max() < 1e-3
