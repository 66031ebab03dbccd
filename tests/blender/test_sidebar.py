# SPDX-License-Identifier: GPL-3.0-or-later
"""The Surfels tab leads: a status line, one large button for what is selected, and what is shown come first and keep
their place; then come the settings that the button uses."""

from types import SimpleNamespace
from unittest.mock import MagicMock

import bpy
import numpy as np
import pytest

from splat_addon.blender.conversion import made_of, prediction
from splat_addon.blender.conversion.density_reason import Reason, sentences
from splat_addon.blender.ids import (
    SHOW_SURFELS,
    SURFELS_FROM_MESH,
    SURFELS_FROM_POINTS,
    SURFELS_OR_SOURCE,
    UPDATE_SURFELS,
)
from splat_addon.blender.ui import chosen as chosen_module
from splat_addon.blender.ui.sidebar import VIEW3D_PT_surfels


class Layout:
    """Records what is drawn, in its order: texts, properties, and whether each operator's button is enabled."""

    def __init__(self, drawn=None, enabled=True):
        self.drawn = drawn or SimpleNamespace(order=[], texts=[], properties=[], buttons={}, parts=[], closed=True)
        self.enabled = enabled

    def row(self, **_):
        return Layout(self.drawn, self.enabled)

    column = box = row

    def label(self, text, icon="NONE"):
        self.drawn.order.append("label")
        self.drawn.texts.append(text)

    def prop(self, owner, name, **_):
        assert name in owner.bl_rna.properties
        self.drawn.order.append(name)
        self.drawn.properties.append(name)

    def prop_enum(self, owner, name, value):
        assert value in owner.bl_rna.properties[name].enum_items
        self.drawn.order.append(value)

    def operator(self, name, **_):
        self.drawn.order.append(name)
        self.drawn.buttons[name] = self.enabled
        return MagicMock()

    def panel(self, name, default_closed):
        self.drawn.parts.append((name, default_closed))
        return self.row(), None if self.drawn.closed else self.row()


@pytest.fixture
def drawn():
    """drawn(is_open) -> what the tab shows now. is_open: whether its closed parts are."""

    def draw(is_open=False):
        layout = Layout()
        layout.drawn.closed = not is_open
        VIEW3D_PT_surfels.draw(SimpleNamespace(layout=layout), bpy.context)
        return layout.drawn

    return draw


@pytest.fixture
def scan():
    """A mesh of points without faces, selected and active."""
    mesh = bpy.data.meshes.new("scan")
    mesh.from_pydata(np.random.default_rng(1).normal(size=(50, 3)).tolist(), [], [])
    made = bpy.data.objects.new("scan", mesh)
    bpy.context.scene.collection.objects.link(made)
    made.select_set(True)
    bpy.context.view_layer.objects.active = made
    bpy.context.view_layer.update()
    return made


FIRST = ["label", None, SHOW_SURFELS, SURFELS_OR_SOURCE, SURFELS_OR_SOURCE]
F12 = "Meshes need no conversion: choose the engine and press F12"


def leads(shown, button, is_enabled=True):
    """Whether these come first, in this order, and the button is enabled."""
    first = [button if each is None else each for each in FIRST]
    return shown.order[: len(FIRST)] == first and shown.buttons[button] == is_enabled


def test_nothing_selected_is_said(drawn):
    shown = drawn()
    assert shown.texts[0] == "Select a mesh or a scan" and F12 in " ".join(shown.texts)
    assert leads(shown, SURFELS_FROM_MESH, is_enabled=False)


def test_a_mesh_can_be_converted(cube, drawn):
    shown = drawn()
    assert leads(shown, SURFELS_FROM_MESH) and F12 in " ".join(shown.texts)
    assert shown.texts[0] == f"No surfels of {cube.name} yet"
    assert shown.order.index("DRAFT") < shown.order.index("follow") < shown.order.index("texture_mapped")
    assert shown.parts == [("surfels_edges", True), ("surfels_advanced", True), ("surfels_files", True)]
    bpy.ops.object.mode_set(mode="EDIT")
    assert not drawn().buttons[SURFELS_FROM_MESH]


def test_a_scan_has_its_own_button_and_its_settings_before_the_conversion(scan, drawn):
    shown = drawn()
    assert leads(shown, SURFELS_FROM_POINTS) and shown.texts[0] == "50 points in scan"
    assert shown.properties[:4] == ["facing", "neighbours", "isolated", "follow"]
    scan.modifiers.new("faces", "SKIN")
    bpy.context.view_layer.update()
    assert SURFELS_FROM_MESH in drawn().buttons  # which the modifier's faces make of it


def test_surfels_and_their_source_are_updated_with_the_settings_of_their_conversion(cube, convert, drawn):
    (made,) = convert(resolution=8)
    for lead in (made, cube):
        bpy.ops.object.select_all(action="DESELECT")
        lead.select_set(True)
        bpy.context.view_layer.objects.active = lead
        shown = drawn(is_open=True)
        assert leads(shown, UPDATE_SURFELS)
        assert shown.texts[0] == f"{len(made.data.vertices):,} surfels of {cube.name}"
        assert not {"follow", "join", "space", "source"} & set(shown.properties)
    made.surfel_record.mesh.quality = "FINE"
    assert (made.surfel_record.mesh.density, made.surfel_record.mesh.pixels) == ("AUTOMATIC", 0.375)


def test_surfels_of_a_scan_keep_their_settings(scan, drawn):
    assert {"splat_size", "finds_creases", "flatness", "source"} <= set(drawn(is_open=True).properties)
    bpy.ops.object.surfels_from_points(neighbours=8)
    shown = drawn(is_open=True)
    assert leads(shown, UPDATE_SURFELS) and shown.texts[0].endswith("surfels of scan")
    assert "neighbours" in shown.properties and not {"source", "follow"} & set(shown.properties)
    made = bpy.context.active_object
    made.surfel_record.points.isolated = "KEEP"
    assert bpy.ops.object.surfels_update() == {"FINISHED"} and len(made.data.vertices) == 50


def test_surfels_in_another_scene_do_not_count(cube, convert, drawn):
    (made,) = convert(resolution=8)
    other = bpy.data.scenes.new("other")
    other.collection.objects.link(made)
    bpy.context.scene.collection.objects.unlink(made)
    cube.select_set(True)
    bpy.context.view_layer.objects.active = cube
    assert leads(drawn(), SURFELS_FROM_MESH)


def test_surfels_without_a_source_cannot_be_updated(cube, convert, drawn):
    (made,) = convert(resolution=8, source="KEEP")
    bpy.data.objects.remove(cube)
    shown = drawn()
    assert not shown.buttons[UPDATE_SURFELS] and shown.texts[0].endswith(f"surfels of {made.name}")


@pytest.mark.parametrize("mode", ["SCULPT", "VERTEX_PAINT"])
def test_in_a_brush_s_mode_surfels_say_where_to_paint(cube, convert, drawn, mode):
    convert(resolution=8)
    bpy.ops.object.mode_set(mode=mode)
    assert f"Brushes need faces: paint {cube.name}, or sculpt it and press Update" in " ".join(drawn().texts)


def test_the_quality_is_that_of_the_density():
    settings = bpy.context.scene.surfel_conversion
    assert settings.quality == "CAMERA"
    settings.quality = "DRAFT"
    assert (settings.quality, settings.pixels) == ("DRAFT", 1.5)
    settings.density = "RESOLUTION"
    assert settings.quality == "OTHER"


def test_an_error_chooses_the_density_and_the_density_tells_its_error(cube, drawn):
    settings = bpy.context.scene.surfel_conversion
    usual = settings.error
    settings.density, settings.error = "RESOLUTION", 1.5 * usual
    assert (
        settings.density == "AUTOMATIC"
        and settings.pixels > 0.75
        and settings.error == pytest.approx(1.5 * usual, rel=1e-4)
    )
    assert "error" in drawn().properties and "Error up to" in " ".join(drawn().texts)
    settings.density = "RESOLUTION"
    assert "error" not in drawn().properties


def test_the_file_is_searched_for_surfels_only_when_its_objects_change(cube, convert, drawn, monkeypatch):
    """A sidebar is drawn with every move of the mouse over it."""
    convert(resolution=8)
    searched = []
    monkeypatch.setattr(made_of, "sources_of", lambda made: searched.append(made) or [])
    for _ in range(3):
        drawn()
    assert searched == []
    assert chosen_module.surfels_of is made_of.surfels_of


def test_reasons_that_differ_in_how_many_times_only_are_one_line():
    seen = "0.75 pixels where the camera is nearest"
    thin = [Reason(seen, finer) for finer in (1.4, 2.1, 1.1, 10.0)]
    many = [Reason(seen, 2.0, coarser, 1234) for coarser in (3.0, 1.5)]
    assert sentences([Reason(seen), *thin, Reason(seen), *many]) == [
        seen,
        f"1.1 to 10.0 times finer, as it is thin, than {seen}",
        f"at most 1,234 surfels, 1.5 to 3.0 times coarser than 2.0 times finer, as it is thin, than {seen}",
    ]
    assert str(thin[0]) == f"1.4 times finer, as it is thin, than {seen}"


def test_the_panel_merges_reasons(add_mesh, camera, drawn):
    """Three wires of different widths give one line about being thin, beside that of the count."""
    wires = []
    for width in (0.004, 0.006, 0.01):
        corners = [(x * width, y * width, 4 * z) for x in (0, 1) for y in (0, 1) for z in (0, 1)]
        wires.append(add_mesh("wire", corners, [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6)]))
    for wire in wires:
        wire.select_set(True)
    bpy.context.view_layer.objects.active = wires[0]
    drawn()
    prediction._measure_wanted()
    thin = " ".join(drawn().texts)
    assert thin.count("as it is thin") == 1 and " to " in thin, thin
