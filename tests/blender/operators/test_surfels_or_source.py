# SPDX-License-Identifier: GPL-3.0-or-later
"""Source | Surfels: one of them is seen, in views and in renders; and Update is there for either of them."""

import bpy
import pytest


def seen(owner: bpy.types.Object) -> tuple[bool, bool]:
    """Whether an object is seen in views, and in renders."""
    return not owner.hide_get(), not owner.hide_render


@pytest.mark.parametrize("source", ["KEEP", "HIDE"])
def test_surfels_and_their_source_take_turns(cube, convert, source):
    (made,) = convert(resolution=8, source=source)
    before = seen(made), seen(cube)
    bpy.ops.object.surfels_or_source(shown="SOURCE")
    assert (seen(made), seen(cube)) == ((False, False), (True, True))
    assert bpy.context.selected_objects == [cube] == [bpy.context.active_object]
    bpy.ops.object.surfels_or_source(shown="SURFELS")
    assert (seen(made), seen(cube)) == before
    assert made.select_get() and bpy.context.active_object == made


def test_a_source_that_is_never_rendered_has_surfels_that_are_not(cube, convert):
    cube.hide_render = True
    (made,) = convert(resolution=8, source="HIDE")
    for shown in ("SOURCE", "SURFELS"):
        bpy.ops.object.surfels_or_source(shown=shown)
        assert cube.hide_render and made.hide_render


@pytest.mark.parametrize("mode", ["OBJECT", "EDIT", "SCULPT", "VERTEX_PAINT"])
def test_a_source_is_selected_and_edited_while_its_surfels_are_updated(cube, convert, mode):
    (made,) = convert(resolution=8, density="RESOLUTION", use_adaptive=False)
    count = len(made.data.vertices)
    bpy.ops.object.select_all(action="DESELECT")
    cube.select_set(True)
    bpy.context.view_layer.objects.active = cube
    made.surfel_record.mesh.resolution = 16
    bpy.ops.object.mode_set(mode=mode)
    assert bpy.ops.object.surfels_update() == {"FINISHED"}
    assert cube.mode == mode and len(made.data.vertices) == pytest.approx(4 * count, rel=0.2)


def test_what_has_no_surfels_is_not_asked_for(cube):
    assert not bpy.ops.object.surfels_or_source.poll() and not bpy.ops.object.surfels_update.poll()
