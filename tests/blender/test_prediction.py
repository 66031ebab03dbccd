# SPDX-License-Identifier: GPL-3.0-or-later
"""The sidebar's count: right, cached, and forgotten when the mesh changes."""

import bpy
import pytest

from splat_addon.blender import prediction
from splat_addon.blender.mesh_extraction import extract_mesh
from splat_addon.blender.sidebar import prediction_text
from splat_addon.sampling import predict_count


@pytest.fixture
def cube():
    bpy.ops.mesh.primitive_cube_add(size=2)
    return bpy.context.object


@pytest.fixture
def known(cube):
    """The extent of the cube, measured as the timer does it."""
    bpy.context.view_layer.update()
    assert prediction.known_extents([cube]) is None
    prediction._measure_wanted()
    return prediction.known_extents([cube])[0]


def test_a_cube_is_predicted_exactly(known):
    assert known.predict({"resolution": 16}) == (6 * 16 * 16, 2 / 16)
    assert known.predict({"spacing": 0.25}) == (6 * 8 * 8, 0.25)


def test_it_is_the_count_that_sampling_predicts(cube):
    cube.modifiers.new("round", "SUBSURF").levels = 3
    depsgraph = bpy.context.evaluated_depsgraph_get()
    count, spacing = prediction.measure(cube, depsgraph).predict({"resolution": 100})
    assert count == predict_count(extract_mesh(cube, depsgraph).triangles, spacing=spacing)


@pytest.mark.parametrize("fineness", [{"resolution": 0}, {"spacing": 0.0}])
def test_a_setting_of_zero_predicts_nothing(known, fineness):
    assert known.predict(fineness) == (0, 0.0)


def test_a_mesh_without_faces_predicts_nothing(add_mesh):
    points = add_mesh("points", [(0, 0, 0)], [])
    extent = prediction.measure(points, bpy.context.evaluated_depsgraph_get())
    assert (extent.predict({"resolution": 16})[0], extent.predict({"spacing": 0.1})[0]) == (0, 0)


def test_a_changed_modifier_forgets_the_count(cube, known):
    cube.modifiers.new("array", "ARRAY")
    bpy.context.view_layer.update()
    assert prediction.known_extents([cube]) is None


def test_a_changed_mesh_forgets_the_count(cube, known):
    cube.data.vertices[0].co.x = 5
    cube.data.update()
    bpy.context.view_layer.update()
    assert prediction.known_extents([cube]) is None


def test_a_moved_object_keeps_its_count(cube, known):
    cube.location.x = 5
    bpy.context.view_layer.update()
    assert prediction.known_extents([cube]) == [known]


def test_another_file_forgets_all_counts(cube, known):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    assert prediction._extents == {}


def test_the_text_sums_over_the_selected_meshes():
    extents = [prediction.Extent(100.0, 1.0), prediction.Extent(50.0, 2.0)]
    assert prediction_text(extents, {"spacing": 0.1}) == "≈ 15,000 surfels, spacing 0.1"
    assert prediction_text(extents, {"resolution": 10}) == "≈ 11,250 surfels, spacing 0.1 to 0.2"


def test_the_text_says_that_there_is_nothing_to_sample():
    assert prediction_text([prediction.Extent(0.0, 0.0)], {"resolution": 10}).startswith("Nothing to sample")


def test_the_text_says_when_the_count_is_still_to_come():
    assert prediction_text(None, {"resolution": 10}) == "Counting …"
