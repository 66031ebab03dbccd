# SPDX-License-Identifier: GPL-3.0-or-later
"""The splatting error of one filtered sample per pixel, under the pixel's Gaussian, is within the promised bounds."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from splat_addon.reference import render_exact, scenes
from splat_addon.reference.metrics import psnr, srgb
from splat_addon.rendering import Camera, Renderer, Settings

SIZE = (128, 128)
#: Outlines and letters take a smaller share of a larger picture: the bounds of scenes with them are those of this size.
OUTLINED = (256, 256)
FLAT = Settings(shading="flat", supersampling=1)


def orthographic_torus():
    scene, camera = scenes.torus(60_000, OUTLINED)
    return scene, Camera.orthographic(camera.matrix_world, 2.9, OUTLINED, camera.near, camera.far)


#: Scenes with splats smaller than a pixel, as large as one, and larger.
SCENES = {
    "checker of 90,000": lambda: scenes.checker_plane(100, 90_000, 6, SIZE),
    "checker at 6 degrees": lambda: scenes.checker_plane(20, 10_000, 6, SIZE),
    "checker at 60 degrees": lambda: scenes.checker_plane(20, 10_000, 60, SIZE),
    "text": lambda: scenes.text_board(66_000, size=OUTLINED),
    "torus": lambda: scenes.torus(60_000, OUTLINED),
    "orthographic torus": orthographic_torus,
    "sub-pixel sphere": lambda: scenes.sphere(75_000, SIZE),
}


@cache
def made(name):
    return SCENES[name]()


@cache
def exact(name):
    """The truth with 16 rays per pixel; with 64 the decibels below change by less than 0.3."""
    return render_exact(*made(name), FLAT, samples=4, pixel_filter="gaussian")


@pytest.fixture(scope="module")
def shown(on_device):
    """shown(name, method) -> Frame, drawn once."""

    @cache
    def draw(name, method):
        settings = replace(FLAT, method=method)
        return on_device(lambda device: Renderer(device).render(*made(name), settings))

    return draw


@pytest.mark.parametrize("name", SCENES)
def test_mip_is_above_39_db_and_6_above_the_papers(name, shown):
    """The promise is 36 dB; the test holds what is reached, so that an error in a few rows of pixels is noticed."""
    true = {m: psnr(shown(name, m).color, exact(name).color) for m in ("mip", "raycast", "homogeneous")}
    assert true["mip"] > 39.5, true
    assert true["mip"] > max(true["raycast"], true["homogeneous"]) + 6, true


@pytest.mark.parametrize("name", SCENES)
def test_mips_mean_flip_is_at_most_0_016(name, shown):
    flip_evaluator = pytest.importorskip("flip_evaluator", reason="FLIP is measured outside of a Blender program")
    truth, picture = (np.float32(srgb(f.color[..., :3])) for f in (exact(name), shown(name, "mip")))
    assert flip_evaluator.evaluate(truth, picture, "LDR", applyMagma=False)[1] <= 0.016


@pytest.mark.parametrize("name", SCENES)
def test_mip_leaves_no_hole_where_the_surface_covers_the_filter(name, shown):
    frame = shown(name, "mip")
    assert np.isfinite(frame.color).all()
    assert not np.count_nonzero((exact(name).coverage > 0.999) & (frame.coverage < 0.95))


@pytest.mark.parametrize(
    ("name", "samples", "rays"), [("checker at 6 degrees", 4, 5), ("text", 4, 5), ("checker of 90,000", 5, 7)]
)
def test_supersampled_quads_are_above_36_db_under_a_box(name, samples, rays, render):
    """The truth uses other rays than the samples, or the picture would be compared with itself.

    Checks far below a pixel need 5 x 5 samples.
    """
    scene, camera = made(name)
    truth = render_exact(scene, camera, FLAT, samples=rays, pixel_filter="box")
    frame = render(scene, camera, replace(FLAT, method="quad", supersampling=samples))
    assert psnr(frame.color, truth.color) > 36
