# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfels follow their source, replace it in the picture, can be converted again, and restore it when deleted."""

import bpy
import numpy as np
import pytest
from mathutils import Euler, Matrix, Vector

PLACE = Matrix.LocRotScale((0.5, -1, 2), Euler((0.4, 0.8, 0.2)), (1.5, 0.7, 1.1))


@pytest.fixture
def square(add_square):
    return add_square("Square")


def update(*made):
    for owner in bpy.context.selected_objects:
        owner.select_set(False)
    for owner in made:
        owner.select_set(True)
    return bpy.ops.object.surfels_update()


def add_turned(square):
    """A parent that is turned and unevenly scaled, so that it shears its children."""
    parent = bpy.data.objects.new("parent", None)
    bpy.context.collection.objects.link(parent)
    parent.scale, square.rotation_euler = (1, 2, 0.5), (0.5, 0.3, 0.7)
    square.parent = parent
    return parent


@pytest.mark.parametrize("kind", ["plain", "sheared", "curve", "instancer"])
def test_surfels_go_where_their_source_goes(kind, square, convert, world_positions, add_mesh):
    mover = square
    if kind == "sheared":
        mover = add_turned(square)
    elif kind == "curve":
        square.select_set(False)
        bpy.ops.curve.primitive_bezier_circle_add()
        mover = bpy.context.object
        mover.data.dimensions, mover.data.fill_mode = "2D", "BOTH"
    elif kind == "instancer":
        square.instance_type = "VERTS"
    bpy.context.view_layer.update()
    (made,) = convert(resolution=8)
    before, was = world_positions(made), mover.matrix_world.copy()
    mover.matrix_world = PLACE @ was
    bpy.context.view_layer.update()
    moved = np.array(PLACE)
    assert np.abs(world_positions(made) - (before @ moved[:3, :3].T + moved[:3, 3])).max() < 1e-5


def test_they_have_its_origin(add_mesh, convert):
    """The surfel object's origin is the source's, not the middle of the surfels."""
    add_mesh("Aside", [(2, 0, 0), (3, 0, 0), (3, 1, 0), (2, 1, 0)], [(0, 1, 2, 3)])
    (made,) = convert(resolution=8)
    bpy.context.view_layer.update()
    assert made.matrix_world.translation == Vector((0, 0, 0))


def test_far_away_they_lie_as_exactly_as_before(square, convert, world_positions):
    square.matrix_world = Matrix.Translation((1e6, -1e6, 0)) @ Matrix.Rotation(0.7, 4, "Z")
    bpy.context.view_layer.update()
    (frozen,) = convert(resolution=64, follow=False)
    square.select_set(True)
    (made,) = convert(resolution=64)
    assert made.parent == square
    assert np.abs(world_positions(made) - world_positions(frozen)).max() < 1e-9


def test_a_frozen_copy_stays(square, convert, world_positions):
    (made,) = convert(resolution=8, follow=False)
    before = world_positions(made)
    square.location = (1, 2, 3)
    assert np.array_equal(world_positions(made), before)


def hide_first(source):
    for frame, is_hidden in ((1, True), (10, False)):
        for path in ("hide_render", "hide_viewport"):
            setattr(source, path, is_hidden)
            source.keyframe_insert(path, frame=frame)


@pytest.mark.parametrize("source", ["KEEP", "HIDE"])
@pytest.mark.parametrize("is_animated", ["before", "after"])
def test_they_are_hidden_when_their_source_is(is_animated, source, square, convert):
    if is_animated == "before":
        hide_first(square)
    (made,) = convert(resolution=8, source=source)
    if is_animated == "after":
        hide_first(square)
        update(made)
        update(made)
    seen = {}
    for frame in (1, 9, 10):
        bpy.context.scene.frame_set(frame)
        seen[frame] = not made.hide_render and not made.hide_viewport
    assert seen == {1: False, 9: False, 10: True}


def hide_another(source):
    """An object that uses the source's action is hidden by it."""
    other = bpy.data.objects.new("other", None)
    hide_first(other)
    action = other.animation_data.action
    source.animation_data_create().action = action
    source.animation_data.action_slot = action.slots.new("OBJECT", source.name)
    source.keyframe_insert("location", frame=1)


def hide_no_more(source):
    hide_first(source)
    (bag,) = source.animation_data.action.layers[0].strips[0].channelbags
    for curve in bag.fcurves:
        curve.mute = True


@pytest.mark.parametrize("animate", [hide_another, hide_no_more])
def test_they_stay_visible_if_nothing_hides_their_source(animate, square, convert):
    """The conversion itself has hidden the source, and no animation shows it again."""
    animate(square)
    (made,) = convert(resolution=8, source="HIDE")
    for frame in (1, 10):
        bpy.context.scene.frame_set(frame)
        assert square.hide_render and not made.hide_render


def test_a_frozen_copy_is_not_hidden(square, convert):
    hide_first(square)
    (made,) = convert(resolution=8, follow=False)
    bpy.context.scene.frame_set(1)
    assert not made.hide_render
    square.hide_viewport = False  # it can be converted while renders do not show it
    square.select_set(True)
    (second,) = set(convert(resolution=8, follow=False)) - {made}
    assert not second.hide_render


def test_joined_surfels_are_not_hidden_with_one_of_their_sources(square, add_square, convert, capfd):
    hide_first(square)
    add_square("Other")
    square.select_set(True)
    (made,) = convert(resolution=8, join=True)
    bpy.context.scene.frame_set(1)
    assert not made.hide_render
    assert "Warning: When 'Square' is hidden, its joined surfels stay visible" in capfd.readouterr().out


def test_without_their_source_they_stay(square, convert, world_positions):
    square.location = (1, 2, 3)
    bpy.context.view_layer.update()
    (made,) = convert(resolution=8)
    before = world_positions(made)
    bpy.data.objects.remove(square)
    assert np.abs(world_positions(made) - before).max() < 1e-6


def test_render_levels_are_sampled(square, convert, surfels_of):
    """A square becomes rounder and smaller with each level of subdivision, so its surfels show the level."""
    modifier = square.modifiers.new("subdivision", "SUBSURF")
    modifier.levels, modifier.render_levels = 0, 4
    hidden = square.modifiers.new("wave", "DISPLACE")
    hidden.show_viewport, hidden.show_render, hidden.strength, hidden.mid_level = True, False, 5, 0
    (made,) = convert(density="SPACING", spacing=0.02)
    assert (modifier.levels, hidden.show_viewport) == (0, True)
    positions = surfels_of(made).positions
    assert np.ptp(positions[:, 2]) < 0.1
    assert np.linalg.norm(positions[:, :2] - 0.5, axis=1).max() < 0.6


def test_deleted_surfels_bring_back_a_hidden_source(square, convert):
    convert(resolution=8, source="HIDE")
    bpy.context.view_layer.update()
    assert square.hide_get() and square.hide_render
    bpy.ops.object.delete()
    bpy.context.view_layer.update()
    assert "Square surfels" not in bpy.data.objects
    assert not square.hide_get() and not square.hide_render


def test_a_source_that_was_disabled_in_renders_stays_so(square, convert):
    square.hide_render = True
    made = convert(resolution=8, source="HIDE")
    square.hide_set(False)
    square.select_set(True)
    made += convert(resolution=8, source="HIDE")
    for each in made:
        bpy.data.objects.remove(each)
    bpy.context.view_layer.update()
    assert not square.hide_get() and square.hide_render


@pytest.mark.parametrize("source", ["KEEP", "HIDE"])
def test_surfels_of_a_source_that_renders_leave_out_are_left_out(square, convert, source, capfd):
    """Such as the cutter of a Boolean, which would fill the hole that it cuts."""
    square.hide_render, square.display_type = True, "WIRE"
    (first,) = convert(resolution=8, source=source)
    square.hide_set(False)
    square.select_set(True)
    (second,) = set(convert(resolution=8, source=source)) - {first}
    assert all(made.hide_render and made.display_type == "WIRE" for made in (first, second))
    assert "'Square surfels' is disabled in renders, as its source is" in capfd.readouterr().out


def test_surfels_of_a_source_that_only_a_conversion_hid_are_rendered(square, convert):
    convert(resolution=8, source="HIDE")
    square.hide_set(False)
    square.select_set(True)
    assert not any(made.hide_render for made in convert(resolution=8, source="HIDE"))


def test_joined_surfels_are_rendered_if_one_of_their_sources_is(square, add_square, convert):
    square.hide_render = True
    add_square("other")
    square.select_set(True)
    (made,) = convert(resolution=8, join=True)
    assert not made.hide_render


def test_surfels_that_are_swapped_for_another_object_bring_back_their_source(square, convert):
    (made,) = convert(resolution=8, source="HIDE")
    bpy.context.view_layer.update()
    bpy.data.objects.remove(made)
    bpy.context.collection.objects.link(bpy.data.objects.new("other", None))
    bpy.context.view_layer.update()
    assert not square.hide_get() and not square.hide_render


def test_it_stays_hidden_while_others_of_its_surfels_are_there(square, convert):
    (first,) = convert(resolution=8)
    square.select_set(True)
    (second,) = convert(resolution=8, source="HIDE")
    bpy.data.objects.remove(second)
    bpy.context.view_layer.update()
    assert square.hide_render
    bpy.data.objects.remove(first)
    bpy.context.view_layer.update()
    assert not square.hide_render


def test_an_update_is_as_dense_as_the_script_s_number_said(square, convert):
    (made,) = convert(resolution=8)
    count = len(made.data.vertices)
    assert update(made) == {"FINISHED"} and len(made.data.vertices) == count


def test_an_update_takes_the_source_as_it_is_now(square, convert, surfels_of):
    (made,) = convert(resolution=8, source="HIDE")
    square.data.vertices[2].co = square.data.vertices[3].co = (0, 3, 0)
    made.location.x += 0.25
    place = made.matrix_basis.copy()
    assert update(made) == {"FINISHED"}
    assert surfels_of(made).positions[:, 1].max() > 2
    assert square.hide_get() and square.hide_render and made.matrix_basis == place
    assert [o.name for o in bpy.data.objects if o.type == "MESH"] == ["Square", "Square surfels"]


def test_an_update_has_the_settings_of_the_first_time(square, convert, surfels_of):
    (made,) = convert(density="COUNT", count=900, splat_size=1.5)
    before = surfels_of(made)
    assert update(made) == {"FINISHED"}
    after = surfels_of(made)
    assert len(after) == len(before) and np.array_equal(after.scales, before.scales)


def test_points_are_updated_too(add_mesh, surfels_of):
    grid = [(x / 9, y / 9, 0) for x in range(10) for y in range(10)]
    points = add_mesh("Points", grid, [])
    bpy.ops.object.surfels_from_points()
    made = bpy.context.object
    assert points.hide_get() and points.hide_render
    points.data.vertices.add(1)
    points.data.vertices[100].co = (0.05, 0.05, 0.05)
    assert update(made) == {"FINISHED"}
    assert len(surfels_of(made)) == 101


def test_a_source_out_of_the_scene_is_named(square, convert):
    (made,) = convert(resolution=8)
    bpy.context.collection.objects.unlink(square)
    with pytest.raises(RuntimeError, match="Its source 'Square' is not in this view layer"):
        update(made)


def test_the_operator_may_be_adjusted_when_its_surfels_are_selected(square, convert):
    """Blender checks the operator's poll while the surfels still exist, before it undoes the conversion."""
    convert(resolution=8)
    assert bpy.ops.object.surfels_from_mesh.poll()
    bpy.ops.object.select_all(action="DESELECT")
    assert not bpy.ops.object.surfels_from_mesh.poll()
