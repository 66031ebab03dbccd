# SPDX-License-Identifier: GPL-3.0-or-later
"""The evaluated mesh of an object is read correctly as a TriangleMesh."""

import bpy
import numpy as np
import pytest

from splat_addon.blender.geometry.points_extraction import materials_of
from splat_addon.blender.geometry.reading import readable_mesh
from splat_addon.blender.geometry.sources import mesh_key
from splat_addon.blender.meshes.mesh_extraction import read_mesh, read_without_pixels


def extract(source, read=read_mesh):
    evaluated = source.evaluated_get(bpy.context.evaluated_depsgraph_get())
    with readable_mesh(evaluated) as mesh:
        return read(evaluated, mesh)


def area(mesh):
    a, b, c = mesh.positions[mesh.triangles.T]
    return np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2


def test_modifiers_are_applied():
    bpy.ops.mesh.primitive_cube_add(size=1)
    array = bpy.context.object.modifiers.new("three", "ARRAY")
    array.count, array.use_relative_offset, array.use_constant_offset = 3, False, True
    array.constant_offset_displace = (5, 0, 0)
    mesh = extract(bpy.context.object).triangles
    assert len(mesh) == 3 * 12
    assert area(mesh) == pytest.approx(3 * 6)


def test_the_objects_own_transform_is_left_out():
    bpy.ops.mesh.primitive_cube_add(size=2, location=(7, 8, 9))
    bpy.context.object.scale = (3, 3, 3)
    assert np.abs(extract(bpy.context.object).triangles.positions).max() == 1


@pytest.mark.parametrize("fill", ["NGON", "TRIFAN"])
def test_polygons_become_triangles_of_the_same_area(fill):
    bpy.ops.mesh.primitive_circle_add(vertices=7, radius=1, fill_type=fill)
    assert area(extract(bpy.context.object).triangles) == pytest.approx(3.5 * np.sin(2 * np.pi / 7))


def test_smooth_shading_gives_the_vertices_normals():
    bpy.ops.mesh.primitive_uv_sphere_add(segments=64, ring_count=32)
    bpy.ops.object.shade_smooth()
    mesh = extract(bpy.context.object).triangles
    assert np.allclose(mesh.corner_normals, mesh.positions[mesh.triangles], atol=2e-2)


def test_flat_triangles_need_no_normals():
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=2)
    assert extract(bpy.context.object).triangles.corner_normals is None


def test_flat_quads_have_the_polygons_normal(add_mesh):
    bent = add_mesh("bent", [(0, 0, 0), (1, 0, 0), (1, 1, 0.5), (0, 1, 0)], [(0, 1, 2, 3)])
    normals = extract(bent).triangles.corner_normals
    assert np.allclose(normals, np.array(bent.data.polygons[0].normal), atol=1e-6)


@pytest.mark.parametrize("domain", ["POINT", "CORNER"])
@pytest.mark.parametrize(("kind", "tolerance"), [("FLOAT_COLOR", 1e-7), ("BYTE_COLOR", 5e-3)])
def test_colour_attributes_are_scene_linear_at_the_corners(add_mesh, domain, kind, tolerance):
    face = (2, 3, 0, 1)
    square = add_mesh("square", [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)], [face])
    colors = np.array([[0.8, 0, 0, 1], [0, 0.5, 0, 1], [0, 0, 0.2, 1], [0.1, 0.2, 0.3, 1]], np.float32)
    square.data.color_attributes.new("paint", kind, domain).data.foreach_set("color", colors.ravel())
    mesh = extract(square).triangles
    of_vertex = colors if domain == "POINT" else colors[np.argsort(face)]
    assert np.allclose(mesh.corner_colors, of_vertex[mesh.triangles], atol=tolerance)


def test_each_triangle_keeps_its_material_slot(add_mesh):
    strip = add_mesh(
        "strip", [(x, y, 0) for x in range(4) for y in range(2)], [(k, k + 2, k + 3, k + 1) for k in (0, 2, 4)]
    )
    for name in "ab":
        strip.data.materials.append(bpy.data.materials.new(name))
    strip.data.attributes.new("material_index", "INT", "FACE").data.foreach_set("value", np.array([1, 0, 9], np.int32))
    extracted = extract(strip)
    assert list(extracted.triangles.materials) == [1, 1, 0, 0, 1, 1]  # an index too large means the last slot
    assert [m.name for m in extracted.materials] == ["a", "b"]


def test_a_slot_that_the_object_owns_wins_over_the_meshs(add_square):
    square = add_square()
    square.data.materials.append(bpy.data.materials.new("of the mesh"))
    square.material_slots[0].link = "OBJECT"
    square.material_slots[0].material = bpy.data.materials.new("of the object")
    assert [m.name for m in extract(square).materials] == ["of the object"]


def test_a_slot_that_the_object_owns_and_that_is_empty_has_no_material(add_square):
    square = add_square()
    square.data.materials.append(bpy.data.materials.new("of the mesh"))
    square.material_slots[0].link = "OBJECT"
    square.material_slots[0].material = None
    evaluated = square.evaluated_get(bpy.context.evaluated_depsgraph_get())
    assert extract(square).materials == materials_of(evaluated) == (None,)
    assert mesh_key(evaluated)[1:] == (0,)


def test_materials_are_those_in_the_file_and_not_evaluated_copies(add_square):
    square = add_square()
    square.data.materials.append(bpy.data.materials.new("original"))
    assert extract(square).materials == (bpy.data.materials["original"],)


def test_points_without_faces_give_no_triangles(add_mesh):
    mesh = extract(add_mesh("points", [(0, 0, 0), (1, 0, 0)], [])).triangles
    assert (len(mesh), len(mesh.positions)) == (0, 2)


def test_an_empty_mesh_gives_no_triangles(add_mesh):
    assert len(extract(add_mesh("empty", [], [])).triangles) == 0


def test_all_but_the_pixels_is_read_without_them(monkeypatch):
    bpy.ops.mesh.primitive_torus_add()
    material = bpy.data.materials.new("look")
    material.use_nodes = True
    tree = material.node_tree
    node = tree.nodes.new("ShaderNodeTexImage")
    node.image = bpy.data.images.new("noise", 8, 8)
    tree.links.new(node.outputs["Color"], tree.nodes["Principled BSDF"].inputs["Base Color"])
    bpy.context.object.data.materials.append(material)
    full = extract(bpy.context.object).triangles
    monkeypatch.setattr("splat_addon.blender.materials.mesh_layers.linear_pixels", None)
    short = extract(bpy.context.object, read_without_pixels).triangles
    for name, array in full.per_triangle().items():
        assert np.array_equal(array, getattr(short, name)), name
    assert full.surfaces[0].color_texture.image.pixels.shape == (8, 8, 4)
    assert short.surfaces[0].color_texture.image.pixels.shape == (1, 1, 4)
