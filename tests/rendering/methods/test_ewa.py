# SPDX-License-Identifier: GPL-3.0-or-later
"""The method "ewa" agrees with `render_ewa`, the papers' EWA in float64, which shares no formula with its shader."""

import pytest

from splat_addon.reference import render_ewa, scenes
from splat_addon.reference.metrics import psnr
from splat_addon.rendering import Camera, Settings

#: The truth has every splat.
FLAT = Settings(method="ewa", shading="flat", supersampling=1, detail_tolerance=0)
SIZE = (128, 128)


def orthographic_torus():
    scene, camera = scenes.torus(20_000, SIZE)
    return scene, Camera.orthographic(camera.matrix_world, 2.9, SIZE, camera.near, camera.far)


SCENES = {
    "large splats": lambda: scenes.sphere(1_000, SIZE),
    "splats as pixels": lambda: scenes.torus(20_000, SIZE),
    "parallel rays": orthographic_torus,
    "sub-pixel splats": lambda: scenes.sphere(100_000, SIZE),
}


@pytest.mark.parametrize("name", SCENES)
def test_the_picture_is_that_of_the_papers(name, render):
    scene, camera = SCENES[name]()
    frame, truth = render(scene, camera, FLAT), render_ewa(scene, camera, FLAT)
    found = psnr(frame.color, truth.color)
    assert found > 55, f"{found:.1f} dB"
