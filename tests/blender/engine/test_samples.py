# SPDX-License-Identifier: GPL-3.0-or-later
"""Samples in a final render smooth edges and keep areas, also inside a border and in every view layer's passes."""

import numpy as np
import pytest


@pytest.fixture
def disc(scene, add_camera, add_surfels):
    """A hard-edged disc with a radius of 9.3 pixels."""
    add_camera((0, 0, 10), type="ORTHO", ortho_scale=32)
    add_surfels([(0.2, -0.1, 0)], size=9.3)


def test_samples_smooth_an_edge_and_keep_its_area(disc, scene, picture):
    one = picture()[..., 3]
    scene.surfel_splatting.samples = 64
    many = picture()[..., 3]
    assert np.unique(one).size == 2
    assert np.unique(many).size > 30
    assert many.sum() == pytest.approx(np.pi * 9.3**2, rel=0.002)
    np.testing.assert_array_equal(many[one[:, 0].size // 2, 14:19], 1)


def test_a_border_shows_the_same_samples(disc, scene, picture):
    scene.surfel_splatting.samples = 5
    whole = picture()
    render = scene.render
    render.use_border = render.use_crop_to_border = True
    render.border_min_x, render.border_max_x, render.border_min_y, render.border_max_y = 0.25, 0.75, 0.5, 1
    assert np.count_nonzero(np.abs(picture() - whole[16:, 8:24]).max(axis=2) > 1e-4) <= 1


def test_passes_have_their_samples(disc, scene, passes):
    scene.view_layers[0].use_pass_z = scene.view_layers[0].use_pass_normal = True
    scene.surfel_splatting.samples = 16
    made = {name.rpartition(".")[2]: values for name, values in passes().items()}
    alpha = made["Combined"][..., 3]
    np.testing.assert_allclose(made["Normal"][..., 2], alpha, atol=1e-5)
    np.testing.assert_allclose(made["Depth"][alpha > 0], 10, rtol=1e-5)
