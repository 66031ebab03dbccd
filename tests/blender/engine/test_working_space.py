# SPDX-License-Identifier: GPL-3.0-or-later
"""In a file whose working space is not Rec. 709, every kind of colour is drawn as Cycles draws it."""

from dataclasses import replace

import bpy
import numpy as np
import pytest
from mathutils import Color

from splat_addon.blender.engine import final_render
from splat_addon.interchange import write_ply

pytestmark = pytest.mark.skipif(not hasattr(bpy.data, "colorspace"), reason="this Blender has no working space")

ENCODED = np.array((200, 60, 40)) / 255


@pytest.fixture
def row(scene, add_camera):
    """row(nodes of an Emission shader, ...) -> objects side by side, 1 unit and 4 pixels wide each."""

    def make(*builds):
        made = []
        for place, build in enumerate(builds):
            bpy.ops.mesh.primitive_plane_add(size=1, location=(place - len(builds) / 2 + 0.5, 0, 0))
            made.append(bpy.context.object)
            material = bpy.data.materials.new("row")
            tree = material.node_tree
            tree.nodes.clear()
            end, shader = tree.nodes.new("ShaderNodeOutputMaterial"), tree.nodes.new("ShaderNodeEmission")
            tree.links.new(shader.outputs[0], end.inputs[0])
            build(made[-1].data, tree, shader.inputs["Color"])
            made[-1].data.materials.append(material)
        add_camera(type="ORTHO", ortho_scale=len(builds))
        scene.render.resolution_x, scene.render.resolution_y = 4 * len(builds), 4
        scene.surfel_splatting.shading = "principled"
        return made

    return make


def plain(mesh, tree, into):
    into.default_value = (*ENCODED, 1)


def image(space, is_float=False):
    def build(mesh, tree, into):
        made = bpy.data.images.new("image", 2, 2, float_buffer=is_float)
        made.colorspace_settings.name = space
        made.pixels.foreach_set(np.tile(np.float32((*ENCODED, 1)), 4))
        made.pack()
        node = tree.nodes.new("ShaderNodeTexImage")
        node.image = made
        tree.links.new(node.outputs[0], into)

    return build


def attribute(kind):
    def build(mesh, tree, into):
        made = mesh.color_attributes.new("C", kind, "CORNER")
        made.data.foreach_set("color", np.tile(np.float32((*ENCODED, 1)), 4))
        node = tree.nodes.new("ShaderNodeVertexColor")
        node.layer_name = "C"
        tree.links.new(node.outputs[0], into)

    return build


def blackbody(mesh, tree, into):
    node = tree.nodes.new("ShaderNodeBlackbody")
    node.inputs[0].default_value = 3000
    tree.links.new(node.outputs[0], into)


KINDS = (
    plain,
    *map(image, ("sRGB", "Rec.2020", "AgX Base sRGB", "Non-Color")),
    image("Linear Rec.709", True),
    *map(attribute, ("BYTE_COLOR", "FLOAT_COLOR")),
)


def by_cycles(scene, picture):
    engine, scene.render.engine = scene.render.engine, "CYCLES"
    scene.cycles.samples, scene.cycles.use_denoising, scene.cycles.filter_width = 1, False, 0.01
    truth = picture()
    scene.render.engine = engine
    return truth


def middles(pixels):
    return pixels[2, 2::4, :3]


def change_to(space):
    assert bpy.ops.wm.set_working_color_space(working_space=space) == {"FINISHED"}


def test_polygons_surfels_and_bakes_have_the_colours_of_cycles(scene, row, picture, convert):
    change_to("ACEScg")
    objects = row(*KINDS, blackbody)
    truth = middles(by_cycles(scene, picture))
    # of a blackbody, polygons have the plain value, which a note says
    assert np.allclose(middles(picture())[:-1], truth[:-1], atol=2e-3)
    for made in objects:
        made.select_set(True)
    convert(resolution=8, bake_materials=True)
    assert np.allclose(middles(picture()), truth, atol=2e-3)


def test_surfels_keep_their_looks_when_the_space_changes_and_a_note_names_other_engines(scene, row, picture, convert):
    for made in row(image("sRGB"), image("ACEScg")):
        made.select_set(True)
    convert(resolution=8)
    change_to("Linear Rec.2020")
    shown = middles(picture())
    assert np.allclose(shown[0], Color(ENCODED).from_srgb_to_scene_linear()[:], atol=1e-4)
    assert np.allclose(shown[1], Color(ENCODED).from_acescg_to_scene_linear()[:], atol=1e-4)
    assert [note for note in final_render.last_frame_stats["notes"] if "another working space" in note] == [
        "Colours of surfels are of another working space than the file's; this engine converts them, other engines do "
        "not: convert Plane surfels and 1 more again"
    ]


def test_worlds_and_files_of_surfels_are_in_the_working_space(scene, add_camera, random_surfels, picture, tmp_path):
    change_to("ACEScg")
    add_camera()
    scene.render.film_transparent = False
    scene.world = bpy.data.worlds.new("world")
    background = scene.world.node_tree.nodes["Background"]
    sky = scene.world.node_tree.nodes.new("ShaderNodeTexEnvironment")
    sky.image = bpy.data.images.new("sky", 4, 2)
    sky.image.pixels.foreach_set(np.tile(np.float32((*ENCODED, 1)), 8))
    sky.image.pack()
    scene.world.node_tree.links.new(sky.outputs[0], background.inputs[0])
    there = Color(ENCODED).from_srgb_to_scene_linear()[:]
    assert np.allclose(picture()[..., :3], there, atol=1e-4)

    surfels = replace(random_surfels(1), positions=[[0, 0, 0]], scales=[[9, 9]], rotations=[[1, 0, 0, 0]])
    write_ply(tmp_path / "a.ply", replace(surfels, colors=[[0.9, 0.1, 0.2, 1]]))
    bpy.ops.import_scene.surfels_ply(filepath=str(tmp_path / "a.ply"))
    bpy.ops.object.surfels_to_file(filepath=str(tmp_path / "a.surfelblocks"))
    there = Color((0.9, 0.1, 0.2)).from_rec709_linear_to_scene_linear()[:]
    assert np.allclose(picture()[16, 16, :3], there, atol=1e-4)
