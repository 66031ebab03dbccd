# SPDX-License-Identifier: GPL-3.0-or-later
"""A source is not drawn as long as its surfels are in the scene."""

import bpy
import numpy as np
import pytest

from splat_addon.blender.engine import final_render


@pytest.fixture
def square(add_camera, add_square):
    add_camera()
    return add_square()


def test_a_converted_object_is_not_drawn_beside_its_surfels(square, convert, picture):
    convert(resolution=8)
    assert picture().any()
    drawn = final_render.last_frame_stats
    assert drawn["splats_drawn"] > 0 and drawn["polygons"] == 0


@pytest.mark.parametrize("how", ["hide_render", "collection"])
def test_it_is_drawn_again_while_its_surfels_are_hidden(square, convert, picture, scene, how):
    """Their parent stays in the depsgraph, although it is hidden."""
    before = picture()
    (made,) = convert(resolution=8)
    bpy.data.objects.new("child", None).parent = made
    scene.collection.objects.link(bpy.data.objects["child"])
    if how == "hide_render":
        made.hide_render = True
    else:
        hidden = bpy.data.collections.new("hidden")
        scene.collection.children.link(hidden)
        for each in made.users_collection:
            each.objects.unlink(made)
        hidden.objects.link(made)
        bpy.context.view_layer.layer_collection.children["hidden"].exclude = True
    assert np.array_equal(picture(), before)


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


def test_neither_is_one_of_a_background_scene(square, scene, convert, tmp_path):
    """Renders show the objects of a background scene as if they were in the scene."""
    convert(resolution=8)
    shot = bpy.data.scenes.new("shot")
    shot.background_set, shot.camera, shot.render.engine = scene, scene.camera, scene.render.engine
    shot.render.filepath = str(tmp_path / "shot.png")
    shot.render.resolution_x = shot.render.resolution_y = 16
    bpy.ops.render.render(write_still=True, scene=shot.name)
    drawn = final_render.last_frame_stats
    assert drawn["splats_drawn"] > 0 and drawn["polygons"] == 0


def test_what_other_engines_see_of_surfels_changes_no_picture(square, convert, picture):
    (made,) = convert(resolution=8)
    groups, pictures = [made.modifiers[0].node_group], [picture()]
    square.hide_set(True)
    bpy.context.view_layer.update()
    groups.append(made.modifiers[0].node_group)
    assert groups[0] != groups[1] and np.array_equal(pictures[0], picture())
