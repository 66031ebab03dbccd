# SPDX-License-Identifier: GPL-3.0-or-later
"""For every kind of camera a surfel appears where Blender's own `world_to_camera_view` puts it."""

import bpy
import numpy as np
import pytest
from bpy_extras.object_utils import world_to_camera_view
from mathutils import Vector

RADIUS = 3  # of a surfel's disc, pixels
CAMERAS = {
    "perspective": {},
    "wide angle": {"lens": 8},
    "orthographic": {"type": "ORTHO", "ortho_scale": 7},
    "shifted": {"shift_x": 0.3, "shift_y": -0.2},
    "shifted orthographic": {"type": "ORTHO", "ortho_scale": 7, "shift_x": -0.25, "shift_y": 0.4},
    "sensor fit horizontal": {"sensor_fit": "HORIZONTAL", "sensor_width": 20},
    "sensor fit vertical": {"sensor_fit": "VERTICAL", "sensor_height": 15},
}
#: width, height, percentage, horizontal and vertical pixel aspect
PICTURES = {
    "square": (64, 64, 100, 1, 1),
    "wide": (96, 48, 100, 1, 1),
    "tall": (48, 96, 100, 1, 1),
    "wide pixels": (64, 64, 100, 2, 1),
    "tall pixels": (64, 64, 100, 1, 1.5),
    "half of twice the size": (192, 96, 50, 1, 1),
}


@pytest.fixture
def camera(add_camera):
    return lambda **properties: add_camera((3, -4, 2), (1.1, 0.2, 0.7), **properties)


@pytest.mark.parametrize("kind", CAMERAS)
@pytest.mark.parametrize("form", ["square", "wide", "tall"])
def test_surfels_are_where_blender_projects_them(kind, form, scene, camera, assert_in_place):
    set_size(scene, *PICTURES[form])
    camera(**CAMERAS[kind])
    assert_in_place()


@pytest.mark.parametrize("kind", ["perspective", "shifted orthographic"])
@pytest.mark.parametrize("form", ["wide pixels", "tall pixels", "half of twice the size"])
def test_pixel_aspect_and_percentage_keep_surfels_in_place(kind, form, scene, camera, assert_in_place):
    set_size(scene, *PICTURES[form])
    camera(**CAMERAS[kind])
    assert_in_place()


@pytest.mark.parametrize("kind", ["perspective", "orthographic"])
def test_a_camera_with_a_scaled_parent_keeps_surfels_in_place(kind, scene, camera, assert_in_place):
    set_size(scene, *PICTURES["wide"])
    parent = bpy.data.objects.new("parent", None)
    parent.location, parent.rotation_euler, parent.scale = (1, 2, -1), (0.3, 0.5, -0.2), (2, 2, 2)
    scene.collection.objects.link(parent)
    camera(**CAMERAS[kind]).parent = parent
    assert_in_place()


def test_the_active_camera_of_several_is_looked_through(scene, camera, add_camera, assert_in_place):
    used = camera()
    add_camera((9, 9, 9))
    scene.camera = used
    set_size(scene, *PICTURES["wide"])
    assert_in_place()


def set_size(scene, width, height, percentage, aspect_x, aspect_y):
    scene.render.resolution_x, scene.render.resolution_y = width, height
    scene.render.resolution_percentage = percentage
    scene.render.pixel_aspect_x, scene.render.pixel_aspect_y = aspect_x, aspect_y


@pytest.fixture
def assert_in_place(scene, add_surfels, picture):
    """Render discs at random places and compare each one's centre with the projected one, within 0.08 pixels."""

    def check():
        bpy.context.view_layer.update()
        scene.surfel_splatting.supersampling = 4
        share = scene.render.resolution_percentage / 100
        size = np.array([scene.render.resolution_x, scene.render.resolution_y]) * share
        to_world = scene.camera.matrix_world.normalized()
        places, predicted, sizes = [], [], []
        for place in np.random.default_rng(5).uniform((-9, -9, -15), (9, 9, -4), (600, 3)):
            pixel = project(scene, to_world @ Vector(place)) * size
            apart = all(np.abs(pixel - other).max() > 4 * RADIUS for other in predicted)
            if apart and (pixel > 2 * RADIUS).all() and (pixel < size - 2 * RADIUS).all():
                beside = project(scene, to_world @ Vector(place + 1e-2)) * size
                places.append(to_world @ Vector(place))
                predicted.append(pixel)
                sizes.append(1e-2 * RADIUS / np.abs(beside - pixel).max())
        assert len(places) > 4
        add_surfels(places, to_world.to_3x3() @ Vector((0, 0, 1)), np.array(sizes)[:, None])
        alpha = picture()[..., 3]
        assert alpha.shape == (size[1], size[0])
        assert np.abs([centroid(alpha, pixel) - pixel for pixel in predicted]).max() < 0.08

    return check


def project(scene, place) -> np.ndarray:
    """The (2,) float64 position of a point in the picture, from 0 to 1."""
    return np.array(world_to_camera_view(scene, scene.camera, place)[:2])


def centroid(alpha: np.ndarray, around: np.ndarray) -> np.ndarray:
    """The (2,) centre, in pixels, of what is drawn within 2 radii of a place."""
    y, x = np.indices(alpha.shape) + 0.5
    weight = alpha * (np.maximum(np.abs(x - around[0]), np.abs(y - around[1])) < 2 * RADIUS)
    return np.array([(x * weight).sum(), (y * weight).sum()]) / weight.sum()
