# SPDX-License-Identifier: GPL-3.0-or-later
"""Passes over the picture draw only where something may be seen; the picture is the same as if they drew all of it."""

from dataclasses import replace

import numpy as np
import pytest

from splat_addon.reference import scenes
from splat_addon.rendering import Renderer, Scene, Settings, look_at
from splat_addon.rendering.methods import METHODS
from splat_addon.rendering.plan.tile import TileContext
from splat_addon.rendering.scene.eye_dome import EyeDome
from splat_addon.rendering.scene.lines import Lines
from splat_addon.surfels import valid_surfels

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
    "occlusion": (Settings(outputs=EVERYTHING, ambient_occlusion=1.0, eye_dome=EyeDome(radius=9.0)), 1.0),
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
    monkeypatch.setattr(TileContext, "seen_part", lambda tile, p, beside=0: None)
    for frame, whole in zip(parts, on_device(drawn), strict=True):
        share = (np.abs(whole.color - whole.color[0, 0]).max(axis=2) > 0.01).mean()
        assert 0.001 < share < 0.06
        for output in settings.outputs:
            np.testing.assert_allclose(getattr(frame, output), getattr(whole, output), rtol=3e-7, err_msg=output)


def test_of_a_thin_diagonal_shape_less_is_drawn_than_its_box_covers():
    """All ellipses lie in the hull's box in any direction, and along the diagonal it is hardly wider than they are."""
    along = np.linspace(-1, 1, 500)[:, None] * np.ones(3)
    size = 0.01
    shape, _ = valid_surfels(
        (5.0, 0.0, 0.0),
        positions=along.astype(np.float32),
        rotations=np.tile(np.float32((1, 0, 0, 0)), (500, 1)),
        scales=np.full((500, 2), size, np.float32),
        normals=np.tile(np.float32((0, 0, 1)), (500, 1)),
        colors=np.ones((500, 4), np.float32),
        materials=np.zeros(500, np.int32),
    )
    axes = np.array(((1, 1, 1), (1, -1, 0), (1, 0, 0), (0, -1, 2)), float)
    axes /= np.linalg.norm(axes, axis=1, keepdims=True)
    hull, held = shape.local_hull @ axes.T, shape.positions @ axes.T
    reach = 0.999 * size  # rounded to float32
    assert (hull.min(axis=0) <= held.min(axis=0) - reach).all()
    assert (hull.max(axis=0) >= held.max(axis=0) + reach).all()
    assert np.ptp(hull[:, 1]) < 0.25


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
