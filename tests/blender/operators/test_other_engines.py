# SPDX-License-Identifier: GPL-3.0-or-later
"""Other engines show a source, or its surfels as points where it is hidden or gone, and never points over it."""

import bpy
import numpy as np
import pytest


def size_of_points(made: bpy.types.Object) -> float:
    """The largest radius of a surfel object's points as other engines have them."""
    bpy.context.view_layer.update()
    geometry = made.evaluated_get(bpy.context.evaluated_depsgraph_get()).evaluated_geometry()
    radii = np.empty(len(geometry.pointcloud.points), np.float32)
    geometry.pointcloud.attributes["radius"].data.foreach_get("value", radii)
    return float(radii.max())


@pytest.mark.parametrize(
    "hide",
    [
        lambda cube: cube.hide_set(True),
        lambda cube: setattr(cube, "hide_viewport", True),
        lambda cube: setattr(cube, "hide_render", True),
        lambda cube: bpy.data.objects.remove(cube),
    ],
    ids=["in the view layer", "in views", "in renders", "gone"],
)
def test_points_are_seen_only_where_the_source_is_not(cube, convert, hide):
    (made,) = convert(resolution=8)
    assert size_of_points(made) == 0
    hide(cube)
    bpy.context.view_layer.update()  # which tells the handler, whose change is evaluated next
    assert size_of_points(made) > 0


@pytest.mark.parametrize("follow", [True, False])
def test_a_copy_that_stands_elsewhere_is_seen(cube, convert, follow):
    cube.location, cube.rotation_euler, cube.scale = (1, 2, 3), (0.3, 0.2, 0.1), (1, 2, 0.5)
    bpy.context.view_layer.update()
    (made,) = convert(resolution=8, follow=follow, space="WORLD")
    assert size_of_points(made) == 0
    cube.location.x = 5  # which takes those along that follow
    bpy.context.view_layer.update()
    assert (size_of_points(made) == 0) == follow
    made.location.y += 1
    bpy.context.view_layer.update()
    assert size_of_points(made) > 0


def test_a_source_that_is_shown_again_hides_them(cube, convert):
    (made,) = convert(resolution=8, source="HIDE")
    assert size_of_points(made) > 0
    bpy.ops.object.surfels_or_source(shown="SOURCE")
    bpy.ops.object.surfels_or_source(shown="SURFELS")
    assert size_of_points(made) > 0
    cube.hide_set(False)
    cube.hide_render = False
    bpy.context.view_layer.update()
    assert size_of_points(made) == 0
