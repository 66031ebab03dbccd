# SPDX-License-Identifier: GPL-3.0-or-later
"""The Surfels tab offers a conversion only for what can be converted, and shows the settings that the guide names."""

from types import SimpleNamespace
from unittest.mock import MagicMock

import bpy
import pytest

from splat_addon.blender.conversion import prediction
from splat_addon.blender.conversion.density_reason import Reason, sentences
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
    drawn()
    prediction._measure_wanted()
    thin = " ".join(drawn().texts)
    assert thin.count("as it is thin") == 1 and " to " in thin, thin


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
