# SPDX-License-Identifier: GPL-3.0-or-later
"""Each method's GLSL does what its numpy twin says, splat by splat."""

import numpy as np
import pytest

from splat_addon.rendering import Camera, Renderer, Scene, Settings
from splat_addon.rendering.methods import METHODS
from splat_addon.rendering.methods.plane import splat_plane
from splat_addon.surfels import Surfels, axes_quaternions

SIZE = 48
SPLATS = 24
#: Pixels; rims and boxes of footprints are snapped to 1 / 256 of one.
NEAR = 0.01
CAMERAS = {
    "perspective": Camera.perspective(np.eye(4), 1.0, (SIZE, SIZE), near=0.01, far=100),
    "orthographic": Camera.orthographic(np.eye(4), 2.0, (SIZE, SIZE), near=0.01, far=100),
}


def random_splat(random):
    """A splat about depth 1 to 3, from a tenth of a pixel to a third of the picture, tilted up to 85 degrees."""
    depth = random.uniform(1, 3)
    tilt, turn, spin = np.radians(random.uniform(0, 85)), *random.uniform(0, 2 * np.pi, 2)
    normal = np.array((np.sin(tilt) * np.cos(turn), np.sin(tilt) * np.sin(turn), np.cos(tilt)))
    x = np.cross(normal, (0.31, 0.95, 0.05))
    x /= np.linalg.norm(x)
    x = x * np.cos(spin) + np.cross(normal, x) * np.sin(spin)
    long = 10 ** random.uniform(-3, -0.5) * depth
    scales = np.array((long, long * random.uniform(0.2, 1)))
    position = np.array((*random.uniform(-0.3, 0.3, 2) * depth, -depth))
    return Surfels(
        position[None], axes_quaternions(x[None], np.cross(normal, x)[None], normal[None]), scales[None],
        normal[None], np.ones((1, 4)), np.zeros(1, int),
    )  # fmt: skip


def gpu_weights(device, method, surfels, camera):
    """(SIZE, SIZE) sums of weights that the attribute pass leaves."""
    renderer = Renderer(device)
    renderer.render(Scene((surfels,)), camera, Settings(method=method, supersampling=1, shading="flat", epsilon=50))
    sums = next(texture for key, texture in renderer.resources.textures.items() if key[0] == "color_sum")
    margin = (sums.size[0] - SIZE) // 2
    return device.target([sums]).read(0)[margin : margin + SIZE, margin : margin + SIZE, 3]


def twin_weights(method, surfels, camera, shift=(0.0, 0.0)):
    """(SIZE, SIZE) weights at the pixels' centres, or `shift` pixels beside them."""
    left, right, bottom, top = camera.window
    pixel = np.array([right - left, top - bottom]) / SIZE
    x, y = np.meshgrid(np.arange(SIZE) + 0.5 + shift[0], np.arange(SIZE) + 0.5 + shift[1])
    points = np.stack([left + x.ravel() * pixel[0], bottom + y.ravel() * pixel[1]], axis=1)
    u, v = surfels.half_axes()
    plane = splat_plane(surfels.positions[0], u[0], v[0], camera.is_orthographic)
    return METHODS[method].twin.samples(plane, points, pixel)[0].reshape(SIZE, SIZE)


@pytest.mark.parametrize("kind", CAMERAS)
@pytest.mark.parametrize("method", METHODS)
def test_weights_are_the_twins(method, kind, on_device):
    random = np.random.default_rng(5)
    splats = [random_splat(random) for _ in range(SPLATS)]
    camera = CAMERAS[kind]
    pictures = on_device(lambda device: [gpu_weights(device, method, s, camera) for s in splats])
    covered = 0
    for surfels, picture in zip(splats, pictures, strict=True):
        twin = twin_weights(method, surfels, camera)
        beside = [twin_weights(method, surfels, camera, (x, y)) > 0 for x in (-NEAR, NEAR) for y in (-NEAR, NEAR)]
        away_from_rim = np.logical_and.reduce([b == (twin > 0) for b in beside])
        assert np.abs(picture - twin)[away_from_rim].max() < 2e-4
        covered += np.count_nonzero(twin)
    assert covered > 20 * SPLATS
