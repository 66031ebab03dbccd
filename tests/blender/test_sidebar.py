# SPDX-License-Identifier: GPL-3.0-or-later
"""The Surfels tab offers a conversion only for what can be converted, and shows the settings that the guide names."""

from types import SimpleNamespace
from unittest.mock import MagicMock

import bpy
import pytest

from splat_addon.blender.ids import SURFELS_FROM_MESH, SURFELS_FROM_POINTS
from splat_addon.blender.ui.points_panel import VIEW3D_PT_surfels_from_points
from splat_addon.blender.ui.sidebar import VIEW3D_PT_surfels_from_mesh

PANELS = (VIEW3D_PT_surfels_from_mesh, VIEW3D_PT_surfels_from_points)


class Layout:
    """Records what is drawn: texts, properties, and whether each operator's button is enabled."""

    def __init__(self, drawn=None):
        self.drawn = drawn or SimpleNamespace(texts=[], properties=[], buttons={})
        self.enabled = True

    def row(self, **_):
        return Layout(self.drawn)

    column = box = row

    def label(self, text, icon):
        self.drawn.texts.append(text)

    def prop(self, owner, name, **_):
        self.drawn.properties.append(name)

    def operator(self, name, **_):
        self.drawn.buttons[name] = self.enabled
        return MagicMock()


@pytest.fixture
def drawn():
    """drawn() -> what the panels of the tab show now."""

    def draw():
        layout = Layout()
        for panel in PANELS:
            panel.draw(SimpleNamespace(layout=layout, _draw_surfels=lambda context: None), bpy.context)
        return layout.drawn

    return draw


ADVICE = "Select objects with surfaces, in Object Mode"


def test_nothing_selected_is_said(drawn):
    assert drawn().texts == [ADVICE]


def test_a_mesh_can_be_converted(cube, drawn):
    assert drawn().buttons[SURFELS_FROM_MESH] and ADVICE not in drawn().texts
    bpy.ops.object.mode_set(mode="EDIT")
    assert drawn().texts == [ADVICE]


def test_surfels_cannot_be_converted_again_and_need_no_advice(cube, convert, drawn):
    convert(resolution=8)
    shown = drawn()
    assert not shown.buttons[SURFELS_FROM_MESH] and not shown.buttons[SURFELS_FROM_POINTS]
    assert shown.texts == []
    cube.select_set(True)
    assert drawn().buttons[SURFELS_FROM_MESH]


def test_the_tab_decides_whether_the_surfels_follow(cube, drawn):
    assert "follow" in drawn().properties
    assert bpy.context.scene.surfel_conversion.follow
