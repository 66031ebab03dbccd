# SPDX-License-Identifier: GPL-3.0-or-later
"""Stray surfels are selected and stay until they are deleted."""

from dataclasses import replace

import bpy
import numpy as np
import pytest

from splat_addon.blender.geometry.attributes import write_surfels
from splat_addon.blender.geometry.stored_surfels import read_surfels


@pytest.fixture
def scan(random_surfels):
    """A sheet of 400 surfels with one in the air above it and one that is too large, active."""
    x, y = (axis.ravel() for axis in np.meshgrid(np.arange(20.0), np.arange(20.0)))
    places = np.concatenate([np.stack([x, y, 0 * x], axis=1), [(10, 10, 12)]])
    scales = np.ones((401, 2))
    scales[205] = 7
    surfels = replace(random_surfels(401), positions=places, scales=scales)
    made = bpy.data.objects.new("scan", write_surfels("scan", surfels))
    bpy.context.scene.collection.objects.link(made)
    bpy.context.view_layer.objects.active = made
    return made


def selected(made):
    """The numbers of the selected surfels, in edit mode."""
    bpy.ops.object.mode_set(mode="OBJECT")
    is_selected = np.empty(len(made.data.vertices), bool)
    made.data.vertices.foreach_get("select", is_selected)
    bpy.ops.object.mode_set(mode="EDIT")
    return np.flatnonzero(is_selected).tolist()


def test_strays_are_selected_and_then_may_be_deleted(scan):
    assert bpy.ops.object.surfels_select_strays() == {"FINISHED"}
    assert bpy.context.mode == "EDIT_MESH" and selected(scan) == [205, 400]
    assert bpy.ops.object.surfels_select_strays(strength=0.1) == {"FINISHED"} and selected(scan) == []
    assert len(scan.data.vertices) == 401
    bpy.ops.object.surfels_select_strays()
    bpy.ops.mesh.delete(type="VERT")
    bpy.ops.object.mode_set(mode="OBJECT")
    assert len(read_surfels(scan.data)[0]) == 399


def test_a_surfel_that_cannot_be_drawn_is_a_stray(scan):
    scan.data.attributes["scale"].data[3].vector = 0, 0, 0
    bpy.ops.object.surfels_select_strays()
    assert selected(scan) == [3, 205, 400]


def test_surfels_in_a_file_are_not_selected_as_pictures_would_keep_them(scan):
    scan.data.surfel_splatting.file = "//scan.surfelblocks"
    assert not bpy.ops.object.surfels_select_strays.poll()
