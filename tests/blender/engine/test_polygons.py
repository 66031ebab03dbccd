# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes that were not converted are drawn as polygons among the surfels."""

import bpy
import numpy as np
import pytest

from splat_addon.blender.engine import final_render
from splat_addon.rendering.scene import polygons
from splat_addon.rendering.upload import resources


@pytest.fixture
def packed(monkeypatch):
    """A list of the polygons packed for the device, in order."""
    made, pack = [], polygons.pack_polygons
    monkeypatch.setattr(resources, "pack_polygons", lambda shape: made.append(shape) or pack(shape))
    return made


def counts():
    """What the last frame drew of meshes, and not how many it read."""
    return {name: count for name, count in final_render.last_frame_stats["live_meshes"].items() if name != "read"}


def principled(**inputs) -> bpy.types.Material:
    material = bpy.data.materials.new("material")
    if bpy.app.version < (5, 0, 0):
        material.use_nodes = True
    shader = material.node_tree.nodes["Principled BSDF"]
    for name, value in inputs.items():
        shader.inputs[name.replace("_", " ")].default_value = value
    return material


def add_sun(scene, rotation=(0.5, 0.3, 0), energy=3.0, **properties):
    data = bpy.data.lights.new("sun", "SUN")
    data.energy, data.angle = energy, 0
    for name, value in properties.items():
        setattr(data, name, value)
    sun = bpy.data.objects.new("sun", data)
    sun.rotation_euler = rotation
    scene.collection.objects.link(sun)
    return sun


def as_cycles_has_it(ours, truth, share):
    """Compare brightness where both pictures are covered: in the mean, and in all but a few pixels, within that
    share.
    """
    inside = (ours[..., 3] == 1) & (truth[..., 3] > 0.999)
    mine, other = ours[inside][:, :3], truth[inside][:, :3]
    assert inside.sum() > 100
    assert abs(mine.mean() - other.mean()) < share * other.mean()
    off = np.abs(mine - other).max(axis=1) > share * other.max()
    return np.count_nonzero(off) <= 0.05 * len(off)


@pytest.fixture
def look(scene, add_camera):
    """Set up 64 x 64 pixels, lit as Cycles lights them, seen from above at a slant."""
    scene.surfel_splatting.shading, scene.surfel_splatting.supersampling = "principled", 2
    scene.render.resolution_x = scene.render.resolution_y = 64
    add_camera((0, -6, 5), (0.87, 0, 0), lens=60)
    return scene


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


def test_a_lit_mesh_is_as_bright_as_in_cycles(look, picture, switch_to_cycles):
    bpy.ops.mesh.primitive_uv_sphere_add(radius=1, location=(-1, 0, 0.4))
    bpy.ops.object.shade_smooth()
    bpy.context.object.data.materials.append(principled(Base_Color=(0.7, 0.3, 0.2, 1), Roughness=0.6))
    bpy.ops.mesh.primitive_cube_add(size=1.4, location=(1, 0, 0.2), rotation=(0.2, 0.1, 0.5))
    bpy.context.object.data.materials.append(principled(Base_Color=(0.2, 0.5, 0.7, 1), Roughness=0.9))
    bpy.ops.mesh.primitive_plane_add(size=8, location=(0, 0, -0.6))
    add_sun(look)
    ours = picture()
    assert counts()["polygon_meshes"] == 3
    switch_to_cycles(samples=16)
    look.cycles.max_bounces = 0
    assert as_cycles_has_it(ours, picture(), 0.1)


def test_the_slots_of_a_mesh_and_its_colour_attribute_are_shown(look, picture):
    look.surfel_splatting.shading = "flat"
    bpy.ops.mesh.primitive_plane_add(size=2)
    data = bpy.context.object.data
    attribute = data.color_attributes.new("paint", "FLOAT_COLOR", "POINT")
    attribute.data.foreach_set("color", np.array([(1, 0, 0, 1), (0, 1, 0, 1)] * 2, np.float32).ravel())
    red_to_green = picture()[32, 22:42, :3]
    assert np.allclose(red_to_green.sum(axis=1), 1, atol=1e-4)
    assert red_to_green[0, 0] > 0.7 and red_to_green[-1, 1] > 0.7
    data.materials.append(principled(Base_Color=(0, 0, 1, 1)))
    assert np.allclose(picture()[32, 32, :3], (0, 0, 1), atol=1e-5)


def test_an_image_is_looked_up_at_every_pixel(look, picture, switch_to_cycles):
    """The image passes through a Mapping node and is repeated."""
    look.surfel_splatting.shading = "flat"
    look.surfel_splatting.supersampling = 4
    image = bpy.data.images.new("checks", 16, 16, float_buffer=True)
    pixels = np.random.default_rng(0).uniform(0.1, 0.9, (16, 16, 4)).astype(np.float32)
    pixels[..., 3] = 1
    image.pixels.foreach_set(pixels.ravel())
    material = bpy.data.materials.new("textured")
    if bpy.app.version < (5, 0, 0):
        material.use_nodes = True
    tree = material.node_tree
    texture, mapping, where = (tree.nodes.new(f"ShaderNode{n}") for n in ("TexImage", "Mapping", "TexCoord"))
    emission = tree.nodes.new("ShaderNodeBsdfDiffuse")
    texture.image, texture.interpolation = image, "Closest"
    mapping.inputs["Scale"].default_value = (2, 1.5, 1)
    tree.links.new(where.outputs["UV"], mapping.inputs["Vector"])
    tree.links.new(mapping.outputs["Vector"], texture.inputs["Vector"])
    tree.links.new(texture.outputs["Color"], emission.inputs["Color"])
    tree.links.new(emission.outputs[0], tree.nodes["Material Output"].inputs["Surface"])
    bpy.ops.mesh.primitive_plane_add(size=3)
    bpy.context.object.data.materials.append(material)
    ours = picture()
    # under a uniform white world the radiance is the colour
    look.world = bpy.data.worlds.new("white")
    look.world.color = (1, 1, 1)
    if bpy.app.version < (5, 0, 0):
        look.world.use_nodes = True
    look.world.node_tree.nodes["Background"].inputs["Color"].default_value = (1, 1, 1, 1)
    switch_to_cycles(samples=64, filter_width=1.0)
    truth = picture()
    inside = (ours[..., 3] == 1) & (truth[..., 3] > 0.999)
    assert np.abs(ours - truth)[inside].mean() < 0.02 < ours[inside][:, :3].std()


def test_an_unchanged_mesh_stays_on_the_device(look, packed, tmp_path):
    bpy.ops.mesh.primitive_monkey_add()
    look.frame_start, look.frame_end = 1, 3
    look.render.filepath = str(tmp_path / "frame_####.exr")
    bpy.ops.render.render(animation=True)
    assert len(packed) == 1 and counts()["triangles"] == len(packed[0]) // 3


def test_instances_share_one_mesh(look, scene, packed, picture):
    bpy.ops.mesh.primitive_cube_add(size=0.5)
    for x in (-1, 1):
        copy = bpy.context.object.copy()
        copy.location.x = x
        scene.collection.objects.link(copy)
    assert picture().any() and len(packed) == 1
    assert final_render.last_frame_stats["instances"] == 3


@pytest.mark.parametrize("form", ["POLYGONS", "SURFELS", "HIDDEN"])
def test_an_object_has_the_last_word(form, look, picture):
    look.surfel_splatting.render_meshes = "HIDDEN" if form != "HIDDEN" else "POLYGONS"
    bpy.ops.mesh.primitive_cube_add()
    bpy.context.object.surfel_splatting.render_as = form
    assert picture().any() is np.bool_(form != "HIDDEN")
    assert set(counts()) == {"POLYGONS": {"polygon_meshes", "triangles"}, "HIDDEN": set()}.get(
        form, {"meshes", "surfels", "sampled"}
    )


def test_what_polygons_do_not_show_is_said(look, picture, said):
    bpy.ops.mesh.primitive_cube_add()
    bpy.context.object.data.materials.append(principled(Alpha=0.5))
    bpy.context.object.surfel_splatting.render_as = "POLYGONS"
    picture()
    assert "Cube is transparent, but polygons show only" in said()


def test_what_is_transparent_becomes_surfels_unless_its_object_says_otherwise(look, picture, said):
    """One transparent material of two is enough, if some face has it."""
    bpy.ops.mesh.primitive_plane_add()
    mesh = bpy.context.object.data
    mesh.materials.append(principled(Alpha=1.0))
    mesh.materials.append(principled(Alpha=0.5))
    assert picture()[..., 3].max() == 1 and set(counts()) == {"polygon_meshes", "triangles"}
    mesh.polygons[0].material_index = 1
    assert picture()[..., 3].max() == pytest.approx(0.5, abs=0.01) and "triangles" not in counts()
    assert "but polygons show" not in said()


def test_broken_vertices_take_their_triangles_with_them(look, picture):
    bpy.ops.mesh.primitive_grid_add(x_subdivisions=4, y_subdivisions=4)
    data = bpy.context.object.data
    data.vertices[0].co = (np.nan, 0, 0)
    whole = picture()
    assert np.isfinite(whole).all() and whole.any()
    assert counts()["triangles"] == 32


def test_a_mesh_without_a_height_is_left_out_and_a_mirrored_giant_is_drawn(look, picture, said):
    bpy.ops.mesh.primitive_cube_add(location=(1, 0, 0))
    bpy.context.object.scale = (1, 1, 0)
    bpy.ops.mesh.primitive_cube_add(size=1e-6)
    bpy.context.object.scale = (-1e6, 1e6, 1e6)
    seen = picture()
    assert "Objects with a scale of 0 on some axis are left out" in said()
    assert np.isfinite(seen).all() and 100 < np.count_nonzero(seen[..., 3]) < 2000


def test_a_mesh_in_edit_mode_is_drawn(look, picture):
    bpy.ops.mesh.primitive_cube_add()
    before = picture()
    bpy.ops.object.mode_set(mode="EDIT")
    try:
        assert np.array_equal(before, picture())
    finally:
        bpy.ops.object.mode_set(mode="OBJECT")


@pytest.fixture
def ball(look):
    """A ball with smooth colours under a sun, with a fine spacing if it is sampled."""
    look.surfel_splatting.mesh_resolution = 90
    bpy.ops.mesh.primitive_uv_sphere_add(radius=1.5, segments=48, ring_count=24)
    bpy.ops.object.shade_smooth()
    data = bpy.context.object.data
    places = np.array([v.co for v in data.vertices])
    colors = np.column_stack([0.5 + 0.4 * np.sin(2 * places + (0, 1, 2)), np.ones(len(places))])
    data.color_attributes.new("paint", "FLOAT_COLOR", "POINT").data.foreach_set("color", colors.astype("f").ravel())
    add_sun(look)
    return bpy.context.object


def psnr_inside(one, other):
    inside = (one[..., 3] > 0.999) & (other[..., 3] > 0.999)
    assert inside.sum() > 500
    return -10 * np.log10(np.mean((one - other)[inside] ** 2))


@pytest.mark.parametrize("method", ["quad", "mip"])
@pytest.mark.parametrize("kind", ["DISTANCE", "SPACING", "GROUP"])
def test_a_split_object_looks_whole(kind, method, ball, look, picture):
    look.surfel_splatting.method = method
    look.surfel_splatting.supersampling = 2 if method == "quad" else 1
    settings = ball.surfel_splatting
    settings.split_distance = 7.0
    focal = 64 * look.camera.data.lens / look.camera.data.sensor_width
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
def test_surfels_too_far_apart_in_the_picture_are_polygons(pixels, scale, forms, ball, look, picture):
    """Half a pixel is between the ball's surfels at its middle, and a whole one if it is twice as large."""
    ball.surfel_splatting.render_as, ball.surfel_splatting.split_pixels = "SPACING", pixels
    ball.scale = [scale] * 3
    assert (picture()[..., 3] > 0.999).sum() > 500
    assert [form for form in ("polygons", "splats") if final_render.last_frame_stats[form]] == forms


def test_a_split_mesh_that_does_not_change_is_kept(ball, look, packed, tmp_path):
    ball.vertex_groups.new(name="near").add(list(range(200)), 1.0, "REPLACE")
    ball.surfel_splatting.render_as, ball.surfel_splatting.split_group = "GROUP", "near"
    look.frame_start, look.frame_end = 1, 3
    look.render.filepath = str(tmp_path / "frame_####.exr")
    bpy.ops.render.render(animation=True)
    assert len(packed) == 1 and counts()["followed"] == 1


@pytest.mark.parametrize(("group", "sentence"), [("", "none is chosen"), ("none", "which it does not have")])
def test_a_group_that_is_not_there_is_named(group, sentence, ball, picture, said):
    ball.surfel_splatting.render_as, ball.surfel_splatting.split_group = "GROUP", group
    assert not picture().any()
    text = said()
    assert "Sphere is left out: It is split by" in text and sentence in text


def leaf_card(pixels, is_mixed=False) -> bpy.types.Object:
    """A plane whose Base Color and Alpha come from one image, or whose alpha mixes it with a Transparent BSDF."""
    image = bpy.data.images.new("leaf", *pixels.shape[1::-1], alpha=True, float_buffer=True)
    image.pixels.foreach_set(np.float32(pixels).ravel())
    material = principled(Roughness=1.0)
    tree, shader = material.node_tree, material.node_tree.nodes["Principled BSDF"]
    texture = tree.nodes.new("ShaderNodeTexImage")
    texture.image = image
    tree.links.new(texture.outputs["Color"], shader.inputs["Base Color"])
    if is_mixed:
        mix, clear = tree.nodes.new("ShaderNodeMixShader"), tree.nodes.new("ShaderNodeBsdfTransparent")
        for output, to in ((texture.outputs["Alpha"], 0), (clear.outputs[0], 1), (shader.outputs[0], 2)):
            tree.links.new(output, mix.inputs[to])
        tree.links.new(mix.outputs[0], tree.get_output_node("ALL").inputs["Surface"])
    else:
        tree.links.new(texture.outputs["Alpha"], shader.inputs["Alpha"])
    bpy.ops.mesh.primitive_plane_add(size=3)
    bpy.context.object.data.materials.append(material)
    return bpy.context.object


def leaf(size=32) -> np.ndarray:
    """The pixels of a green disc; the transparent ones around it are black, as in a real leaf card."""
    x, y = np.meshgrid(*2 * [(np.arange(size) + 0.5) / size - 0.5])
    inside = x * x + y * y < 0.35**2
    return inside[..., None] * np.array((0.1, 0.6, 0.2, 1.0))


@pytest.mark.parametrize(("form", "is_mixed"), [("SCENE", False), ("POLYGONS", False), ("SCENE", True)])
def test_a_leaf_card_is_seen_through_as_in_cycles(form, is_mixed, look, picture, said, switch_to_cycles):
    """It is polygons, by default and on demand, and none of the black around the leaf is visible."""
    look.surfel_splatting.samples = 16
    card = leaf_card(leaf(), is_mixed)
    card.surfel_splatting.render_as = form
    add_sun(look)
    ours = picture()
    assert set(counts()) == {"polygon_meshes", "triangles"} and "transparent" not in said()
    switch_to_cycles(samples=64)
    look.cycles.max_bounces, look.cycles.transparent_max_bounces = 0, 8
    truth = picture()
    assert np.abs(ours[..., 3] - truth[..., 3]).mean() < 0.01
    assert abs(ours[..., 3].sum() / truth[..., 3].sum() - 1) < 0.03
    whole = (truth[..., 3] > 0.999) & (ours[..., 3] > 0.999)
    assert whole.sum() > 300 and np.abs(ours - truth)[whole].max() < 0.1 * truth[whole].max()
    rim = (ours[..., 3] > 0.05) & (ours[..., 3] < 0.95)
    assert rim.sum() > 20
    straight = ours[rim][:, :3] / ours[rim][:, 3:]
    assert np.abs(straight - np.median(ours[whole][:, :3], axis=0)).max() < 0.1 * truth[whole].max()


def test_an_alpha_from_elsewhere_makes_surfels(look, picture):
    """The image's own alpha times a constant cuts no hole: everything is transparent."""
    card = leaf_card(leaf())
    tree = card.material_slots[0].material.node_tree
    halved = tree.nodes.new("ShaderNodeMath")
    halved.operation, halved.inputs[1].default_value = "MULTIPLY", 0.5
    alpha = tree.nodes["Principled BSDF"].inputs["Alpha"]
    tree.links.new(alpha.links[0].from_socket, halved.inputs[0])
    tree.links.new(halved.outputs[0], alpha)
    assert picture()[..., 3].max() == pytest.approx(0.5, abs=0.01) and "triangles" not in counts()


def test_a_card_of_an_opaque_image_stays_polygons(look, picture):
    pixels = leaf()
    pixels[..., 3] = 1
    leaf_card(pixels)
    assert picture()[..., 3].max() == 1 and set(counts()) == {"polygon_meshes", "triangles"}


def add_normal_map(material, strength=1.0, space="TANGENT") -> None:
    """Waves along u and v, from an image."""
    u, v = np.meshgrid(*2 * [(np.arange(64) + 0.5) / 64 * 2 * np.pi])
    normals = np.stack([0.5 * np.sin(3 * u), 0.3 * np.sin(2 * v + u), np.ones_like(u)], axis=2)
    pixels = np.ones((64, 64, 4), np.float32)
    pixels[..., :3] = normals / np.linalg.norm(normals, axis=2, keepdims=True) / 2 + 0.5
    image = bpy.data.images.new("waves", 64, 64, float_buffer=True)
    image.colorspace_settings.name = "Non-Color"
    image.pixels.foreach_set(pixels.ravel())
    tree = material.node_tree
    texture, bump = tree.nodes.new("ShaderNodeTexImage"), tree.nodes.new("ShaderNodeNormalMap")
    texture.image, bump.space, bump.inputs["Strength"].default_value = image, space, strength
    tree.links.new(texture.outputs["Color"], bump.inputs["Color"])
    tree.links.new(bump.outputs["Normal"], tree.nodes["Principled BSDF"].inputs["Normal"])


@pytest.mark.parametrize(("form", "strength"), [("plane", 0.8), ("sphere", 0.4)])
def test_a_normal_map_is_as_in_cycles(form, strength, look, picture, said, switch_to_cycles):
    """Cycles dims light that grazes the surface behind a steep map, which this engine does not."""
    if form == "plane":
        bpy.ops.mesh.primitive_plane_add(size=3, rotation=(0.2, -0.3, 0.7))
    else:
        bpy.ops.mesh.primitive_uv_sphere_add(radius=1.5, segments=48, ring_count=24)
        bpy.ops.object.shade_smooth()
    mesh = bpy.context.object.data
    mesh.materials.append(principled(Roughness=0.8, Specular_IOR_Level=0.0))
    add_sun(look, rotation=(0.3, 0.2, 0))
    smooth = picture()
    add_normal_map(mesh.materials[0], strength=strength)
    ours = picture()
    assert set(counts()) == {"polygon_meshes", "triangles"} and "normal map" not in said()
    switch_to_cycles(samples=64)
    look.cycles.max_bounces = 0
    truth = picture()
    assert as_cycles_has_it(ours, truth, share=0.05)
    assert not as_cycles_has_it(smooth, ours, share=0.05)


def add_gloss(material, sizes, turned=False) -> None:
    """Roughness and metallic from green and blue of one image, or from two. turned: the second lies elsewhere."""
    tree, made = material.node_tree, []
    for size in sizes:
        u, v = np.meshgrid(*2 * [(np.arange(size) + 0.5) / size * 2 * np.pi])
        pixels = np.ones((size, size, 4), np.float32)
        pixels[..., 1], pixels[..., 2] = 0.55 + 0.25 * np.sin(2 * u), 0.5 + 0.5 * np.sin(3 * v)
        image = bpy.data.images.new("gloss", size, size, float_buffer=True)
        image.colorspace_settings.name = "Non-Color"
        image.pixels.foreach_set(pixels.ravel())
        texture, parts = tree.nodes.new("ShaderNodeTexImage"), tree.nodes.new("ShaderNodeSeparateColor")
        texture.image = image
        tree.links.new(texture.outputs["Color"], parts.inputs[0])
        made.append(parts)
    if turned:
        mapping, place = tree.nodes.new("ShaderNodeMapping"), tree.nodes.new("ShaderNodeTexCoord")
        mapping.inputs["Rotation"].default_value[2] = 0.5
        tree.links.new(place.outputs["UV"], mapping.inputs[0])
        tree.links.new(mapping.outputs[0], made[-1].inputs[0].links[0].from_node.inputs[0])
    shader = tree.nodes["Principled BSDF"]
    tree.links.new(made[0].outputs["Green"], shader.inputs["Roughness"])
    tree.links.new(made[-1].outputs["Blue"], shader.inputs["Metallic"])


@pytest.mark.parametrize("sizes", [(64,), (64, 32)], ids=["one image", "two images"])
def test_roughness_and_metallic_images_are_as_in_cycles(sizes, look, picture, said, switch_to_cycles):
    bpy.ops.mesh.primitive_plane_add(size=3, rotation=(0.2, -0.3, 0.7))
    mesh = bpy.context.object.data
    mesh.materials.append(principled(Base_Color=(0.8, 0.5, 0.3, 1)))
    add_sun(look, rotation=(-0.2, 0.5, 0))
    plain = picture()
    add_gloss(mesh.materials[0], sizes)
    ours = picture()
    assert set(counts()) == {"polygon_meshes", "triangles"} and "for its" not in said()
    switch_to_cycles(samples=64)
    look.cycles.max_bounces = 0
    assert as_cycles_has_it(ours, picture(), share=0.05)
    assert np.abs(plain - ours).max() > 0.1


def test_images_at_two_places_are_named(look, picture, said):
    bpy.ops.mesh.primitive_plane_add(size=3)
    bpy.context.object.data.materials.append(principled())
    add_gloss(bpy.context.object.data.materials[0], (8, 8), turned=True)
    bpy.context.object.surfel_splatting.render_as = "POLYGONS"
    picture()
    assert "has an image or nodes for its metallic and roughness" in said()


def test_a_normal_map_that_polygons_do_not_show_is_named(look, picture, said):
    bpy.ops.mesh.primitive_cube_add()
    bpy.context.object.data.materials.append(principled())
    add_normal_map(bpy.context.object.data.materials[0], space="OBJECT")
    bpy.context.object.surfel_splatting.render_as = "POLYGONS"
    picture()
    assert "Cube has a normal map that is not one image in tangent space" in said()


@pytest.mark.parametrize("channel", ["Emission Color", "Roughness", "Base Color"])
def test_images_that_polygons_show_at_corners_alone_are_named(channel, look, picture, said):
    """The images of colour and roughness are looked up pixel by pixel, and that of the emission is not."""
    bpy.ops.mesh.primitive_cube_add()
    material = principled(Emission_Strength=1.0)
    bpy.context.object.data.materials.append(material)
    bpy.context.object.surfel_splatting.render_as = "POLYGONS"
    node = material.node_tree.nodes.new("ShaderNodeTexImage")
    node.image = bpy.data.images.new("spots", 4, 4)
    material.node_tree.links.new(node.outputs["Color"], material.node_tree.nodes["Principled BSDF"].inputs[channel])
    picture()
    name = {"Emission Color": "emission"}.get(channel)
    told = said()
    assert (f"Cube has an image or nodes for its {name}, of which polygons show only" in told) == (name is not None)
    assert ("at their corners" in told) == (name is not None)


@pytest.mark.parametrize("kind", ["VolumeScatter", "BsdfTransparent", "Holdout"])
def test_a_mesh_whose_material_covers_nothing_is_not_drawn(kind, look, picture):
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
