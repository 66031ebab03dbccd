# SPDX-License-Identifier: GPL-3.0-or-later
"""The exact picture of splats that end at clip lines, and of splats with a blend depth of their own."""

from dataclasses import replace

import numpy as np
import pytest

from splat_addon.clip_lines import pack_lines
from splat_addon.reference import render_exact
from splat_addon.reference.shadows import lit_share
from splat_addon.rendering import Camera, Instance, Light, Scene, Settings

SETTINGS = Settings(shading="flat", transparent_film=True)
LEFT, LOW = pack_lines(np.array([[1.0, 0, 0]])), pack_lines(np.array([[0, 1.0, 0]]))


def share(surfels, camera, matrix=None):
    """The number of covered pixels, relative to those of the disc without clip lines."""
    scenes = (Scene((Instance(s, np.eye(4) if matrix is None else matrix),)) for s in surfels)
    one, whole = (render_exact(scene, camera, SETTINGS, samples=4).coverage.sum() for scene in scenes)
    return one / whole


@pytest.fixture
def disc(ellipses):
    """disc(**lines) -> a disc that faces the camera with these clip lines, and the same disc without."""
    plain = ellipses((0, 0, -4), (1.5, 0, 0), (0, 1.0, 0))
    return lambda **lines: (replace(plain, **lines), plain)


@pytest.mark.parametrize(
    ("lines", "kept"),
    [
        ({"clip_line": LEFT}, 1 / 2),
        ({"clip_line_2": LOW}, 1 / 2),
        ({"clip_line": LEFT, "clip_line_2": LOW}, 1 / 4),
        ({"clip_line": LOW, "clip_line_2": LEFT}, 3 / 4),
    ],
    ids=["one line", "the second alone", "convex corner", "reflex corner"],
)
def test_what_is_left_of_a_disc(disc, perspective, lines, kept):
    assert share(disc(**lines), perspective((64, 64))) == pytest.approx(kept, abs=5e-3)


def test_the_side_that_is_kept(disc, perspective):
    frame = render_exact(Scene((disc(clip_line=LEFT)[0],)), perspective((32, 32)), SETTINGS, samples=2)
    assert frame.coverage[:, :16].sum() == 0 < frame.coverage[:, 16:].sum()


def test_a_mirrored_instance_keeps_the_mirrored_side(disc, perspective):
    mirror = np.diag([-1.0, 1, 1, 1])
    scene = Scene((Instance(disc(clip_line=LEFT)[0], mirror),))
    frame = render_exact(scene, perspective((32, 32)), SETTINGS, samples=2)
    assert frame.coverage[:, 16:].sum() == 0 < frame.coverage[:, :16].sum()


def test_two_halves_that_meet_leave_no_gap_and_no_ghost(disc, perspective):
    half, whole = disc(clip_line=pack_lines(np.array([[0.6, 0.8, 0.1]])))
    other = replace(whole, clip_line=pack_lines(np.array([[-0.6, -0.8, -0.1]])))
    camera = perspective((48, 48))
    both, one = (render_exact(Scene(s), camera, SETTINGS, samples=3).coverage for s in ((half, other), (whole,)))
    assert np.array_equal(both, one)


def test_clipped_splats_hide_nothing_where_they_are_cut(disc, ellipses, perspective):
    behind = ellipses((0, 0, -5), (5, 0, 0), (0, 5, 0), colors=(0, 1, 0))
    scene = Scene((replace(disc(clip_line=LEFT)[0], colors=np.array([[1, 0, 0, 1]])), behind))
    color = render_exact(scene, perspective((32, 32)), SETTINGS, samples=2).color
    assert np.allclose(color[16, 14, :3], (0, 1, 0)) and np.allclose(color[16, 18, :3], (1, 0, 0))


def test_a_clipped_splat_shadows_with_what_is_left_of_it(disc, ellipses):
    """Half a disc at height 1, under a vertical sun, shadows half as much as the whole disc."""
    floor = ellipses((0, 0, 0), (4, 0, 0), (0, 4, 0))
    places = np.stack([*np.meshgrid(*[np.linspace(-2, 2, 41)] * 2), np.zeros((41, 41))], axis=2).reshape(-1, 3)
    camera = Camera.orthographic(np.eye(4), 4, (8, 8), -10, 10)
    sun, shares = Light("sun", direction=(0, 0, -1)), []
    for caster in disc(clip_line=LEFT):
        scene = Scene((floor, replace(caster, origin=(0, 0, 5))), (sun,))
        shares.append((1 - lit_share(sun, scene, camera, places, 0.1)).reshape(41, 41))
    half, whole = shares
    assert whole.sum() > 100 and half[:, 20:].sum() == whole[:, 20:].sum()
    assert half[:, :20].sum() == 0


def sheets(ellipses, gap, blend):
    colors = [(1, 0, 0), (0, 1, 0)]
    both = ellipses([(0, 0, -4), (0, 0, -4 - gap)], (1, 0, 0), (0, 1, 0), colors=colors)
    return both if blend is None else replace(both, blend_depth=np.full(2, blend))


@pytest.mark.parametrize(("blend", "is_mixed"), [(None, True), (0.3, True), (0.1, False), (1.0, True)])
def test_a_sheet_behind_shines_through_only_as_deep_as_splats_blend(ellipses, orthographic, blend, is_mixed):
    scene = Scene((sheets(ellipses, 0.2, blend),))
    color = render_exact(scene, orthographic(), SETTINGS, samples=1).color
    middle = color[len(color) // 2, len(color) // 2]
    assert (middle[1] > 0.1) == is_mixed


def test_no_blend_depth_reaches_beyond_the_epsilon(ellipses, orthographic):
    scene = Scene((sheets(ellipses, 0.6, 1.0),))
    color = render_exact(scene, orthographic(), SETTINGS, samples=1).color
    assert color[len(color) // 2, len(color) // 2, 1] == 0
