# SPDX-License-Identifier: GPL-3.0-or-later
"""A sheet has two sides: at any angle its back is lit like the front of the sheet turned over."""

from dataclasses import replace

import numpy as np
import pytest

from splat_addon.reference import render_exact
from splat_addon.reference.extremes import sheet
from splat_addon.rendering import Camera, Light, Scene, Settings, look_at
from splat_addon.sampling import TriangleMesh, sample_mesh

CAMERA = Camera.perspective(look_at((0, 0, 0), (0, 0, -1), (0, 1, 0)), 0.6, (40, 40), 0.1, 100)
FROM_BELOW = Light("sun", energy=3, direction=(0.2, 1, -0.3))


def turned_over(surfels):
    """The surfels, each turned over about its first axis."""
    w, x, y, z = surfels.rotations.T
    return replace(surfels, rotations=np.stack([-x, w, z, -y], axis=1), normals=-surfels.normals)


def colors_of(draw, surfels):
    return draw(Scene((surfels,), (FROM_BELOW,), (0.1, 0.1, 0.1)), CAMERA, Settings(transparent_film=True)).color


@pytest.mark.parametrize("tilt", [98, 100, 105, 120])
def test_a_lone_back_is_lit_as_a_front(tilt, render):
    """Tilted by more than 90 degrees it shows its back, seen from below, where the sun is.

    If its normals were not reversed, it would be dark.
    """
    back = sheet(24, 1.5, tilt, 5, (0.8, 0.7, 0.6))
    for draw in (render, render_exact):
        picture, front = colors_of(draw, back), colors_of(draw, turned_over(back))
        inside = np.minimum(picture[..., 3], front[..., 3]) > 0.999
        assert inside.sum() > 50 and picture[inside][:, :3].min() > 0.15
        assert np.abs(picture - front)[inside].max() < 1e-3


def test_the_far_side_of_an_open_box_colours_none_of_its_edges(render):
    """The white side faces away; its surfels, seen edge-on, stick out over the edge by less than a pixel."""
    corners = np.array([(x, y, z) for x in (-1, 1) for y in (-0.5, 0.5) for z in (-0.5, 0.5)])
    sides = np.array(((0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (1, 5, 7, 3)))
    surfels = sample_mesh(
        TriangleMesh(corners, np.concatenate([sides[:, (0, 1, 2)], sides[:, (0, 2, 3)]])), resolution=300
    )
    colors = np.where(surfels.normals[:, :1] < -0.5, (1.0, 1, 1, 1), (0.1, 0.1, 0.1, 1))
    camera = Camera.perspective(look_at((1.1, -3.2, 1.0), (0, 0, 0)), 0.75, (320, 240), 0.1, 30)
    scene = Scene((replace(surfels, colors=colors),), world=(0.1, 0.1, 0.1))
    assert render(scene, camera, Settings(shading="flat")).color[70:145, :100, :3].max() < 0.11
