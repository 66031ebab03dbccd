# SPDX-License-Identifier: GPL-3.0-or-later
"""A surfel object is drawn in colours of what was measured, and what it stores stays as it is."""

import bpy
import numpy as np
import pytest

from splat_addon.blender.export.live_meshes import LiveMeshes
from splat_addon.blender.export.scene import export_scene
from splat_addon.blender.export.surfel_store import SurfelStore
from splat_addon.interchange.scan_colors import GREYS, RAMP, of_classes, on_ramp

RED = (1.0, 0.0, 0.0, 0.5)
VALUES = np.array([2, 5, 6, 9, 3], np.int32)


@pytest.fixture
def scan(scene, add_surfels):
    """Five surfels in a column, which lie on their side, with a class each."""
    made = add_surfels([(0, z, 0) for z in range(5)], colors=RED)
    made.rotation_euler = np.pi / 2, 0, 0
    for name, kind in (("classification", "INT"), ("intensity", "FLOAT")):
        made.data.attributes.new(name, kind, "POINT").data.foreach_set("value", VALUES)
    return made


@pytest.fixture
def exported():
    """exported() -> the (N, 4) colours that are drawn, and the notes; the same store in each call."""
    store = SurfelStore()

    def export():
        store.begin_frame(None)
        depsgraph = bpy.context.evaluated_depsgraph_get()
        drawn, notes = export_scene(depsgraph, store, LiveMeshes())
        store.forget_unused()
        return drawn.surfels[0].surfels, notes.sentences()

    return export


def settings_of(made, **settings):
    for name, value in settings.items():
        setattr(made.surfel_splatting, name, value)


CHOICES = {
    "height": ({"color_by": "HEIGHT"}, on_ramp(np.arange(5.0), RAMP)),
    "height in a range": (
        {"color_by": "HEIGHT", "color_is_automatic": False, "color_from": 1.0, "color_to": 2.0},
        on_ramp(np.arange(5.0), RAMP, 1, 2),
    ),
    "intensity": ({"color_by": "INTENSITY"}, on_ramp(VALUES, GREYS)),
    "class": ({"color_by": "CLASSIFICATION"}, of_classes(VALUES)),
    "an attribute": ({"color_by": "ATTRIBUTE", "color_attribute": "intensity"}, on_ramp(VALUES, RAMP)),
}


@pytest.mark.parametrize("name", CHOICES)
def test_the_colors_show_what_is_chosen_and_nothing_stored_changes(name, scan, exported):
    settings, expected = CHOICES[name]
    before = exported()[0]
    settings_of(scan, **settings)
    drawn, notes = exported()
    np.testing.assert_allclose(drawn.colors[:, :3], expected, atol=1e-5)
    assert (drawn.colors[:, 3] == RED[3]).all() and not notes
    stored = np.empty(20, np.float32)
    scan.data.attributes["Col"].data.foreach_get("color", stored)
    assert np.array_equal(stored.reshape(5, 4), np.tile(np.float32(RED), (5, 1)))
    assert exported()[0] is drawn  # stays on the device
    settings_of(scan, color_by="COLOR")
    assert exported()[0] is before


def test_a_ramp_of_the_user_is_looked_up(scan, exported):
    texture = bpy.data.textures.new("ramp", "BLEND")
    texture.use_color_ramp = True
    for element, color in zip(texture.color_ramp.elements, ((0, 0, 0, 1), (0, 1, 0, 1)), strict=True):
        element.color = color
    settings_of(scan, color_by="INTENSITY", color_is_automatic=False, color_from=2, color_to=10, color_ramp=texture)
    np.testing.assert_allclose(exported()[0].colors[:, 1], (VALUES - 2) / 8, atol=0.005)
    texture.color_ramp.elements[1].color = 0, 0, 1, 1
    np.testing.assert_allclose(exported()[0].colors[:, 2], (VALUES - 2) / 8, atol=0.005)


def test_an_attribute_that_changes_is_read_again_and_unusable_surfels_are_passed_over(scan, exported):
    settings_of(scan, color_by="CLASSIFICATION")
    exported()
    scan.data.attributes["classification"].data[4].value = 9
    scan.data.attributes["scale"].data[1].vector = 0, 0, 0
    scan.data.update()
    np.testing.assert_allclose(exported()[0].colors[:, :3], of_classes(np.array([2, 6, 9, 9])), atol=1e-5)


def test_an_attribute_that_is_not_there_is_named_and_the_own_colors_stay(scan, exported):
    settings_of(scan, color_by="TIME")
    drawn, notes = exported()
    assert notes == [
        "surfels has no attribute 'gps_time' of one number per point to be coloured by, and keeps its own colours"
    ]
    np.testing.assert_allclose(drawn.colors, np.tile(RED, (5, 1)))
