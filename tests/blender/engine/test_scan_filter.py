# SPDX-License-Identifier: GPL-3.0-or-later
"""A modifier leaves out surfels beyond a box, of some classes, or closer together than a spacing."""

import bpy
import numpy as np
import pytest

from splat_addon.blender.geometry.node_groups import give
from splat_addon.blender.geometry.world_surfels import world_surfels
from splat_addon.blender.ids import FILTER_GROUP


@pytest.fixture
def scan(scene, add_sheet):
    """40 by 40 surfels over a square from -1 to 1, 0.05 apart, whose class is their column's number."""
    made = add_sheet()
    made.location = 5, 0, 0
    bpy.context.view_layer.objects.active = made
    made.data.attributes.new("classification", "INT", "POINT").data.foreach_set(
        "value", np.tile(np.arange(40, dtype=np.int32), 40)
    )
    assert bpy.ops.object.surfels_filter() == {"FINISHED"}
    return made


@pytest.fixture
def shown(scan):
    """shown(**inputs) -> the surfels that are left, in the object's place."""

    def show(**inputs):
        for name, value in inputs.items():
            give(scan.modifiers[FILTER_GROUP], name.replace("_", " "), value)
        scan.update_tag()
        depsgraph = bpy.context.evaluated_depsgraph_get()
        (surfels,), unusable = world_surfels([scan], depsgraph)
        assert not unusable and len(scan.data.vertices) == 1600
        return surfels, surfels.positions + surfels.origin - (5, 0, 0)

    return show


def test_at_first_the_box_holds_everything(shown, scan):
    assert len(shown()[0]) == 1600
    assert scan.modifiers[0].name == FILTER_GROUP and scan.modifiers[-1].use_pin_to_last


def test_the_box_crops_where_it_is_turned_and_moved(shown, scan):
    (box,) = scan.children
    box.location, box.scale, box.rotation_euler = (0.5, 0, 0), (0.3, 0.3, 1), (0, 0, np.pi / 4)
    bpy.context.view_layer.update()
    inside = shown()[1]
    along = np.abs(inside[:, 0] - 0.5) + np.abs(inside[:, 1])
    assert along.max() < 0.3 * np.sqrt(2) + 1e-5 and len(inside) == pytest.approx(0.36 / 0.05**2, rel=0.1)
    outside = shown(Keep_Outside=True)[1]
    assert len(inside) + len(outside) == 1600
    assert len(shown(Crop=False)[0]) == 1600


def test_classes_are_hidden(shown):
    def classes(**inputs):
        return sorted(set(np.rint(shown(**inputs)[1][:, 0] / 0.05 + 19.5).astype(int)))

    assert classes(Vegetation=False, Noise=False) == [0, 1, 2, 6, *range(8, 18), *range(19, 40)]
    assert classes(Vegetation=True, Noise=True, Other_Classes=False) == [0, 1, 2, 3, 4, 5, 6, 7, 9, 18]


def test_one_surfel_is_left_in_each_cell_of_the_spacing_and_covers_it(shown):
    surfels, places = shown(Spacing=0.2)
    cells = np.unique(np.floor(places / np.float32(0.2)).astype(int), axis=0)
    assert len(surfels) == len(cells) and 100 <= len(cells) <= 144
    assert (surfels.scales >= 0.2).all()
    assert len(shown(Spacing=0.0)[0]) == 1600
