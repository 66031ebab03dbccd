# SPDX-License-Identifier: GPL-3.0-or-later
"""Whatever changes between two renders, the second picture shows the scene in its new state."""

import bpy
import numpy as np
import pytest

LEFT, RIGHT = np.s_[:, :16], np.s_[:, 16:]


@pytest.fixture
def surfels(add_camera, add_surfels, picture):
    """An object with one surfel on the left, which has been rendered once."""
    add_camera()
    made = add_surfels([(-2, 0, 0)], size=1)
    drawn = picture()[..., 3]
    assert drawn[LEFT].any() and not drawn[RIGHT].any()
    return made


def test_an_edited_position_is_seen(surfels, picture):
    surfels.data.attributes["position"].data[0].vector = (2, 0, 0)
    drawn = picture()[..., 3]
    assert drawn[RIGHT].any() and not drawn[LEFT].any()


def test_an_edited_colour_is_seen(surfels, picture):
    surfels.data.attributes["Col"].data[0].color = (0.25, 0.5, 0.75, 1)
    assert np.allclose(picture()[16, 9], (0.25, 0.5, 0.75, 1))


def test_another_mesh_in_the_object_is_seen(surfels, add_surfels, picture):
    other = add_surfels([(2, 0, 0)], size=1)
    surfels.data = other.data
    bpy.data.objects.remove(other)
    drawn = picture()[..., 3]
    assert drawn[RIGHT].any() and not drawn[LEFT].any()


def test_a_mesh_replaced_by_one_of_the_same_name_is_seen(surfels, add_surfels, picture):
    other = add_surfels([(2, 0, 0)], size=1).data
    name, old = surfels.data.name, surfels.data
    surfels.data = other
    bpy.data.meshes.remove(old)
    other.name = name
    drawn = picture()[..., 3]
    assert drawn[RIGHT].any() and not drawn[LEFT].any()


def test_a_removed_object_is_gone(surfels, picture):
    bpy.data.objects.remove(surfels)
    assert not picture().any()


def test_another_size_is_rendered_in_that_size(surfels, scene, picture):
    scene.render.resolution_x = scene.render.resolution_y = 48
    drawn = picture()[..., 3]
    assert drawn.shape == (48, 48) and drawn[:, :24].any() and not drawn[:, 24:].any()


def test_another_scene_of_the_file_is_rendered_as_itself(surfels, scene, picture):
    other = scene.copy()
    other.collection.objects.unlink(surfels)
    bpy.ops.render.render(write_still=True, scene=other.name)
    assert bpy.data.images.load(scene.render.filepath).pixels[:] == (0.0,) * (32 * 32 * 4)
