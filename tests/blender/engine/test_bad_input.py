# SPDX-License-Identifier: GPL-3.0-or-later
"""Bad input never crashes: a sentence names it, what was skipped is counted, and everything else is rendered."""

from pathlib import Path

import bpy
import numpy as np
import pytest

from splat_addon.blender.cameras import rendered_part
from splat_addon.blender.geometry.attributes import write_surfels
from splat_addon.surfels import empty_surfels

NAN, INFINITE = float("nan"), float("inf")


@pytest.fixture
def good(add_camera, add_surfels):
    """A disc in the middle of the picture, whose pixel (16, 16) is green."""
    add_camera()
    return add_surfels([(0, 0, 0)], size=1, colors=(0, 1, 0, 1), name="good")


@pytest.fixture
def assert_good_is_drawn(good, picture):
    """assert_good_is_drawn(): the picture is the one of the good disc alone."""

    def check():
        drawn = picture()
        others = [made for made in bpy.data.objects if made.type in {"MESH", "LIGHT"} and made != good]
        for other in others:
            other.hide_render = True
        assert np.array_equal(drawn[16, 16], (0, 1, 0, 1))
        assert np.array_equal(drawn, picture())

    return check


def test_a_scene_without_a_camera_is_refused(scene, add_surfels):
    add_surfels([(0, 0, 0)])
    with pytest.raises(RuntimeError, match="no camera"):
        bpy.ops.render.render(write_still=True)


def test_a_panorama_of_another_type_is_refused(scene, add_camera):
    add_camera(type="PANO", panorama_type="MIRRORBALL")
    with pytest.raises(RuntimeError, match="camera 'camera' is Mirror Ball; choose one of Equirectangular"):
        bpy.ops.render.render(write_still=True)


def test_clip_distances_in_the_wrong_order_are_refused(scene, add_camera):
    add_camera(clip_start=10, clip_end=5)
    with pytest.raises(RuntimeError, match=r"0 < near < far, not near 10\.0, far 5\.0"):
        bpy.ops.render.render(write_still=True)


@pytest.mark.parametrize("name", ["lens", "sensor_width", "shift_x", "clip_start", "clip_end"])
def test_a_camera_with_a_number_that_is_none_is_refused_by_name(name, scene, add_camera):
    add_camera(**{name: NAN})
    with pytest.raises(RuntimeError, match=r"The camera 'camera' cannot be used: .*nan"):
        bpy.ops.render.render(write_still=True)


def test_a_border_that_is_no_place_is_refused(scene):
    """Tiles read it; a render is refused by Blender."""
    scene.render.use_border, scene.render.border_max_x = True, NAN
    with pytest.raises(ValueError, match=r"The render border ends at .*nan.*; draw it again or switch it off"):
        rendered_part(scene.render)


def test_pixels_of_an_image_that_are_no_colours_are_counted_and_black(scene, add_camera, add_square, picture, said):
    """If one channel is not finite, all of the pixel is 0, as in Cycles."""
    add_camera(type="ORTHO", ortho_scale=1).location = (0.5, 0.5, 9)
    image = bpy.data.images.new("holed", 2, 1, float_buffer=True)
    image.pixels.foreach_set(np.float32((NAN, 1, 0, 1, 0.25, 0.5, 1, 1)))
    material = bpy.data.materials.new("textured")
    if bpy.app.version < (5, 0, 0):
        material.use_nodes = True
    tree = material.node_tree
    node = tree.nodes.new("ShaderNodeTexImage")
    node.image, node.interpolation = image, "Closest"
    tree.links.new(node.outputs["Color"], tree.nodes["Principled BSDF"].inputs["Base Color"])
    add_square().data.materials.append(material)
    drawn = picture()
    assert np.array_equal(drawn[16, 8], (0, 0, 0, 1)) and np.allclose(drawn[16, 24], (0.25, 0.5, 1, 1))
    assert "The image 'holed' has infinite or too large numbers; its pixels that count as 0: 1" in said()


def test_pixels_that_overflow_are_counted_and_black(good, scene, picture, said):
    good.data.attributes["Col"].data[0].color = (3e38, 1, 0, 1)
    scene.surfel_splatting.shading = "principled"
    light = bpy.data.objects.new("glare", bpy.data.lights.new("glare", "SUN"))
    light.data.energy = 1e20
    scene.collection.objects.link(light)
    assert np.array_equal(picture()[16, 16], (0, 0, 0, 1))
    assert "pixels are black because their numbers are not finite; look for huge lights" in said()


def test_a_camera_without_extent_is_refused(scene, add_camera):
    add_camera().scale = (1, 0, 1)
    with pytest.raises(RuntimeError, match=r"[Ss]et the camera's scale to 1"):
        bpy.ops.render.render(write_still=True)


def test_after_a_refusal_the_next_render_works(good, scene, picture):
    scene.camera.data.type, scene.camera.data.panorama_type = "PANO", "MIRRORBALL"
    with pytest.raises(RuntimeError):
        picture()
    scene.camera.data.type = "PERSP"
    assert picture().any()


@pytest.mark.parametrize("name", ["rotation", "scale", "normal", "Col", "material"])
def test_an_object_that_lost_an_attribute_is_named_and_left_out(name, add_surfels, assert_good_is_drawn, said):
    torn = add_surfels([(0, 0, 1)], name="torn")
    torn.data.attributes.remove(torn.data.attributes[name])
    assert_good_is_drawn()
    assert f"Warning: torn is left out: The surfel mesh 'torn' has no attribute '{name}'" in said()


@pytest.mark.parametrize("choice", ["BACKGROUND", "STOP"])
def test_a_render_that_nobody_watches_stops_at_a_broken_object(choice, scene, good, add_surfels):
    scene.surfel_splatting.broken_objects = choice
    for name in ("torn", "torn too"):
        torn = add_surfels([(0, 0, 1)], name=name)
        torn.data.attributes.remove(torn.data.attributes["scale"])
    with pytest.raises(RuntimeError, match=r"torn is left out: .* 'scale'.*\(and 1 more\) .*Broken Objects .* to Warn"):
        bpy.ops.render.render(write_still=True)
    assert not Path(scene.render.filepath).exists()


def test_by_default_it_stops_in_background_only(scene):
    scene.surfel_splatting.property_unset("broken_objects")
    assert scene.surfel_splatting.broken_objects == "BACKGROUND" and bpy.app.background


def test_an_attribute_of_the_wrong_type_is_named_and_its_object_left_out(add_surfels, assert_good_is_drawn, said):
    wrong = add_surfels([(0, 0, 1)], name="wrong")
    wrong.data.attributes.remove(wrong.data.attributes["scale"])
    wrong.data.attributes.new("scale", "FLOAT", "POINT")
    assert_good_is_drawn()
    assert "The attribute 'scale' of the surfel mesh 'wrong' is FLOAT on POINT; convert it to FLOAT_VECTOR" in said()


@pytest.mark.parametrize(
    ("name", "field", "values"),
    [
        ("position", "vector", (NAN, 0, 0)),
        ("position", "vector", (0, INFINITE, 0)),
        ("rotation", "value", (0, 0, 0, 0)),
        ("rotation", "value", (NAN, 0, 0, 1)),
        ("scale", "vector", (0, 1, 0)),
        ("scale", "vector", (1, -1, 0)),
        ("scale", "vector", (INFINITE, 1, 0)),
        ("normal", "vector", (0, 0, 0)),
        ("normal", "vector", (0, NAN, 0)),
        ("Col", "color", (0, NAN, 0, 1)),
        ("material", "value", -1),
    ],
)
def test_unusable_rows_are_counted_and_left_out(name, field, values, add_surfels, assert_good_is_drawn, said):
    damaged = add_surfels([(0, 0, 1), (0, 0, 2)], size=2, name="damaged")
    # not assigned one by one, which would make an infinite number a merely huge one
    kind = np.int32 if name == "material" else np.float32
    damaged.data.attributes[name].data.foreach_set(field, np.tile(values, 2).astype(kind))
    assert_good_is_drawn()
    assert "Warning: damaged: 2 surfels with unusable values are left out" in said()


def test_a_good_row_among_unusable_ones_is_drawn(add_camera, add_surfels, picture, said):
    add_camera()
    mixed = add_surfels([(0, 0, 0), (1, 0, 1), (0, 1, 1)], size=1, colors=(0, 1, 0, 1), name="mixed")
    for row in (1, 2):
        mixed.data.attributes["scale"].data[row].vector = (NAN, 1, 0)
    drawn = picture()
    assert np.array_equal(drawn[16, 16], (0, 1, 0, 1)) and not drawn[:, 20:].any()
    assert "mixed: 2 surfels with unusable values" in said()


@pytest.mark.parametrize("scale", [(0, 0, 0), (1, 1, 0)])
def test_flattened_objects_are_counted_and_left_out(scale, add_surfels, assert_good_is_drawn, said):
    for x in (0, 0.1):
        add_surfels([(x, 0, 1)], size=2).scale = scale
    assert_good_is_drawn()
    assert "Objects with a scale of 0 on some axis are left out; give every axis a scale (2 times)" in said()


def test_an_object_at_an_unusable_place_is_named_and_left_out(add_surfels, assert_good_is_drawn, said):
    add_surfels([(0, 0, 1)], size=2, name="lost").location.x = NAN
    assert_good_is_drawn()
    assert "Warning: lost is left out: The object's transform is not finite" in said()


@pytest.mark.parametrize("size", [1e20, 1e30, 3e38])
def test_huge_coordinates_beside_usable_ones_do_no_harm(size, good, add_surfels, picture, assert_same_picture):
    """Both are in one object, so that its bounds reach from one end of float32 to the other."""
    alone = picture()
    good.hide_render = True
    signs = np.stack(np.meshgrid(*[(-1, 1)] * 3), axis=-1).reshape(-1, 3)
    add_surfels(np.concatenate([[(0, 0, 0)], size * signs]), size=1, colors=(0, 1, 0, 1))
    assert_same_picture(alone, picture())


@pytest.mark.parametrize("size", [1e20, 1e30])
@pytest.mark.parametrize("axis", [0, 2])
def test_a_huge_object_beside_usable_ones_does_no_harm(size, axis, add_surfels, assert_good_is_drawn):
    add_surfels([(0, 0, 1)], size=0.1).location[axis] = -size
    assert_good_is_drawn()


def test_a_huge_surfel_behind_usable_ones_fills_the_picture(good, add_surfels, picture):
    add_surfels([(0, 0, -5)], size=1e15, colors=(1, 0, 0, 1))
    drawn = picture()
    assert np.allclose(drawn[16, 16], (0, 1, 0, 1)) and np.allclose(drawn[2, 2], (1, 0, 0, 1), atol=1e-4)


def test_no_surfels_at_all_are_no_mishap(good, add_object, assert_good_is_drawn, said):
    add_object(write_surfels("none", empty_surfels()))
    assert_good_is_drawn()
    assert "Warning" not in said()


def test_meshes_without_faces_are_counted(good, add_mesh, assert_good_is_drawn, said):
    for name in ("one", "other"):
        add_mesh(name, [(0, 0, 0), (1, 0, 0)], [])
    assert_good_is_drawn()
    text = said()
    assert "Warning: Meshes of points without faces are not drawn; convert them with Object > Convert Points" in text
    assert "(2 times)" in text


def test_meshes_of_edges_show_nothing_as_in_cycles_without_a_word(good, add_mesh, assert_good_is_drawn, said):
    add_mesh("wire", [(0, 0, 0), (1, 0, 0)], []).data.edges.add(1)
    assert_good_is_drawn()
    assert "without faces" not in said()


def test_point_clouds_are_said_to_be_left_out(good, add_mesh, add_nodes, picture, said):
    def to_points(tree, start, end):
        convert = tree.nodes.new("GeometryNodeMeshToPoints")
        tree.links.new(start, convert.inputs[0])
        tree.links.new(convert.outputs[0], end)

    add_nodes(add_mesh("points", [(0, 0, 1)], []), to_points)
    assert np.array_equal(picture()[16, 16], (0, 1, 0, 1))
    assert "Point clouds are not drawn; convert them with Object > Convert Points to Surfels" in said()


@pytest.mark.parametrize("modifier", [None, "SMOOTH"])
def test_surfels_in_edit_mode_are_drawn(modifier, good, add_surfels, picture):
    edited = add_surfels([(2, 0, 0)], size=1, name="edited")
    if modifier:
        edited.modifiers.new("modifier", modifier).show_in_editmode = True
    apart = picture()
    bpy.ops.object.mode_set(mode="EDIT")
    assert np.array_equal(picture(), apart)


def test_a_mesh_in_edit_mode_is_no_mishap(assert_good_is_drawn):
    bpy.ops.mesh.primitive_cube_add(location=(5, 0, 1))
    bpy.ops.object.mode_set(mode="EDIT")
    assert_good_is_drawn()


@pytest.mark.parametrize("kind", ["SUN", "POINT"])
def test_a_light_of_zero_scale_does_no_harm(kind, scene, assert_good_is_drawn):
    light = bpy.data.objects.new("light", bpy.data.lights.new("light", kind))
    light.scale = (0, 0, 0)
    scene.collection.objects.link(light)
    assert_good_is_drawn()


@pytest.mark.parametrize("scale", [NAN, INFINITE])
def test_a_light_whose_transform_is_not_finite_is_named_and_left_out(scale, scene, assert_good_is_drawn, said):
    light = bpy.data.objects.new("lost", bpy.data.lights.new("lost", "SPOT"))
    light.scale.x, light.rotation_euler.z, light.delta_scale.x = scale, 1, 1e9
    scene.collection.objects.link(light)
    assert_good_is_drawn()
    assert "Warning: lost is left out: The object's transform is not finite; clear its location" in said()


#: socket -> the value that Cycles takes instead, where others are given
TAKEN = {
    "Specular IOR Level": {-1: 0, NAN: 0},
    "IOR": {-1: 1e-5, 0: 1e-5},
    "Roughness": {-2: 0, 3: 1, NAN: 0},
    "Metallic": {-2: 0, 1e30: 1},
    "Coat Weight": {NAN: 0},
    "Coat IOR": {0: 1, -3e38: 1},
}


def test_numbers_of_a_material_beyond_their_range_are_named_and_drawn_as_cycles_draws_them(good, scene, picture, said):
    material = bpy.data.materials.new("odd")
    if bpy.app.version < (5, 0, 0):
        material.use_nodes = True
    inputs = material.node_tree.nodes["Principled BSDF"].inputs
    good.data.materials.append(material)
    scene.surfel_splatting.shading = "principled"
    scene.collection.objects.link(bpy.data.objects.new("sun", bpy.data.lights.new("sun", "SUN")))
    for name, pairs in TAKEN.items():
        before = inputs[name].default_value
        for wrong, taken in pairs.items():
            inputs[name].default_value = wrong
            drawn, text = picture(), said()
            assert f"The material 'odd' has numbers that no surface has: {name} {wrong:g} counts as {taken:g}" in text
            inputs[name].default_value = taken
            assert np.array_equal(drawn, picture()) and np.isfinite(drawn).all()
        inputs[name].default_value = before
        said()


def test_a_light_with_an_unusable_energy_is_named_and_left_out(scene, assert_good_is_drawn, said):
    light = bpy.data.objects.new("dim", bpy.data.lights.new("dim", "POINT"))
    light.data.energy = NAN
    scene.collection.objects.link(light)
    assert_good_is_drawn()
    assert "Warning: dim is left out: A light's energy must be finite, not nan" in said()


@pytest.mark.parametrize("strength", [1e35, INFINITE])
def test_a_light_of_infinite_colour_is_named_and_left_out(strength, scene, assert_good_is_drawn, said):
    light = bpy.data.objects.new("glare", bpy.data.lights.new("glare", "POINT"))
    light.data.energy, light.data.color = 1e5, (strength, 1, 1)
    scene.collection.objects.link(light)
    assert_good_is_drawn()
    assert "Warning: glare is left out: A light's colour times its energy must be at most 3e+38" in said()


@pytest.mark.parametrize("strength", [3e38, INFINITE, NAN])
def test_an_infinite_world_and_material_are_named_and_black(strength, good, scene, picture, said):
    material, scene.world = bpy.data.materials.new("glow"), bpy.data.worlds.new("sky")
    if bpy.app.version < (5, 0, 0):
        material.use_nodes = scene.world.use_nodes = True
    principled = material.node_tree.nodes["Principled BSDF"].inputs
    principled["Emission Color"].default_value, principled["Emission Strength"].default_value = (1e5, 1, 1, 1), strength
    background = scene.world.node_tree.nodes["Background"].inputs
    background["Color"].default_value, background["Strength"].default_value = (1e5, 1, 1, 1), strength
    good.data.materials.append(material)
    scene.surfel_splatting.shading, scene.render.film_transparent = "principled", False
    assert np.array_equal(picture()[16, 16], (0, 0, 0, 1))
    text = said()
    assert "The material 'glow' emits" in text and "The world 'sky' emits" in text


def add_sky(scene, width, height):
    scene.world = bpy.data.worlds.new("sky")
    if bpy.app.version < (5, 0, 0):
        scene.world.use_nodes = True
    tree = scene.world.node_tree
    node = tree.nodes.new("ShaderNodeTexEnvironment")
    node.image = bpy.data.images.new("wide", width, height, float_buffer=True)
    node.image.pixels.foreach_set(np.full(4 * width * height, 0.5, np.float32))
    tree.links.new(node.outputs["Color"], tree.nodes["Background"].inputs["Color"])


def test_a_world_s_picture_of_one_pixel_lights(scene, good, picture):
    add_sky(scene, 1, 1)
    scene.surfel_splatting.shading = "principled"
    assert np.isfinite(picture()).all() and 0.1 < picture()[16, 16, 1] < 0.6


def test_a_world_s_picture_wider_than_devices_hold_is_shown_smaller_and_named(scene, add_camera, picture, said):
    add_camera()
    add_sky(scene, 40_000, 2)
    scene.render.film_transparent = False
    assert np.allclose(picture(), (0.5, 0.5, 0.5, 1))
    assert "world's picture 'wide' is larger than 16,384 pixels" in said()


def test_a_matcap_wider_than_devices_hold_is_refused_with_its_size(scene, good):
    scene.surfel_splatting.shading = "matcap"
    scene.surfel_splatting.matcap = bpy.data.images.new("wide", 40_000, 2)
    with pytest.raises(RuntimeError, match="The matcap 'wide' has 40,000 x 2 pixels, and 16,384"):
        bpy.ops.render.render(write_still=True)


@pytest.mark.parametrize(("name", "label"), [("shading", "Shading"), ("method", "Method"), ("render_meshes", "Meshes")])
def test_a_choice_of_a_later_version_is_named(name, label, scene, good):
    store_number(scene, name, 99)
    with pytest.raises(RuntimeError, match=rf"{label}.* in the render properties holds a choice that this version"):
        bpy.ops.render.render(write_still=True)


def test_an_object_with_a_choice_of_a_later_version_is_left_out(add_square, good, assert_good_is_drawn, said):
    store_number(add_square("newer"), "render_as", 99)
    assert_good_is_drawn()
    assert "newer is left out: Render as in the object properties holds a choice" in said()


def store_number(owner, name, number):
    """Store a choice that this version does not know, as a file of a later version does."""
    owner.surfel_splatting.property_unset(name)
    if hasattr(owner, "bl_system_properties_get"):
        first = owner.surfel_splatting.bl_rna.properties[name].enum_items[1].identifier
        setattr(owner.surfel_splatting, name, first)  # so that the group is stored
        owner.bl_system_properties_get()["surfel_splatting"][name] = number
    else:
        owner.surfel_splatting[name] = number


def test_a_material_without_a_principled_node_is_named(good, assert_good_is_drawn, said):
    material = bpy.data.materials.new("bare")
    material.use_nodes = True
    material.node_tree.nodes.clear()
    good.data.materials.append(material)
    assert_good_is_drawn()
    assert "The material 'bare' has no shader at its output" in said()


def test_an_empty_material_slot_is_no_mishap(good, assert_good_is_drawn, said):
    good.data.materials.append(None)
    assert_good_is_drawn()
    assert "Warning" not in said()


def test_a_material_index_past_the_slots_is_no_mishap(good, assert_good_is_drawn):
    good.data.attributes["material"].data[0].value = 1000
    assert_good_is_drawn()


def test_opacity_below_one_is_no_mishap(add_surfels, assert_good_is_drawn, said):
    add_surfels([(-1, 0, 0)], colors=(1, 1, 1, 0.5))
    assert_good_is_drawn()
    assert "Warning" not in said()


def test_opacity_that_the_method_cannot_draw_is_said_to_be_ignored(scene, add_surfels, assert_good_is_drawn, said):
    scene.surfel_splatting.method = "sprites_unfiltered"
    add_surfels([(-1, 0, 0)], colors=(1, 1, 1, 0.5))
    assert_good_is_drawn()
    assert "drawn opaque" in said()
