# SPDX-License-Identifier: GPL-3.0-or-later
"""Edge Fade lets a splat fade by its kernel. It leaves the Mip Filter alone, which filters silhouettes itself."""

import numpy as np


def test_a_disc_of_quads_fades_to_its_rim(scene, add_camera, add_surfels, picture):
    add_camera(type="ORTHO", ortho_scale=32)
    add_surfels([(0, 0, 0)], size=12.0)
    hard = picture()[16, :, 3]
    scene.surfel_splatting.edge_threshold = 0.5
    row = picture()[16, :, 3]
    distance = np.hypot(np.arange(32) + 0.5 - 16, 0.5) / 12
    expected = np.where(distance < 1, np.minimum(np.exp(-2 * distance**2) / 0.5, 1), 0)
    np.testing.assert_allclose(row, expected, atol=1e-4)
    assert np.abs(hard - row).max() > 0.3
    scene.surfel_splatting.method = "mip"
    faded = picture()
    scene.surfel_splatting.edge_threshold = 0
    np.testing.assert_array_equal(picture(), faded)
