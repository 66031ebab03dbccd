# SPDX-License-Identifier: GPL-3.0-or-later
"""The automatic density uses the camera if there is one, else a resolution, and never exceeds its maximum."""

import bpy
import pytest
from mathutils import Matrix

from splat_addon.blender.conversion import automatic_density, prediction
from splat_addon.blender.conversion.choices import Choices
from splat_addon.blender.conversion.mesh_conversion import prepare, sample
from splat_addon.blender.conversion.mesh_settings import choices
from splat_addon.blender.density import Density
from splat_addon.blender.ids import CONVERSION_SETTINGS
from splat_addon.blender.ui.predicted import prediction as sidebar_text

AUTOMATIC = Choices(Density("automatic", 1.0))


def prepared(source, asked=AUTOMATIC):
    bpy.context.view_layer.update()
    return prepare([source], bpy.context.evaluated_depsgraph_get(), asked)


def test_it_is_the_default():
    assert choices(getattr(bpy.context.scene, CONVERSION_SETTINGS)).density.measure == "automatic"


def test_without_a_camera_it_is_a_resolution_and_says_so(cube):
    conversion = prepared(cube)
    assert conversion.spacing == pytest.approx(2 / automatic_density.FALLBACK_RESOLUTION)
    assert conversion.reason == "resolution 256, as the scene has no camera"


def test_it_is_the_cameras_density_where_it_sees_the_object(cube, camera):
    by_camera = prepared(cube, Choices(Density("pixels", 1.0))).spacing
    found = prepared(cube)
    assert found.spacing == pytest.approx(by_camera) and found.reason == "1 pixels where the camera is nearest"


def test_a_camera_that_sees_nothing_leaves_the_resolution(cube, camera):
    camera.rotation_euler = (3.1, 0, 0)
    found = prepared(cube)
    assert found.spacing == pytest.approx(2 / 256) and "does not see it" in found.reason


def test_a_camera_that_moves_asks_for_a_margin(cube, camera):
    still = prepared(cube).spacing
    camera.keyframe_insert("location", frame=1)
    moving = prepared(cube)
    assert still / moving.spacing == pytest.approx(automatic_density.MOTION_MARGIN) and "moves" in moving.reason


def test_so_does_what_hangs_on_something_that_moves(cube, camera):
    still = prepared(cube).spacing
    parent = bpy.data.objects.new("parent", None)
    bpy.context.collection.objects.link(parent)
    cube.parent = parent
    assert prepared(cube).spacing == pytest.approx(still)
    parent.keyframe_insert("location", frame=1)
    assert still / prepared(cube).spacing == pytest.approx(automatic_density.MOTION_MARGIN)


def test_a_thing_on_the_horizon_keeps_a_few_cells(cube, camera):
    camera.location = camera.location * 2000
    camera.data.clip_end = 1e6
    found = prepared(cube)
    assert found.spacing == pytest.approx(2 / automatic_density.LEAST_RESOLUTION) and "far away" in found.reason


def test_a_wire_has_surfels_across_its_width(cube, camera):
    plain = prepared(cube).spacing
    cube.data.transform(Matrix.Diagonal((plain, plain, 1, 1)))  # twice as wide as surfels are apart
    found = prepared(cube)
    assert found.spacing == pytest.approx(2 * plain / automatic_density.ACROSS_WIRES, rel=0.01)
    assert found.reason.endswith(" times finer, as it is thin, than 1 pixels where the camera is nearest")
    cube.data.transform(Matrix.Diagonal((0.01, 0.01, 1, 1)))
    assert prepared(cube).reason == "1 pixels where the camera is nearest"


def test_a_thin_shell_has_no_more_surfels_than_a_wire_may_have(cube, camera, monkeypatch):
    plain = prepared(cube).spacing
    cube.data.transform(Matrix.Diagonal((1, 1, 0.2 * plain, 1)))
    monkeypatch.setattr(automatic_density, "MOST_OF_WIRES", round(8 / plain**2))
    assert prepared(cube).spacing == pytest.approx(plain, rel=0.05)


def test_an_uneven_scale_that_multiplies_surfels_is_named(cube, camera):
    hint = "; its scale is uneven, which multiplies surfels: apply it, or choose Space > World"
    for scale, is_uneven in (((1, 1, 1), False), ((3, 3, 3), False), ((1, 1, 1.5), False), ((4, 0.2, 0.1), True)):
        cube.scale = scale
        assert prepared(cube).reason.endswith(hint) == is_uneven
    in_world = prepared(cube, Choices(Density("automatic", 1.0), space="world"))
    assert "uneven" not in in_world.reason


def test_the_ceiling_is_named_when_it_applies(cube, camera, monkeypatch):
    asked = prepared(cube)
    monkeypatch.setattr(automatic_density, "MOST_SURFELS", 1500)
    found = prepared(cube)
    assert found.spacing == pytest.approx((24 / 1500) ** 0.5)
    times = f"{found.spacing / asked.spacing:.1f} times coarser"
    assert found.reason == f"at most 1,500 surfels, {times} than 1 pixels where the camera is nearest"


def test_the_ceiling_counts_large_surfels_as_one(cube, camera, monkeypatch):
    asked = Choices(Density("automatic", 1.0), tolerance=0.0, crease_angle=0.3)
    wanted = prepared(cube, asked).spacing
    monkeypatch.setattr(automatic_density, "MOST_SURFELS", int(12 / wanted**2))
    assert prepared(cube, asked).spacing == wanted
    monkeypatch.setattr(automatic_density, "MOST_SURFELS", 1500)
    found = prepared(cube, asked)
    sample(found)
    assert wanted < found.spacing < (24 / 1500) ** 0.5 and "at most 1,500 surfels" in found.reason
    assert len(found.surfels) == pytest.approx(1500, rel=0.2)


def test_an_objects_own_detail_counts(cube, camera):
    asked = Choices(Density("automatic", 4.0))
    one = prepared(cube, asked).spacing
    cube.surfel_splatting.detail = 2
    assert prepared(cube, asked).spacing == pytest.approx(one / 2)
    bpy.context.scene.camera = None
    assert prepared(cube).spacing == pytest.approx(2 / 512)


def test_the_sidebar_says_the_count_before_and_why(cube, camera, convert):
    asked = Choices(Density("automatic", 8.0))
    sidebar_text(bpy.context, [cube], asked)
    prediction._measure_wanted()
    count, why = sidebar_text(bpy.context, [cube], asked).split("\n")
    assert why == "8 pixels where the camera is nearest"
    made = convert(density="AUTOMATIC", pixels=8.0, use_adaptive=False)[0]
    assert int(count.split()[1].replace(",", "")) == pytest.approx(len(made.data.vertices), rel=0.01)


def test_a_script_that_gives_a_number_means_that_kind_of_density(cube, camera, convert):
    assert len(convert(resolution=16, use_adaptive=False)[0].data.vertices) == 1536


def test_meshes_sampled_live_have_it_too():
    settings = bpy.context.scene.surfel_splatting
    assert settings.mesh_density == "AUTOMATIC"
    settings.mesh_resolution = 32
    assert settings.mesh_density == "RESOLUTION"
