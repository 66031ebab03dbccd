# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes that were not converted are drawn as polygons among the surfels."""

import bpy
import numpy as np
import pytest

from splat_addon.blender.engine import final_render
from tests.blender.engine.mesh_scenes import add_sun, as_cycles_has_it, counts, principled


@pytest.mark.parametrize("meshes", ["POLYGONS", "SURFELS"])
def test_objects_that_share_a_mesh_have_materials_of_their_own(scene, add_camera, add_square, picture, meshes):
    """An object's own slot may hold another material than its mesh's, as on linked copies of furniture."""
    scene.surfel_splatting.render_meshes = meshes
    add_camera()
    one = add_square()
    one.data.materials.append(principled(Base_Color=(1, 0, 0, 1)))
    other = one.copy()
    scene.collection.objects.link(other)
    one.location, other.location = (-1.5, -0.5, 0), (0.5, -0.5, 0)
    other.material_slots[0].link = "OBJECT"
    other.material_slots[0].material = principled(Base_Color=(0, 0, 1, 1))
    drawn = picture()
    assert np.allclose(drawn[16, 12], (1, 0, 0, 1), atol=1e-3) and np.allclose(drawn[16, 20], (0, 0, 1, 1), atol=1e-3)


def test_a_lit_mesh_is_as_bright_as_in_cycles(slanting, picture, switch_to_cycles):
    bpy.ops.mesh.primitive_uv_sphere_add(radius=1, location=(-1, 0, 0.4))
    bpy.ops.object.shade_smooth()
    bpy.context.object.data.materials.append(principled(Base_Color=(0.7, 0.3, 0.2, 1), Roughness=0.6))
    bpy.ops.mesh.primitive_cube_add(size=1.4, location=(1, 0, 0.2), rotation=(0.2, 0.1, 0.5))
    bpy.context.object.data.materials.append(principled(Base_Color=(0.2, 0.5, 0.7, 1), Roughness=0.9))
    bpy.ops.mesh.primitive_plane_add(size=8, location=(0, 0, -0.6))
    add_sun(slanting)
    ours = picture()
    assert counts()["polygon_meshes"] == 3
    switch_to_cycles(samples=16)
    slanting.cycles.max_bounces = 0
    assert as_cycles_has_it(ours, picture(), 0.1)


def test_the_slots_of_a_mesh_and_its_colour_attribute_are_shown(slanting, picture):
    slanting.surfel_splatting.shading = "flat"
    bpy.ops.mesh.primitive_plane_add(size=2)
    data = bpy.context.object.data
    attribute = data.color_attributes.new("paint", "FLOAT_COLOR", "POINT")
    attribute.data.foreach_set("color", np.array([(1, 0, 0, 1), (0, 1, 0, 1)] * 2, np.float32).ravel())
    red_to_green = picture()[32, 22:42, :3]
    assert np.allclose(red_to_green.sum(axis=1), 1, atol=1e-4)
    assert red_to_green[0, 0] > 0.7 and red_to_green[-1, 1] > 0.7
    data.materials.append(principled(Base_Color=(0, 0, 1, 1)))
    assert np.allclose(picture()[32, 32, :3], (0, 0, 1), atol=1e-5)


def test_an_unchanged_mesh_stays_on_the_device(slanting, packed_polygons, tmp_path):
    bpy.ops.mesh.primitive_monkey_add()
    slanting.frame_start, slanting.frame_end = 1, 3
    slanting.render.filepath = str(tmp_path / "frame_####.exr")
    bpy.ops.render.render(animation=True)
    assert len(packed_polygons) == 1 and counts()["triangles"] == len(packed_polygons[0]) // 3


def test_instances_share_one_mesh(slanting, scene, packed_polygons, picture):
    bpy.ops.mesh.primitive_cube_add(size=0.5)
    for x in (-1, 1):
        copy = bpy.context.object.copy()
        copy.location.x = x
        scene.collection.objects.link(copy)
    assert picture().any() and len(packed_polygons) == 1
    assert final_render.last_frame_stats["instances"] == 3


@pytest.mark.parametrize("form", ["POLYGONS", "SURFELS", "HIDDEN"])
def test_an_object_has_the_last_word(form, slanting, picture):
    slanting.surfel_splatting.render_meshes = "HIDDEN" if form != "HIDDEN" else "POLYGONS"
    bpy.ops.mesh.primitive_cube_add()
    bpy.context.object.surfel_splatting.render_as = form
    assert picture().any() is np.bool_(form != "HIDDEN")
    assert set(counts()) == {"POLYGONS": {"polygon_meshes", "triangles"}, "HIDDEN": set()}.get(
        form, {"meshes", "surfels", "sampled"}
    )


def test_what_polygons_do_not_show_is_said(slanting, picture, said):
    bpy.ops.mesh.primitive_cube_add()
    bpy.context.object.data.materials.append(principled(Alpha=0.5))
    bpy.context.object.surfel_splatting.render_as = "POLYGONS"
    picture()
    assert "Cube is transparent, but polygons show only" in said()


def test_what_is_transparent_becomes_surfels_unless_its_object_says_otherwise(slanting, picture, said):
    """One transparent material of two is enough, if some face has it."""
    bpy.ops.mesh.primitive_plane_add()
    mesh = bpy.context.object.data
    mesh.materials.append(principled(Alpha=1.0))
    mesh.materials.append(principled(Alpha=0.5))
    assert picture()[..., 3].max() == 1 and set(counts()) == {"polygon_meshes", "triangles"}
    mesh.polygons[0].material_index = 1
    assert picture()[..., 3].max() == pytest.approx(0.5, abs=0.01) and "triangles" not in counts()
    assert "but polygons show" not in said()


def test_broken_vertices_take_their_triangles_with_them(slanting, picture):
    bpy.ops.mesh.primitive_grid_add(x_subdivisions=4, y_subdivisions=4)
    data = bpy.context.object.data
    data.vertices[0].co = (np.nan, 0, 0)
    whole = picture()
    assert np.isfinite(whole).all() and whole.any()
    assert counts()["triangles"] == 32


def test_a_mesh_without_a_height_is_left_out_and_a_mirrored_giant_is_drawn(slanting, picture, said):
    bpy.ops.mesh.primitive_cube_add(location=(1, 0, 0))
    bpy.context.object.scale = (1, 1, 0)
    bpy.ops.mesh.primitive_cube_add(size=1e-6)
    bpy.context.object.scale = (-1e6, 1e6, 1e6)
    seen = picture()
    assert "Objects with a scale of 0 on some axis are left out" in said()
    assert np.isfinite(seen).all() and 100 < np.count_nonzero(seen[..., 3]) < 2000


def test_a_mesh_in_edit_mode_is_drawn(slanting, picture):
    bpy.ops.mesh.primitive_cube_add()
    before = picture()
    bpy.ops.object.mode_set(mode="EDIT")
    try:
        assert np.array_equal(before, picture())
    finally:
        bpy.ops.object.mode_set(mode="OBJECT")


@pytest.mark.parametrize("kind", ["VolumeScatter", "BsdfTransparent", "Holdout"])
def test_a_mesh_whose_material_covers_nothing_is_not_drawn(kind, slanting, picture):
    bpy.ops.mesh.primitive_cube_add(size=2)
    material = principled()
    tree = material.node_tree
    tree.nodes.remove(tree.nodes["Principled BSDF"])
    output = tree.get_output_node("ALL").inputs["Volume" if kind == "VolumeScatter" else "Surface"]
    tree.links.new(tree.nodes.new(f"ShaderNode{kind}").outputs[0], output)
    bpy.context.object.data.materials.append(material)
    assert not picture().any()
    if kind == "VolumeScatter":
        assert (
            "The material 'material' has no surface but a volume, which is not drawn"
            in (final_render.last_frame_stats["notes"])
        )
