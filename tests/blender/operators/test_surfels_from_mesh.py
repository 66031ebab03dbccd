# SPDX-License-Identifier: GPL-3.0-or-later
"""What Object > Convert to Surfels leaves behind."""

import bpy
import numpy as np
import pytest

from splat_addon.blender.conversion import Choices
from splat_addon.blender.conversion_batch import ConversionBatch


@pytest.fixture
def cube():
    bpy.ops.mesh.primitive_cube_add(size=2)
    bpy.context.object.name = "Box"
    return bpy.context.object


def test_a_cube_becomes_exactly_its_faces_cells(cube, convert, surfels_of):
    assert len(surfels_of(convert(resolution=16)[0])) == 6 * 16 * 16


def test_a_spacing_in_object_units_gives_the_same_as_its_resolution(cube, convert, surfels_of):
    cube.scale = (5, 5, 5)
    by_spacing = convert(density="SPACING", spacing=2 / 16)[0]
    assert len(surfels_of(by_spacing)) == 6 * 16 * 16


def test_the_splat_size_is_in_spacings(cube, convert, surfels_of):
    assert np.allclose(surfels_of(convert(resolution=16, splat_size=1.5)[0]).scales, 1.5 * 2 / 16)


def test_the_result_is_named_after_its_source_and_alone_selected(cube, convert):
    made = convert(resolution=4)[0]
    assert made.name == "Box surfels"
    assert bpy.context.selected_objects == [made]
    assert bpy.context.view_layer.objects.active == made


def test_the_result_is_in_the_collections_of_its_source(cube, convert):
    other = bpy.data.collections.new("other")
    bpy.context.scene.collection.children.link(other)
    other.objects.link(cube)
    assert convert(resolution=4)[0].users_collection == cube.users_collection
    assert len(cube.users_collection) == 2


def test_the_result_has_the_material_slots_of_its_source(cube, convert):
    for name in "ab":
        cube.data.materials.append(bpy.data.materials.new(name))
    assert [slot.material.name for slot in convert(resolution=4)[0].material_slots] == ["a", "b"]


@pytest.mark.parametrize(("source", "hidden"), [("KEEP", False), ("HIDE", True)])
def test_the_source_is_kept_or_hidden_as_asked(cube, convert, source, hidden):
    convert(resolution=4, source=source)
    assert (cube.hide_get(), cube.hide_render) == (hidden, hidden)


def test_modifiers_shape_the_surfels(cube, convert, surfels_of):
    cube.modifiers.new("short", "SIMPLE_DEFORM").deform_method = "TAPER"
    cube.modifiers.new("array", "ARRAY")
    bounds = np.array([corner[:] for corner in cube.evaluated_get(bpy.context.evaluated_depsgraph_get()).bound_box])
    made = convert(density="SPACING", spacing=0.05)[0]
    positions = surfels_of(made).positions + np.array(made.location)
    assert np.allclose([positions.min(0), positions.max(0)], [bounds.min(0), bounds.max(0)], atol=0.05)


def test_every_selected_mesh_is_converted(convert, add_square, add_object):
    squares = [add_square(name) for name in "ab"]
    light = add_object(bpy.data.lights.new("not a mesh", "SUN"))
    for selected in (*squares, light):
        selected.select_set(True)
    assert [made.name for made in convert(resolution=4)] == ["a surfels", "b surfels"]


def test_surfels_are_not_converted_again(cube, convert):
    convert(resolution=4)
    assert not bpy.ops.object.surfels_from_mesh.poll()
    cube.select_set(True)
    assert [made.name for made in convert(resolution=4)] == ["Box surfels.001"]


def test_the_report_counts_triangles_and_surfels(cube, convert, capfd):
    convert(resolution=16)
    report = capfd.readouterr().out
    assert "Box: 12 triangles -> 1,536 surfels in" in report and "spacing 0.125" in report


def test_undo_takes_the_surfels_back(cube):
    bpy.ops.ed.undo_push(message="before")
    bpy.ops.object.surfels_from_mesh("EXEC_DEFAULT", True, resolution=4, source="HIDE")
    assert "Box surfels" in bpy.data.objects
    bpy.ops.ed.undo()
    assert "Box surfels" not in bpy.data.objects
    assert not bpy.data.objects["Box"].hide_render


def test_a_cancelled_batch_adds_nothing(cube):
    batch = ConversionBatch([cube], Choices({"resolution": 64}))
    data_before = len(bpy.data.objects), len(bpy.data.meshes)

    def cancel(share):
        batch.is_cancelled = True

    for conversion in batch.prepared(bpy.context):
        batch.sample(conversion, cancel)
    assert not batch.has_surfels
    assert (len(bpy.data.objects), len(bpy.data.meshes)) == data_before


def test_progress_rises_to_the_end_over_all_sources(add_square):
    shares = []
    batch = ConversionBatch([add_square(name) for name in "abc"], Choices({"resolution": 64}))
    for conversion in batch.prepared(bpy.context):
        batch.sample(conversion, shares.append)
    assert shares == sorted(shares) and shares[-1] == 1.0 and shares[0] < 0.4


def test_it_stands_in_the_object_menu():
    functions = [function.__name__ for function in bpy.types.VIEW3D_MT_object._dyn_ui_initialize()]
    assert functions.count("draw_menu_entry") == 1
