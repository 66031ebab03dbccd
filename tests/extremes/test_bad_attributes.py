# SPDX-License-Identifier: GPL-3.0-or-later
"""Unusable surfels are left out and counted; absurd but usable ones do not affect the other surfels."""

from dataclasses import replace

import numpy as np
import pytest

from splat_addon.reference import scenes
from splat_addon.reference.metrics import psnr
from splat_addon.rendering import Instance, Scene
from splat_addon.surfels import LAYOUT, valid_surfels

UNUSABLE = [
    ("positions", np.nan), ("positions", np.inf), ("rotations", np.nan), ("rotations", 0.0), ("scales", np.nan),
    ("scales", np.inf), ("scales", 0.0), ("scales", -1.0), ("normals", np.nan), ("normals", 0.0), ("normals", np.inf),
    ("colors", np.nan), ("colors", -np.inf), ("materials", -1),
]  # fmt: skip
ABSURD = [1e6, 1e12, 1e18, 1e30, 1e38]
EVERY = 50


@pytest.fixture
def world():
    scene, camera = scenes.sphere(1000, (32, 32))
    return scene, camera, {n: getattr(scene.surfels[0].surfels, n).copy() for n in LAYOUT}


def shot(scene, camera, surfels):
    return Scene((Instance(surfels, materials=scene.surfels[0].materials),), scene.lights, scene.world), camera, None


@pytest.mark.parametrize(("field", "value"), UNUSABLE)
def test_unusable_surfels_are_counted_and_the_rest_is_kept(field, value, world):
    _, _, arrays = world
    kept = np.arange(len(arrays["positions"])) % EVERY != 0
    without, _ = valid_surfels(**{n: a[kept] for n, a in arrays.items()})
    arrays[field][~kept] = value
    surfels, skipped = valid_surfels(**arrays)
    assert skipped == np.count_nonzero(~kept)
    for name in LAYOUT:
        np.testing.assert_array_equal(getattr(surfels, name), getattr(without, name))


@pytest.mark.parametrize("value", ABSURD)
def test_one_stray_position_leaves_the_others_as_they_are(value, world, hold):
    """The view must not be scaled to it."""
    scene, camera, arrays = world
    arrays["positions"][0] = value
    surfels, _ = valid_surfels(**arrays)
    hold({f"{value:g}": shot(scene, camera, surfels)[:2]}, least=60)


@pytest.mark.parametrize("distance", [1e6, 1e18, 1e30])
def test_one_surfel_far_away_in_view_leaves_the_others_as_they_are(distance, world, hold):
    """This holds even if the far plane does not cut it off, because the view is scaled by the median depth, not the
    mean.
    """
    scene, camera, arrays = world
    arrays["positions"][0] = camera.matrix_world[:3, 3] - distance * camera.matrix_world[:3, 2]
    surfels, _ = valid_surfels(**arrays)
    hold({f"{distance:g}": (shot(scene, camera, surfels)[0], replace(camera, far=1e32))}, least=60)


@pytest.mark.parametrize("value", ABSURD)
def test_one_absurd_size_leaves_what_lies_before_it_as_it_is(value, world, render_all):
    scene, camera, arrays = world
    arrays["positions"][0], arrays["rotations"][0] = (0, 6, 0), (np.sqrt(0.5), np.sqrt(0.5), 0, 0)
    usual, _ = valid_surfels(**arrays)
    arrays["scales"][0] = value
    absurd, _ = valid_surfels(**arrays)
    without, frame = render_all([shot(scene, camera, surfels) for surfels in (usual, absurd)])
    whole = without.coverage == 1
    assert psnr(frame.color[whole][None], without.color[whole][None]) > 60
    assert np.isfinite(frame.color).all()


def test_colours_may_be_very_bright(world, hold):
    scene, camera, arrays = world
    arrays["colors"][:, :3] *= np.float32(1e30)
    hold({"1e30": shot(scene, camera, valid_surfels(**arrays)[0])[:2]})
