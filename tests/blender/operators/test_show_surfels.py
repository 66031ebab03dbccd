# SPDX-License-Identifier: GPL-3.0-or-later
"""One click leads from a conversion to its picture, and the conversion's report names the button."""

import bpy
import pytest


def test_one_click_chooses_the_engine():
    bpy.context.scene.render.engine = "CYCLES"
    assert bpy.ops.view3d.surfels_show() == {"FINISHED"}
    assert bpy.context.scene.render.engine == "SURFEL_SPLATTING"


@pytest.mark.parametrize(("engine", "is_told"), [("CYCLES", True), ("SURFEL_SPLATTING", False)])
def test_a_conversion_says_what_to_do_next(add_square, convert, capfd, engine, is_told):
    bpy.context.scene.render.engine = engine
    add_square()
    convert(resolution=4)
    assert ("Choose the render engine Surfel Splatting to see the surfels" in capfd.readouterr().out) == is_told
