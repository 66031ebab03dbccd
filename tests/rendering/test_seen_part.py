# SPDX-License-Identifier: GPL-3.0-or-later
"""Passes over the picture draw only where something may be seen; the picture is the same as if they drew all of it."""

from dataclasses import replace

import numpy as np
import pytest

from splat_addon.reference import scenes
from splat_addon.rendering import Renderer, Scene, Settings, look_at
from splat_addon.rendering.methods import METHODS
from splat_addon.rendering.plan.executor import TileContext
from splat_addon.rendering.scene.lines import Lines

SIZE = (200, 160)
EVERYTHING = ("color", "depth", "normal", "coverage", "shadow", "overdraw")


def small(opacity: float = 1.0) -> tuple[Scene, list]:
    """A ball, and two cameras that see it small, in different places of the picture."""
    scene, camera = scenes.sphere(count=3000, size=SIZE)
    (ball,) = scene.surfels
    shape = replace(ball.surfels, colors=ball.surfels.colors * (1, 1, 1, opacity))
    poses = [look_at((0, -32, 12), target) for target in ((7, 0, 4), (-6, 0, -3))]
    cameras = [replace(camera, matrix_world=pose, far=100.0) for pose in poses]
    return replace(scene, surfels=(replace(ball, shape=shape),)), cameras


CASES = {
    **{method: (Settings(method=method, outputs=EVERYTHING), 1.0) for method in METHODS},
    "samples": (Settings(supersampling=3, outputs=EVERYTHING), 1.0),
    "layers": (Settings(outputs=EVERYTHING), 0.4),
    "layers of quads": (Settings(method="quad", outputs=EVERYTHING), 0.4),
    "numbers": (Settings(outputs=("color", "object_index", "material_index")), 1.0),
    "numbers of layers": (Settings(outputs=("color", "object_index")), 0.9),
    "wide lines": (Settings(outputs=EVERYTHING, lines=Lines(width=9.0)), 1.0),
    "occlusion": (Settings(outputs=EVERYTHING, ambient_occlusion=1.0), 1.0),
    "transparent film": (Settings(outputs=EVERYTHING, transparent_film=True), 1.0),
}


@pytest.mark.parametrize("name", CASES)
def test_the_picture_is_the_same(name, on_device, monkeypatch):
    """Also after a frame that left something else in the textures; a mean of backgrounds may be rounded."""
    settings, opacity = CASES[name]
    scene, cameras = small(opacity)

    def drawn(device):
        renderer = Renderer(device)
        return [renderer.render(scene, camera, settings) for camera in cameras]

    parts = on_device(drawn)
    monkeypatch.setattr(TileContext, "seen_part", lambda tile, p: None)
    for frame, whole in zip(parts, on_device(drawn), strict=True):
        share = (np.abs(whole.color - whole.color[0, 0]).max(axis=2) > 0.01).mean()
        assert 0.001 < share < 0.06
        for output in settings.outputs:
            np.testing.assert_allclose(getattr(frame, output), getattr(whole, output), rtol=3e-7, err_msg=output)


def test_little_of_the_picture_is_drawn(on_device, monkeypatch):
    scene, (camera, _) = small()
    shares, fill = {}, TileContext.fill

    def watched(tile, p, viewport=None):
        target = fill(tile, p, viewport)
        shares[p.name] = np.prod(viewport[2:]) / np.prod(target.size)
        return target

    monkeypatch.setattr(TileContext, "fill", watched)
    on_device(lambda device: Renderer(device).render(scene, camera, Settings()))
    assert set(shares) == {"depth_bounds", "hiz", "deferred_lighting", "resolve"} and max(shares.values()) < 0.25
