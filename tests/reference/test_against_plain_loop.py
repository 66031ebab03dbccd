# SPDX-License-Identifier: GPL-3.0-or-later
"""The reference agrees with the same definition written as two loops over rays and splats, with other formulas."""

import numpy as np
import pytest

from splat_addon.reference import render_exact
from splat_addon.rendering.frame import EMPTY_DEPTH
from splat_addon.rendering.scene import Instance, Scene
from splat_addon.rendering.scene.camera import Camera, look_at
from splat_addon.rendering.settings import Settings
from splat_addon.surfels import Surfels

SHEARED = np.array([[1.1, 0.4, 0.0, 0.2], [-0.2, 0.8, 0.3, -0.1], [0.1, 0.0, -1.3, 0.3], [0, 0, 0, 1]])


def random_surfels(count: int) -> Surfels:
    random = np.random.default_rng(7)
    rotations, normals = random.normal(size=(count, 4)), random.normal(size=(count, 3))
    return Surfels(
        positions=random.uniform(-1, 1, (count, 3)),
        rotations=rotations / np.linalg.norm(rotations, axis=1, keepdims=True),
        scales=random.uniform(0.05, 0.6, (count, 2)),
        normals=normals / np.linalg.norm(normals, axis=1, keepdims=True),
        colors=np.concatenate([random.uniform(0, 1, (count, 3)), np.ones((count, 1))], axis=1),
        materials=np.zeros(count, int),
        origin=(0.5, -0.25, 0.125),
    )


def plain_ray(origin, direction, forward, camera, splats, epsilon):
    """Colour and depth of one ray in world space; a 3 x 3 linear system gives its coordinates on each ellipse."""
    hits = []
    for center, u, v, color in splats:
        is_back = np.dot(-np.cross(u, v), forward if camera.is_orthographic else center - origin) > 0  # mirrored
        matrix = np.stack([u, v, -direction], axis=1)
        a, b, t = np.linalg.solve(matrix, origin - center)
        depth = t * (direction @ forward)
        if a * a + b * b <= 1 and camera.near <= depth <= camera.far:
            point, push = t * direction, epsilon * (1 + is_back) * max(np.linalg.norm(u), np.linalg.norm(v))
            pushed = (point + push * direction / np.linalg.norm(direction)) @ forward
            hits.append((depth, pushed, np.exp(-2 * (a * a + b * b)) * (1e-3 if is_back else 1), color))
    if not hits:
        return np.zeros(3), EMPTY_DEPTH
    limit = min(hit[1] for hit in hits)
    seen = [hit for hit in hits if hit[0] <= limit]
    total = sum(hit[2] for hit in seen)
    return sum(hit[2] * hit[3] for hit in seen) / total, sum(hit[2] * hit[0] for hit in seen) / total


@pytest.mark.parametrize("projection", ["perspective", "orthographic"])
def test_a_sheared_mirrored_cloud_around_the_eye_is_what_single_rays_see(projection):
    size = (10, 8)
    pose = look_at((0.4, -1.2, 0.5), (0.1, 0.3, 0.2))
    camera = {
        "perspective": Camera.perspective(pose, 1.2, size, 0.05, 3.0, shift=(0.1, -0.05)),
        "orthographic": Camera.orthographic(pose, 2.0, size, 0.05, 3.0, shift=(0.1, -0.05)),
    }[projection]
    surfels = random_surfels(120)
    frame = render_exact(Scene([Instance(surfels, SHEARED)]), camera, Settings(shading="flat"), samples=1)

    centers = (surfels.origin + surfels.positions) @ SHEARED[:3, :3].T + SHEARED[:3, 3]
    u, v = (axis.astype(float) @ SHEARED[:3, :3].T for axis in surfels.half_axes())
    splats = list(zip(centers, u, v, surfels.colors[:, :3], strict=True))
    right, up, back, eye = camera.matrix_world[:3].T
    left, right_edge, bottom, top = camera.window
    covered = 0
    for row in range(size[1]):
        for column in range(size[0]):
            x = left + (column + 0.5) / size[0] * (right_edge - left)
            y = bottom + (row + 0.5) / size[1] * (top - bottom)
            across = x * right + y * up
            ray = (eye + across, -back) if camera.is_orthographic else (eye, across - back)
            color, depth = plain_ray(*ray, -back, camera, splats, 0.5)
            np.testing.assert_allclose(frame.color[row, column, :3], color, atol=1e-6)
            assert frame.depth[row, column] == pytest.approx(depth, rel=1e-6)
            covered += depth < EMPTY_DEPTH
    assert covered > 0.3 * size[0] * size[1]
