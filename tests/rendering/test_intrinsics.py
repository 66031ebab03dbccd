# SPDX-License-Identifier: GPL-3.0-or-later
"""A calibrated camera projects as computer vision's pinhole does: to fx X / Z + cx, and fy Y / Z + cy downwards."""

import numpy as np
import pytest

from splat_addon.rendering import Camera


@pytest.mark.parametrize("point", [(0.0, 0.0, 2.0), (0.3, -0.2, 1.5), (-1.0, 0.7, 4.0)])
def test_a_point_falls_on_its_pixel(point):
    fx, fy, cx, cy, size = 500.0, 480.0, 310.0, 250.0, (640, 480)
    camera = Camera.from_intrinsics(fx, fy, cx, cy, size, np.eye(4))
    x, y, z = point  # y down and z forwards, as computer vision has them
    clip = camera.projection(camera.near, camera.far) @ (x, -y, -z, 1.0)
    right, up = (clip[:2] / clip[3] + 1) / 2 * size
    np.testing.assert_allclose((right, size[1] - up), (fx * x / z + cx, fy * y / z + cy))
