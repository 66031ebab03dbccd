# SPDX-License-Identifier: GPL-3.0-or-later
"""Toon shading and lines of materials and objects reach the renderer."""

import bpy
import numpy as np
import pytest

from splat_addon.blender.export.live_meshes import LiveMeshes
from splat_addon.blender.export.scene import export_scene
from splat_addon.blender.export.surfel_store import SurfelStore
from splat_addon.rendering import LineStyle, Ramp, Style


def styles():
    """The styles of all that a picture shows, twice: they are the same objects."""
    store, live, found = SurfelStore(), LiveMeshes(), []
    for _ in range(2):
        store.begin_frame()
        live.begin_frame()
        scene, _ = export_scene(bpy.context.evaluated_depsgraph_get(), store, live)
        placed = sorted((*scene.surfels, *scene.polygons), key=lambda each: each.name)
        found.append([material.style for each in placed for material in each.materials])
    assert found[0] == found[1]
    return found[0]


@pytest.fixture(params=["mesh", "surfels"])
def shown(request, cube, convert):
    """The cube with a material, drawn as polygons or as surfels."""
    cube.data.materials.append(bpy.data.materials.new("paint"))
    if request.param == "mesh":
        return cube
    [made] = convert(resolution=4)
    return made


def test_a_material_and_an_object_have_styles_and_the_object_leads(shown):
    material, own = shown.data.materials[0].surfel_splatting, shown.surfel_splatting.style
    assert styles() == [Style()]
    material.shading, material.steps, material.lines = "STEPS", 2, "OWN"
    material.line_width, material.line_color = 4.0, (1, 0, 0)
    [found] = styles()
    assert found.line == LineStyle(4.0, (1.0, 0.0, 0.0))
    assert np.array_equal(found.ramp.colors, Ramp.of_steps(2).colors)
    own.lines = "NONE"
    [found] = styles()
    assert found.line == LineStyle(0.0) and np.array_equal(found.ramp.colors, Ramp.of_steps(2).colors)
    texture = bpy.data.textures.new("ramp", "NONE")
    texture.use_color_ramp = True
    texture.color_ramp.elements[0].color = (1, 0, 0, 1)
    own.shading, own.ramp = "RAMP", texture
    [found] = styles()
    assert found.ramp.colors[0].tolist() == [1, 0, 0]


def test_objects_are_groups_where_lines_lie_between_them(shown, add_square):
    add_square("other")
    scene = bpy.context.scene.surfel_splatting
    assert {style.group for style in styles()} == {0}
    scene.use_lines = scene.lines_meet = True
    assert len({style.group for style in styles()}) == len(styles()) > 1
