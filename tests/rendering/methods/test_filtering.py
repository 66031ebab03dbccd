# SPDX-License-Identifier: GPL-3.0-or-later
"""How true the default filter is at one sample a pixel, against the reference under the pixel's Gaussian."""

import numpy as np
import pytest

from splat_addon.reference import render_exact, scenes
from splat_addon.reference.metrics import psnr
from splat_addon.rendering import Settings

SCENES = {
    "checker": lambda: scenes.checker_plane(cells=40, elevation=6, size=(128, 128)),
    "torus": lambda: scenes.torus(size=(128, 128)),
    "sub-pixel sphere": lambda: scenes.sphere(100_000, size=(128, 128)),
}
FLAT = {"shading": "flat", "supersampling": 1}


@pytest.mark.parametrize("name", SCENES)
def test_mip_is_above_35_db_and_6_above_the_papers(name, render):
    scene, camera = SCENES[name]()
    exact = render_exact(scene, camera, Settings(**FLAT), samples=6, pixel_filter="gaussian")
    frames = {m: render(scene, camera, Settings(method=m, **FLAT)) for m in ("mip", "raycast", "homogeneous")}
    true = {method: psnr(frame.color, exact.color) for method, frame in frames.items()}
    assert true["mip"] > 35, true
    assert true["mip"] > max(true["raycast"], true["homogeneous"]) + 6, true


@pytest.mark.parametrize("name", SCENES)
def test_mip_leaves_no_hole_where_the_surface_covers_the_filter(name, render):
    scene, camera = SCENES[name]()
    exact = render_exact(scene, camera, Settings(**FLAT), samples=6, pixel_filter="gaussian")
    frame = render(scene, camera, Settings(method="mip", **FLAT))
    assert np.isfinite(frame.color).all()
    assert not np.count_nonzero((exact.coverage > 0.999) & (frame.coverage < 0.95))
