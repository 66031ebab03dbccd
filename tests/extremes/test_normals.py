# SPDX-License-Identifier: GPL-3.0-or-later
"""Normals may cancel, oppose one another, lie in their splat's plane, or not be unit vectors."""

import numpy as np
import pytest

from splat_addon.reference.extremes import discs
from splat_addon.rendering import Settings
from splat_addon.surfels import valid_surfels

PAIRS = {
    "opposing": [(0, 0, 1), (0, 0, -1)],
    "cancelling in the plane": [(1, 0, 0), (-1, 0, 0)],
    "almost cancelling": [(1, 0, 1e-3), (-1, 0, 1e-3)],
    "in the plane": [(1, 0, 0), (1, 0, 0)],
}


def pair(normals):
    """Two discs at the same place that face the viewer."""
    return discs([(0, 0, -3)] * 2, (1, 0, 0), (0, 1, 0), normals=normals)


@pytest.mark.parametrize("name", PAIRS)
def test_any_two_normals_in_one_place_give_the_true_light(name, hold, lit, camera):
    hold({name: (lit(pair(PAIRS[name])), camera())}, least=100)


def test_a_surface_whose_normals_cancel_faces_the_viewer(render_all, lit, camera):
    (frame,) = render_all([(lit(pair(PAIRS["cancelling in the plane"])), camera(), None)])
    np.testing.assert_allclose(frame.normal[16, 16], (0, 0, 1), atol=1e-6)


@pytest.mark.parametrize("count", [3, 7, 40])
def test_what_rounding_leaves_of_cancelling_normals_is_no_normal(count, render_all, lit, camera):
    """Normals evenly around a circle add up to almost 0 in float32; the direction of the remainder is meaningless."""
    around = np.arange(count) * 2 * np.pi / count
    normals = np.stack([np.cos(around), np.sin(around), np.full(count, 5e-7)], axis=1)
    fan = discs(np.broadcast_to((0, 0, -3), (count, 3)), normals=normals)
    (frame,) = render_all([(lit(fan), camera(), Settings(supersampling=1))])
    np.testing.assert_array_equal(frame.normal[12:20, 12:20], np.broadcast_to((0, 0, 1), (8, 8, 3)))


@pytest.mark.parametrize("left", [1e-4, 3e-6])
def test_normals_that_cancel_but_for_a_millionth_have_their_direction(left, render_all, lit, camera):
    normals = [(1, left, left), (-1, left, left)]
    (frame,) = render_all([(lit(pair(normals)), camera(), Settings(supersampling=1))])
    np.testing.assert_allclose(frame.normal[16, 16], np.array((0, 1, 1)) / np.sqrt(2), atol=0.03)


@pytest.mark.parametrize("length", [1e-18, 1e-3, 1e3, 1e18])
def test_a_normals_length_does_not_matter(length, render_all, lit, camera):
    unit = discs((0, 0, -3), normals=(0.6, 0, 0.8))
    fields = {n: getattr(unit, n) for n in ("positions", "rotations", "scales", "colors", "materials")}
    long, skipped = valid_surfels(normals=unit.normals * np.float32(length), **fields)
    frames = render_all([(lit(surfels), camera(), None) for surfels in (unit, long)])
    assert skipped == 0
    np.testing.assert_allclose(frames[0].color, frames[1].color, atol=1e-6)
