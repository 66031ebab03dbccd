# SPDX-License-Identifier: GPL-3.0-or-later
"""A render border shows the pixels that the whole picture has there, and has the size that Blender expects."""

import numpy as np
import pytest

#: left, right, bottom, top: the last two in float32 times 10 pixels are whole, in float64 they are not
BORDERS = [(0.25, 0.75, 0.5, 1.0), (0.123, 0.457, 0.211, 0.983), (0.1, 0.7, 0.3, 0.9), (0.7, 0.9, 0.0, 0.7)]
SIZES = [(64, 64), (50, 70), (10, 10), (53, 61)]


@pytest.fixture
def garden(scene, add_camera, add_surfels):
    """Surfels of random colours all over the picture, in front of a grey world."""
    random = np.random.default_rng(3)
    add_camera((0, 0, 8), (0.1, 0.2, 0.3))
    colors = np.concatenate([random.uniform(size=(300, 3)), np.ones((300, 1))], axis=1)
    add_surfels(random.uniform(-4, 4, (300, 3)), random.normal(size=(300, 3)), 0.5, colors)
    scene.render.film_transparent = False


@pytest.fixture
def set_frame(scene):
    """set_frame(size, percentage, border, crop) sets the render's size; without a border the whole frame is
    rendered.
    """

    def apply(size, percentage=100, border=None, crop=False):
        render = scene.render
        render.resolution_x, render.resolution_y, render.resolution_percentage = *size, percentage
        render.use_border, render.use_crop_to_border = border is not None, crop
        left, right, bottom, top = border or (0, 1, 0, 1)
        render.border_min_x, render.border_max_x, render.border_min_y, render.border_max_y = left, right, bottom, top

    return apply


@pytest.mark.parametrize("border", BORDERS)
@pytest.mark.parametrize("size", SIZES)
def test_a_border_shows_what_the_whole_picture_does_there(size, border, garden, set_frame, picture):
    set_frame(size)
    whole = picture()
    set_frame(size, border=border)
    inside = picture()
    shown = inside[..., 3] > 0
    assert inside.shape == whole.shape and 0 < shown.sum() < shown.size
    assert np.count_nonzero(np.abs(inside - whole).max(axis=2)[shown] > 1e-4) <= 1 + shown.sum() // 500


@pytest.mark.parametrize("border", BORDERS)
@pytest.mark.parametrize("size", SIZES)
def test_a_crop_is_the_border_alone(size, border, garden, set_frame, picture):
    set_frame(size, border=border)
    inside = picture()
    set_frame(size, border=border, crop=True)
    rows, columns = np.nonzero(inside[..., 3])
    assert np.array_equal(picture(), inside[rows.min() : rows.max() + 1, columns.min() : columns.max() + 1])


def test_every_border_has_the_size_that_blender_expects(garden, set_frame, picture):
    """If the size were wrong, Blender would leave the frame empty without a message."""
    random = np.random.default_rng(1)
    for _ in range(40):
        (left, right), (bottom, top) = np.sort(random.integers(0, 20, (2, 2)) / 20, axis=1)
        set_frame(random.integers(60, 120, 2), border=(left, right + 0.05, bottom, top + 0.05), crop=True)
        assert picture()[..., 3].min() == 1


@pytest.mark.parametrize("percentage", [29, 57, 58, 99])
def test_every_percentage_has_the_size_that_blender_expects(percentage, garden, set_frame, picture):
    set_frame((100, 200), percentage)
    shown = picture()
    assert shown.shape[:2] == (2 * percentage, percentage) and shown[..., 3].min() == 1
