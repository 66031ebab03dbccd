# SPDX-License-Identifier: GPL-3.0-or-later
"""Back faces of a solid are not drawn, but only while the camera is outside it."""

from dataclasses import replace

import numpy as np

from splat_addon.reference import render_exact, scenes
from splat_addon.rendering import Camera, look_at


def with_solid(scene, is_solid):
    instance = scene.surfels[0]
    surfels = instance.surfels.as_solid() if is_solid else instance.surfels
    return replace(scene, surfels=(replace(instance, shape=surfels),))


def test_backs_of_a_solid_are_not_seen():
    scene, camera = scenes.sphere(2000, size=(64, 64))
    pictures = (render_exact(with_solid(scene, s), camera, samples=2).coverage for s in (True, False))
    solid, open_ = pictures
    assert np.count_nonzero(open_ > solid) > 0 and not np.count_nonzero(solid > open_)


def test_from_inside_a_solid_its_backs_are_seen():
    scene, _ = scenes.sphere(2000)
    camera = Camera.perspective(look_at((0, 0, 0), (0, 1, 0)), 1.2, (16, 16), near=0.1, far=10)
    assert (render_exact(with_solid(scene, True), camera, samples=1).coverage == 1).all()
