# SPDX-License-Identifier: GPL-3.0-or-later
"""An object is polygons where it is near, or where a group says so, and surfels beyond: it looks whole."""

import bpy
import numpy as np
import pytest

from splat_addon.blender.engine import final_render
from tests.blender.engine.mesh_scenes import add_sun, counts


@pytest.fixture
def ball(slanting):
    """A ball with smooth colours under a sun, with a fine spacing if it is sampled."""
    slanting.surfel_splatting.mesh_resolution = 90
    bpy.ops.mesh.primitive_uv_sphere_add(radius=1.5, segments=48, ring_count=24)
    bpy.ops.object.shade_smooth()
    data = bpy.context.object.data
    places = np.array([v.co for v in data.vertices])
    colors = np.column_stack([0.5 + 0.4 * np.sin(2 * places + (0, 1, 2)), np.ones(len(places))])
    data.color_attributes.new("paint", "FLOAT_COLOR", "POINT").data.foreach_set("color", colors.astype("f").ravel())
    add_sun(slanting)
    return bpy.context.object


def psnr_inside(one, other):
    inside = (one[..., 3] > 0.999) & (other[..., 3] > 0.999)
    assert inside.sum() > 500
    return -10 * np.log10(np.mean((one - other)[inside] ** 2))


@pytest.mark.parametrize("method", ["quad", "mip"])
@pytest.mark.parametrize("kind", ["DISTANCE", "SPACING", "GROUP"])
def test_a_split_object_looks_whole(kind, method, ball, slanting, picture):
    slanting.surfel_splatting.method = method
    slanting.surfel_splatting.supersampling = 2 if method == "quad" else 1
    settings = ball.surfel_splatting
    settings.split_distance = 7.0
    focal = 64 * slanting.camera.data.lens / slanting.camera.data.sensor_width
    settings.split_pixels = 3 / 90 * focal / 7.0
    group = ball.vertex_groups.new(name="near")
    group.add([v.index for v in ball.data.vertices if v.co.x + 0.3 * v.co.z > 0.1], 1.0, "REPLACE")
    settings.split_group = "near"
    pictures = {}
    for settings.render_as in ("POLYGONS", "SURFELS", kind):
        pictures[settings.render_as] = picture()
    assert {"polygon_meshes", "meshes"} < set(counts())
    if kind == "GROUP":
        assert 0 < counts()["triangles"] < 2 * len(ball.data.polygons) - 100
    whole = pictures["POLYGONS"][..., 3] > 0.999
    whole &= pictures["SURFELS"][..., 3] > 0.999
    assert pictures[kind][whole, 3].min() > 0.999
    assert psnr_inside(pictures[kind], pictures["POLYGONS"]) > 45
    assert psnr_inside(pictures[kind], pictures["SURFELS"]) > 43


@pytest.mark.parametrize(
    ("pixels", "scale", "forms"), [(0.25, 1, ["polygons"]), (1, 1, ["splats"]), (0.5, 2, ["polygons"])]
)
def test_surfels_too_far_apart_in_the_picture_are_polygons(pixels, scale, forms, ball, slanting, picture):
    """Half a pixel is between the ball's surfels at its middle, and a whole one if it is twice as large."""
    ball.surfel_splatting.render_as, ball.surfel_splatting.split_pixels = "SPACING", pixels
    ball.scale = [scale] * 3
    assert (picture()[..., 3] > 0.999).sum() > 500
    assert [form for form in ("polygons", "splats") if final_render.last_frame_stats[form]] == forms


def test_a_split_mesh_that_does_not_change_is_kept(ball, slanting, packed_polygons, tmp_path):
    ball.vertex_groups.new(name="near").add(list(range(200)), 1.0, "REPLACE")
    ball.surfel_splatting.render_as, ball.surfel_splatting.split_group = "GROUP", "near"
    slanting.frame_start, slanting.frame_end = 1, 3
    slanting.render.filepath = str(tmp_path / "frame_####.exr")
    bpy.ops.render.render(animation=True)
    assert len(packed_polygons) == 1 and counts()["followed"] == 1


@pytest.mark.parametrize(("group", "sentence"), [("", "none is chosen"), ("none", "which it does not have")])
def test_a_group_that_is_not_there_is_named(group, sentence, ball, picture, said):
    ball.surfel_splatting.render_as, ball.surfel_splatting.split_group = "GROUP", group
    assert not picture().any()
    text = said()
    assert "Sphere is left out: It is split by" in text and sentence in text
