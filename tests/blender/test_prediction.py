# SPDX-License-Identifier: GPL-3.0-or-later
"""The sidebar's count is right, cached, and forgotten when the mesh changes."""

import bpy
import pytest

from splat_addon.blender.conversion import prediction
from splat_addon.blender.conversion.choices import Choices
from splat_addon.blender.conversion.gathering import gather
from splat_addon.blender.conversion.mesh_settings import choices
from splat_addon.blender.density import Density
from splat_addon.blender.ids import CONVERSION_SETTINGS
from splat_addon.blender.ui.predicted import prediction as sidebar_text
from splat_addon.blender.ui.predicted import prediction_text
from splat_addon.sampling import REDUCTIONS, predict_count

PLAIN = Choices(Density("resolution", 16))


@pytest.fixture
def known(cube):
    """The extent of the cube, measured as the sidebar's timer does."""
    bpy.context.view_layer.update()
    assert prediction.known_extents([[cube]], PLAIN) is None
    prediction._measure_wanted()
    return prediction.known_extents([[cube]], PLAIN)[0]


def test_a_cube_is_predicted_exactly(known):
    assert known.predict(Density("resolution", 16)) == (6 * 16 * 16, 2 / 16)
    assert known.predict(Density("spacing", 0.25)) == (6 * 8 * 8, 0.25)


def test_it_is_the_count_that_sampling_predicts(cube):
    cube.modifiers.new("round", "SUBSURF").levels = 3
    depsgraph = bpy.context.evaluated_depsgraph_get()
    count, spacing = prediction.measure([cube], depsgraph, PLAIN).predict(Density("resolution", 100))
    assert count == predict_count(gather([cube], depsgraph, False).mesh, spacing=spacing)


@pytest.mark.parametrize("density", [Density("resolution", 0), Density("spacing", 0.0)])
def test_a_setting_of_zero_predicts_nothing(known, density):
    assert known.predict(density) == (0, 0.0)


def test_a_mesh_without_faces_predicts_nothing(add_mesh):
    points = add_mesh("points", [(0, 0, 0)], [])
    extent = prediction.measure([points], bpy.context.evaluated_depsgraph_get(), PLAIN)
    assert (extent.predict(Density("resolution", 16))[0], extent.predict(Density("spacing", 0.1))[0]) == (0, 0)


def test_a_sidebar_that_opens_is_drawn_before_the_count_is_measured(cube):
    """A measurement would leave it half faded in for as long as it takes."""
    is_registered = bpy.app.timers.is_registered
    prediction.forget_all()
    assert prediction.known_extents([[cube]], PLAIN) is None
    assert [is_registered(timer) for timer in prediction._TIMERS] == [True, False]
    bpy.app.timers.unregister(prediction._wait_for_drawing)
    prediction._wait_for_drawing()
    assert [is_registered(timer) for timer in prediction._TIMERS] == [False, True] and prediction._wanted
    bpy.app.timers.unregister(prediction._measure_wanted)
    prediction._measure_wanted()
    assert not prediction._wanted and prediction.known_extents([[cube]], PLAIN)


def test_a_changed_modifier_forgets_the_count(cube, known):
    cube.modifiers.new("array", "ARRAY")
    bpy.context.view_layer.update()
    assert prediction.known_extents([[cube]], PLAIN) is None


def test_a_changed_mesh_forgets_the_count(cube, known):
    cube.data.vertices[0].co.x = 5
    cube.data.update()
    bpy.context.view_layer.update()
    assert prediction.known_extents([[cube]], PLAIN) is None


def test_a_moved_object_keeps_its_count(cube, known):
    cube.location.x = 5
    bpy.context.view_layer.update()
    assert prediction.known_extents([[cube]], PLAIN) == [known]


def test_another_file_forgets_all_counts(cube, known):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    assert prediction._extents == {}


def test_a_count_predicts_itself(known):
    assert known.predict(Density("count", 1500)) == (1500, pytest.approx((24 / 1500) ** 0.5))


@pytest.mark.parametrize("reduction", REDUCTIONS)
def test_every_reduction_has_its_own_count(cube, reduction):
    cube.rotation_euler = (0.3, 0.5, 0.7)
    bpy.ops.object.transform_apply(rotation=True)
    depsgraph = bpy.context.evaluated_depsgraph_get()
    extent = prediction.measure([cube], depsgraph, Choices(Density("resolution", 16), reduction=reduction))
    mesh = gather([cube], depsgraph, False).mesh
    assert extent.predict(Density("spacing", 0.1))[0] == predict_count(mesh, spacing=0.1, reduction=reduction)


def test_another_reduction_is_measured_anew(cube, known):
    assert prediction.known_extents([[cube]], Choices(Density("resolution", 16), reduction="none")) is None
    assert prediction.known_extents([[cube]], Choices(Density("spacing", 0.5))) == [known]


def test_the_text_sums_over_the_selected_meshes():
    assert prediction_text([(10_000, 0.1), (5_000, 0.1)]) == "≈ 15,000 surfels, spacing 0.1"
    assert prediction_text([(10_000, 0.1), (1_250, 0.2)]) == "≈ 11,250 surfels, spacing 0.1 to 0.2"


def test_the_text_says_that_there_is_nothing_to_sample():
    assert prediction_text([(0, 0.0)]).startswith("Nothing to sample")


def test_the_text_says_when_the_count_is_still_to_come(cube):
    assert sidebar_text(bpy.context, [cube], PLAIN) == "Counting …"


def test_for_a_camera_the_text_has_the_count_of_the_conversion(cube, camera, convert):
    asked = Choices(Density("pixels", 8.0))
    sidebar_text(bpy.context, [cube], asked)
    prediction._measure_wanted()
    text = sidebar_text(bpy.context, [cube], asked)
    made = convert(density="CAMERA", pixels=8.0, use_adaptive=False)[0]
    assert int(text.split()[1].replace(",", "")) == pytest.approx(len(made.data.vertices), rel=0.01)


def test_the_text_knows_the_objects_own_detail(cube, known):
    before = sidebar_text(bpy.context, [cube], PLAIN)
    cube.surfel_splatting.detail = 2
    assert (before, sidebar_text(bpy.context, [cube], PLAIN)) == (
        "≈ 1,536 surfels, spacing 0.125",
        "≈ 6,144 surfels, spacing 0.0625",
    )


def test_for_a_camera_that_sees_nothing_the_text_says_so(cube, camera):
    camera.rotation_euler = (3.1, 0, 0)
    bpy.context.view_layer.update()
    sidebar_text(bpy.context, [cube], Choices(Density("pixels", 1.0)))
    prediction._measure_wanted()
    assert "does not see the object" in sidebar_text(bpy.context, [cube], Choices(Density("pixels", 1.0)))


def test_the_text_says_less_where_flat_only_if_a_tolerance_may_merge_what_is_not(cube):
    settings = getattr(bpy.context.scene, CONVERSION_SETTINGS)
    settings.density = "RESOLUTION"
    assert choices(settings).tolerance == 0
    for name, value in {
        "density": "COUNT",
        "clips_edges": False,
        "reduction": "THREE_TO_ONE",
        "use_adaptive": False,
    }.items():
        before = getattr(settings, name)
        setattr(settings, name, value)
        assert choices(settings).tolerance is None, name
        setattr(settings, name, before)
    sidebar_text(bpy.context, [cube], choices(settings))
    prediction._measure_wanted()
    assert "fewer where flat" not in sidebar_text(bpy.context, [cube], choices(settings))
    settings.tolerance = 0.01
    assert "fewer where flat" in sidebar_text(bpy.context, [cube], choices(settings))
    settings.use_adaptive = False
    assert "fewer where flat" not in sidebar_text(bpy.context, [cube], choices(settings))


@pytest.mark.parametrize("has_image", [False, True])
def test_large_surfels_are_predicted_where_faces_are_flat_and_have_no_image(has_image, cube, convert):
    material = bpy.data.materials.new("look")
    material.use_nodes = True
    cube.data.materials.append(material)
    asked = Choices(Density("resolution", 100), tolerance=0.0, crease_angle=0.3)

    def predicted():
        bpy.context.view_layer.update()
        sidebar_text(bpy.context, [cube], asked)
        prediction._measure_wanted()
        return int(sidebar_text(bpy.context, [cube], asked).split()[1].replace(",", ""))

    before = predicted()
    if has_image:
        tree = material.node_tree
        image = tree.nodes.new("ShaderNodeTexImage")
        image.image = bpy.data.images.new("noise", 8, 8)
        tree.links.new(image.outputs["Color"], tree.nodes["Principled BSDF"].inputs["Base Color"])
    made = convert(density="RESOLUTION", resolution=100)[0]
    assert before < 12_000
    assert predicted() == pytest.approx(len(made.data.vertices), rel=0.15)
    assert (predicted() > 50_000) == has_image
