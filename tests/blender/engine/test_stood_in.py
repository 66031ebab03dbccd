# SPDX-License-Identifier: GPL-3.0-or-later
"""A source is not drawn as long as its surfels are in the scene."""

import bpy
import numpy as np
import pytest


@pytest.fixture
def square(add_camera, add_square):
    add_camera()
    return add_square()


def test_a_converted_object_is_not_drawn_beside_its_surfels(square, convert, picture):
    (made,) = convert(resolution=8)
    made.hide_render = True
    assert not picture().any()


def test_it_is_drawn_again_without_them(square, convert, picture):
    before = picture()
    (made,) = convert(resolution=8)
    bpy.data.objects.remove(made)
    assert np.array_equal(picture(), before)


def test_it_is_drawn_beside_them_where_that_is_chosen(square, convert, picture):
    before = picture()
    (made,) = convert(resolution=8)
    made.hide_render, square.surfel_splatting.render_as = True, "POLYGONS"
    assert np.array_equal(picture(), before)
