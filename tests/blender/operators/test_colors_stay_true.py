# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfels take every later edit of their materials, images and slots, or say that they cannot."""

import bpy
import numpy as np
import pytest

from splat_addon.blender.conversion import color_watch
from splat_addon.blender.conversion.color_watch import out_of_date, refresh
from splat_addon.blender.export.live_meshes import LiveMeshes
from splat_addon.blender.export.scene import export_scene
from splat_addon.blender.export.surfel_store import SurfelStore
from splat_addon.blender.geometry.points_proxy import shown_points
from splat_addon.blender.geometry.stored_surfels import read_surfels
from splat_addon.surfels import field_values

SETTINGS = {"density": "RESOLUTION", "resolution": 16, "clips_edges": False, "use_adaptive": False}


@pytest.fixture
def painted(cube):
    """The cube with texture coordinates, a colour attribute, and two materials: one of an image, one plain."""
    image = bpy.data.images.new("picture", 8, 8)
    fill(image, 1)
    first, second = new_material("first", (1, 1, 1)), new_material("second", (0.1, 0.6, 0.2))
    node = first.node_tree.nodes.new("ShaderNodeTexImage")
    node.image = image
    first.node_tree.links.new(node.outputs["Color"], shader_of(first).inputs["Base Color"])
    for material in (first, second):
        cube.data.materials.append(material)
    cube.data.polygons.foreach_set("material_index", [0, 1, 0, 1, 0, 1])
    colors = cube.data.color_attributes.new("paint", "FLOAT_COLOR", "CORNER")
    colors.data.foreach_set("color", np.tile([0.2, 0.4, 0.6, 1.0], 24))
    return cube


def new_material(name, color):
    made = bpy.data.materials.new(name)
    if made.node_tree is None:
        made.use_nodes = True
    shader_of(made).inputs["Base Color"].default_value = (*color, 1)
    return made


def shader_of(material):
    return next(node for node in material.node_tree.nodes if node.type == "BSDF_PRINCIPLED")


def fill(image, seed):
    pixels = np.random.default_rng(seed).random((8, 8, 4), np.float32)
    pixels[..., 3] = 1
    image.pixels.foreach_set(pixels.ravel())
    image.update()


def recolour(cube):
    shader_of(cube.data.materials[1]).inputs["Base Color"].default_value = (0.9, 0.1, 0.3, 1)


def feed(material, socket, node_type, output, **properties):
    node = material.node_tree.nodes.new(node_type)
    for name, value in properties.items():
        setattr(node, name, value)
    material.node_tree.links.new(node.outputs[output], shader_of(material).inputs[socket])
    return node


def map_normals(cube):
    material = cube.data.materials[0]
    bumps = feed(material, "Normal", "ShaderNodeNormalMap", "Normal")
    picture = next(node for node in material.node_tree.nodes if node.type == "TEX_IMAGE")
    material.node_tree.links.new(picture.outputs["Color"], bumps.inputs["Color"])


EDITS = {
    "a colour": recolour,
    "pixels": lambda cube: fill(bpy.data.images["picture"], 2),
    "another node": lambda cube: feed(
        cube.data.materials[1], "Base Color", "ShaderNodeAttribute", "Color", attribute_name="paint"
    ),
    "roughness by place": lambda cube: feed(
        cube.data.materials[0], "Roughness", "ShaderNodeTexChecker", "Factor" if bpy.app.version >= (5, 2) else "Fac"
    ),
    "normals": map_normals,
    "opacity": lambda cube: setattr(shader_of(cube.data.materials[1]).inputs["Alpha"], "default_value", 0.25),
    "a slot": lambda cube: setattr(cube.material_slots[1], "material", new_material("third", (0.3, 0.2, 0.9))),
    "the slots of faces": lambda cube: cube.data.polygons.foreach_set("material_index", [1, 1, 1, 0, 0, 0]),
    "texture coordinates": lambda cube: [
        setattr(each, "uv", (each.uv[1], each.uv[0] / 2)) for each in cube.data.uv_layers[0].data
    ],
}


def test_surfels_become_as_a_new_conversion_makes_them(painted, convert, surfels_of):
    [made] = convert(source="HIDE", **SETTINGS)
    for name, edit in EDITS.items():
        before = surfels_of(made)
        edit(painted)
        refresh(bpy.context)
        assert out_of_date(made) is None, name
        found = surfels_of(made)
        select(made)
        bpy.ops.object.surfels_update()
        expected = surfels_of(made)
        assert len(found) == len(expected) == len(before)
        assert any(off(before, found, field).max() > 0.05 for field in expected.arrays()), name
        for field in expected.arrays():
            assert off(found, expected, field).max() < 2e-3, (name, field)
        assert found.arrays().keys() == expected.arrays().keys(), name


def off(a, b, field):
    return np.abs(field_values(a, field).astype(float) - field_values(b, field))


def select(*objects):
    for each in bpy.context.selected_objects:
        each.select_set(False)
    for each in objects:
        each.select_set(True)
    bpy.context.view_layer.objects.active = objects[0]


def test_only_what_was_edited_is_painted(painted, convert, surfels_of):
    [made] = convert(**SETTINGS)
    refresh(bpy.context)
    # as if a user had painted the surfels themselves
    made.data.attributes["Col"].data.foreach_set("color", np.tile([0.5, 0.5, 0.5, 1.0], len(made.data.vertices)))
    refresh(bpy.context)
    assert (surfels_of(made).colors[:, :3] == 0.5).all()
    recolour(painted)
    refresh(bpy.context)
    is_second, colors = surfels_of(made).materials == 1, surfels_of(made).colors[:, :3]
    assert is_second.any() and np.allclose(colors[is_second], (0.9, 0.1, 0.3))
    assert (colors[~is_second] == 0.5).all()


def test_a_slot_of_the_surfels_leads_until_the_source_has_another(painted, convert, surfels_of):
    [made] = convert(**SETTINGS)
    made.data.materials[1] = new_material("own", (0.7, 0.7, 0.1))
    refresh(bpy.context)
    second = surfels_of(made).materials == 1
    assert np.allclose(surfels_of(made).colors[second, :3], (0.7, 0.7, 0.1))
    painted.data.materials[1] = new_material("of the source", (0.2, 0.7, 0.7))
    refresh(bpy.context)
    assert made.data.materials[1].name == "of the source"
    assert np.allclose(surfels_of(made).colors[second, :3], (0.2, 0.7, 0.7))


def test_a_render_paints_first(painted, convert, surfels_of):
    [made] = convert(**SETTINGS)
    recolour(painted)
    scene = bpy.context.scene
    scene.render.engine, scene.render.resolution_x, scene.render.resolution_y = "SURFEL_SPLATTING", 8, 8
    bpy.ops.object.camera_add()
    scene.camera = bpy.context.object
    bpy.ops.render.render()
    assert np.allclose(surfels_of(made).colors[surfels_of(made).materials == 1, :3], (0.9, 0.1, 0.3))


def test_bent_surfels_keep_their_bend_and_take_a_normal_map(painted, convert, surfels_of):
    painted.shape_key_add(name="Basis")
    key = painted.shape_key_add(name="taller")
    for point in key.points:
        point.co.z *= 2
    [made] = convert(**SETTINGS)
    key.value = 1.0
    map_normals(painted)
    recolour(painted)
    refresh(bpy.context)
    found = evaluated(made)
    assert np.isclose(np.ptp(found.positions[:, 2]), 4, atol=0.1)
    assert np.allclose(found.colors[found.materials == 1, :3], (0.9, 0.1, 0.3))
    tilt = np.linalg.norm(found.normals - found.geometric_normals(), axis=1)
    assert tilt[found.materials == 0].max() > 0.2 and tilt[found.materials == 1].max() < 1e-2


def evaluated(made):
    with shown_points(made.evaluated_get(bpy.context.evaluated_depsgraph_get())) as points:
        return read_surfels(points)[0]


def test_joined_sources_are_painted_too(painted, convert, surfels_of):
    bpy.ops.mesh.primitive_cube_add(location=(4, 0, 0))
    other = bpy.context.object
    other.data.materials.append(new_material("other", (0.5, 0.1, 0.1)))
    select(painted, other)
    [made] = convert(join=True, **SETTINGS)
    shader_of(other.data.materials[0]).inputs["Base Color"].default_value = (0.1, 0.1, 0.9, 1)
    refresh(bpy.context)
    surfels = surfels_of(made)
    is_other = surfels.materials == 2
    assert is_other.any() and np.allclose(surfels.colors[is_other, :3], (0.1, 0.1, 0.9))


def test_undone_edits_are_undone_in_the_surfels(painted, convert, surfels_of):
    [made] = convert(**SETTINGS)
    bpy.ops.ed.undo_push(message="converted")
    before, name = surfels_of(made).colors, made.name
    recolour(painted)
    bpy.ops.ed.undo_push(message="edited")
    refresh(bpy.context)
    edited = surfels_of(made).colors
    for step, expected in ((bpy.ops.ed.undo, before), (bpy.ops.ed.redo, edited)):
        step()
        refresh(bpy.context)
        assert (surfels_of(bpy.data.objects[name]).colors == expected).all()
    assert (before != edited).any()


def test_edits_are_noticed_in_the_next_session_and_linked_surfels_are_out_of_date(painted, convert, tmp_path):
    [made] = convert(**SETTINGS)
    for image in bpy.data.images:
        image.pack()
    name, path = made.name, str(tmp_path / "painted.blend")
    refresh(bpy.context)
    before = colors_of(made)
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.open_mainfile(filepath=path)
    refresh(bpy.context)
    made = bpy.data.objects[name]
    assert (colors_of(made) == before).all() and out_of_date(made) is None
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    with bpy.data.libraries.load(path, link=True) as (_, taken):
        taken.objects = [name]
    bpy.context.collection.objects.link(taken.objects[0])
    bpy.context.view_layer.update()
    refresh(bpy.context)
    assert out_of_date(taken.objects[0]) is None
    shader_of(bpy.data.materials["second"]).inputs["Base Color"].default_value = (0.9, 0.1, 0.3, 1)
    refresh(bpy.context)
    assert "they belong to a linked file" in out_of_date(taken.objects[0])


def lose_a_face(cube, made):
    mesh = bpy.data.meshes.new("five faces")
    mesh.from_pydata([v.co for v in cube.data.vertices], [], [list(f.vertices) for f in cube.data.polygons][:5])
    for material in cube.data.materials:
        mesh.materials.append(material)
    cube.data = mesh


def lose_the_image(cube, made):
    image = bpy.data.images.new("lost", 4, 4)
    image.source, image.filepath = "FILE", "/nowhere/lost.png"
    next(node for node in cube.data.materials[0].node_tree.nodes if node.type == "TEX_IMAGE").image = image


def store(cube, made):
    select(made)
    bpy.ops.object.surfels_to_file(filepath=bpy.app.tempdir + "stored.surfels")


IMPOSSIBLE = {
    "its source was deleted": lambda cube, made: bpy.data.objects.remove(cube),
    "its source has other faces than when it was converted": lose_a_face,
    "its source 'Cube' is not in this view layer": lambda cube, made: bpy.context.collection.objects.unlink(cube),
    "surfels were added or removed": lambda cube, made: made.data.vertices.add(1),
    "they are in a file of their own": store,
    "the file of the image 'lost' is missing": lose_the_image,
}


@pytest.mark.parametrize("why", IMPOSSIBLE)
def test_what_cannot_be_painted_is_said(why, painted, convert):
    [made] = convert(source="KEEP", **SETTINGS)
    material = painted.data.materials[1]
    IMPOSSIBLE[why](painted, made)
    shader_of(material).inputs["Base Color"].default_value = (0.9, 0.1, 0.3, 1)
    before = colors_of(made)
    refresh(bpy.context)
    sentence = f"The colours of 'Cube surfels' are out of date: {why}; update its surfels"
    assert out_of_date(made) == sentence and (colors_of(made) == before).all()
    assert sentence in notes_of()
    if why == "they are in a file of their own":
        bpy.ops.object.surfels_update()
        refresh(bpy.context)
        assert out_of_date(made) is None


def test_a_frozen_copy_stays_and_says_so_until_it_is_updated(painted, convert, surfels_of):
    [made] = convert(source="KEEP", follow=False, **SETTINGS)
    recolour(painted)
    before = colors_of(made)
    refresh(bpy.context)
    assert (colors_of(made) == before).all() and "they are a frozen copy" in out_of_date(made)
    select(made)
    bpy.ops.object.surfels_update()
    refresh(bpy.context)
    assert out_of_date(made) is None
    assert np.allclose(surfels_of(made).colors[surfels_of(made).materials == 1, :3], (0.9, 0.1, 0.3))


def test_the_timer_goes_on_until_all_is_painted(painted, convert, surfels_of):
    [made] = convert(**SETTINGS)
    recolour(painted)
    while color_watch._continue() is not None:
        pass
    assert np.allclose(surfels_of(made).colors[surfels_of(made).materials == 1, :3], (0.9, 0.1, 0.3))


def colors_of(made):
    values = np.empty(4 * len(made.data.vertices), np.float32)
    made.data.attributes["Col"].data.foreach_get("color", values)
    return values


def notes_of():
    store, live = SurfelStore(), LiveMeshes()
    store.begin_frame()
    live.begin_frame()
    return export_scene(bpy.context.evaluated_depsgraph_get(), store, live)[1].sentences()


def test_an_animated_material_is_named(painted, convert):
    (made,) = convert(**SETTINGS)
    assert out_of_date(made) is None
    shader = shader_of(painted.data.materials[1])
    shader.inputs["Base Color"].keyframe_insert("default_value", frame=1)
    assert out_of_date(made).startswith("The material 'second' of 'Cube surfels' is animated")
