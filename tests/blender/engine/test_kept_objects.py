# SPDX-License-Identifier: GPL-3.0-or-later
"""What Blender does not report as changed is not read again, and pictures are those of reading everything."""

from itertools import pairwise
from pathlib import Path

import bpy
import numpy as np
import pytest

from splat_addon.blender.engine import final_render
from splat_addon.blender.export import surfel_store
from splat_addon.blender.export.changes import Changes, changes_of
from splat_addon.blender.export.live_meshes import LiveMeshes
from splat_addon.blender.export.scene import export_scene
from splat_addon.blender.export.surfel_store import SurfelStore

FRAMES = 3


def keyed(owner, path, first, last):
    for frame, value in ((1, first), (FRAMES, last)):
        setattr(owner, path, value)
        owner.keyframe_insert(path, frame=frame)


@pytest.fixture
def add_plate(add_mesh):
    """add_plate(name) -> a small square with a material of its own, beside those before it."""

    def add(name: str) -> bpy.types.Object:
        made = add_mesh(name, [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)], [(0, 1, 2, 3)])
        made.data.materials.append(bpy.data.materials.new(name))
        made.active_material.use_nodes = True
        number = sum(each.type == "MESH" for each in bpy.data.objects) - 1
        made.location = (1.25 * (number % 4) - 2.5, 1.25 * (number // 4) - 2.5, 0)
        return made

    return add


def color_of(plate):
    return plate.active_material.node_tree.nodes["Principled BSDF"].inputs["Base Color"]


def fed_by(plate, kind, output=0):
    node = plate.active_material.node_tree.nodes.new(kind)
    plate.active_material.node_tree.links.new(node.outputs[output], color_of(plate))
    return node


def bend(plate, saved_image):
    plate.shape_key_add()
    key = plate.shape_key_add(name="bent")
    key.data[0].co.x -= 0.5
    keyed(key, "value", 0.0, 1.0)


def wave(plate, saved_image):
    plate.modifiers.new("wave", "WAVE").height = 2


def paint(plate, saved_image):
    keyed(color_of(plate), "default_value", (1, 0, 0, 1), (0, 1, 0, 1))


def drive(plate, saved_image):
    color_of(plate).driver_add("default_value", 1).driver.expression = "frame / 4"


def color_by_object(plate, saved_image):
    fed_by(plate, "ShaderNodeObjectInfo", "Color")
    keyed(plate, "color", (1, 0, 0, 1), (0, 1, 0, 1))


def color_by_property(plate, saved_image):
    node = fed_by(plate, "ShaderNodeAttribute", "Fac")
    node.attribute_type, node.attribute_name = "OBJECT", "shade"
    plate["shade"] = 0.2
    plate.keyframe_insert('["shade"]', frame=1)
    plate["shade"] = 0.9
    plate.keyframe_insert('["shade"]', frame=FRAMES)


def color_by_group(plate, saved_image):
    group = bpy.data.node_groups.new("group", "ShaderNodeTree")
    group.interface.new_socket("Color", in_out="OUTPUT", socket_type="NodeSocketColor")
    inner, end = group.nodes.new("ShaderNodeRGB"), group.nodes.new("NodeGroupOutput")
    group.links.new(inner.outputs[0], end.inputs[0])
    keyed(inner.outputs[0], "default_value", (1, 0, 0, 1), (0, 1, 0, 1))
    node = plate.active_material.node_tree.nodes.new("ShaderNodeGroup")
    node.node_tree = group
    plate.active_material.node_tree.links.new(node.outputs[0], color_of(plate))


def color_by_place(plate, saved_image):
    """A texture whose place is that of another object, which moves."""
    other = bpy.data.objects.new("other", None)
    bpy.context.collection.objects.link(other)
    keyed(other, "location", (-9, 0, 0), (9, 0, 0))
    texture = fed_by(plate, "ShaderNodeTexGradient")
    places = plate.active_material.node_tree.nodes.new("ShaderNodeTexCoord")
    places.object = other
    plate.active_material.node_tree.links.new(places.outputs["Object"], texture.inputs[0])


def color_by_sequence(plate, saved_image):
    for number in range(1, FRAMES + 1):
        path = saved_image(f"{number:04}.png", (number / FRAMES, 0, 1 - number / FRAMES, 1))
    image = bpy.data.images.load(str(Path(path).with_name("0001.png")))
    image.source = "SEQUENCE"
    node = fed_by(plate, "ShaderNodeTexImage")
    node.image, node.image_user.frame_duration = image, FRAMES


def edit_in_handler(plate, saved_image):
    def edit(scene, *_):
        plate.data.vertices[2].co.z = 0.0
        plate.data.vertices[2].co.x = 0.5 + 0.2 * scene.frame_current
        plate.data.update()

    bpy.app.handlers.frame_change_post.append(edit)


CHANGES = (
    bend,
    wave,
    paint,
    drive,
    color_by_object,
    color_by_property,
    color_by_group,
    color_by_place,
    color_by_sequence,
    edit_in_handler,
)


@pytest.fixture
def animated(scene, add_camera, add_plate, saved_image):
    """The scene with a plate for each kind of change, and two that stay as they are, of which one moves."""
    add_camera(type="ORTHO", ortho_scale=6)
    for change in CHANGES:
        change(add_plate(change.__name__), saved_image)
    add_plate("still")
    keyed(add_plate("moving"), "location", (1, 1, 0), (1, 1.5, 0))
    scene.frame_start, scene.frame_end = 1, FRAMES
    yield scene
    bpy.app.handlers.frame_change_post.pop()


def pictures(scene, read_picture):
    scene.render.filepath = str(Path(scene.render.filepath).parent / "frame_####.exr")
    bpy.ops.render.render(animation=True)
    return [read_picture(scene.render.frame_path(frame=frame)) for frame in range(1, FRAMES + 1)]


@pytest.mark.parametrize("has_blur", [False, True])
def test_an_animation_reads_what_changed_and_shows_what_reading_all_of_it_shows(
    has_blur, animated, read_picture, monkeypatch
):
    animated.render.use_motion_blur = has_blur
    if has_blur:
        animated.surfel_splatting.samples = animated.surfel_splatting.motion_blur_steps = 2
    found = pictures(animated, read_picture)
    assert final_render.last_frame_stats["live_meshes"]["read"] == len(CHANGES)
    begin = LiveMeshes.begin_frame
    monkeypatch.setattr(LiveMeshes, "begin_frame", lambda self, changes=None: begin(self))
    expected = pictures(animated, read_picture)
    assert final_render.last_frame_stats["live_meshes"]["read"] == len(CHANGES) + 2
    for one, other in zip(found, expected, strict=True):
        np.testing.assert_array_equal(one, other)
    differences = [np.abs(later - earlier).max() for earlier, later in pairwise(expected)]
    assert min(differences) > 0.1


@pytest.fixture
def changes():
    """A list of what evaluations changed."""
    told = []

    def tell(scene, depsgraph):
        told.append(changes_of(depsgraph))

    bpy.app.handlers.depsgraph_update_post.append(tell)
    yield told
    bpy.app.handlers.depsgraph_update_post.remove(tell)


def test_an_edit_in_a_view_reads_the_objects_that_it_concerns(scene, add_plate, changes):
    first, second, third = map(add_plate, ("first", "second", "third"))
    second.data.materials[0] = first.data.materials[0]
    live = LiveMeshes()

    def read() -> int:
        depsgraph = bpy.context.evaluated_depsgraph_get()
        told = Changes()
        for each in changes:
            told |= each
        changes.clear()
        live.begin_frame(told)
        export_scene(depsgraph, SurfelStore(), live)
        return live.counts["read"]

    assert (read(), read()) == (3, 0)
    color_of(first).default_value = (1, 0, 0, 1)
    assert read() == 2
    third.data.vertices[0].co.z = 1
    third.data.update()
    assert read() == 1
    third.location.z = 1
    assert read() == 0


def test_surfels_that_stay_as_they_are_are_read_once_for_an_animation(
    scene, add_camera, add_surfels, read_picture, monkeypatch
):
    add_camera()
    add_surfels([(-1, 0, 0)], size=0.5, name="still")
    edited = add_surfels([(1, 0, 0)], size=0.5, name="edited")

    def edit(scene, *_):
        edited.data.attributes["Col"].data[0].color = (0, scene.frame_current / FRAMES, 0, 1)
        edited.data.update()

    read, names = surfel_store.read_stored, []
    monkeypatch.setattr(surfel_store, "read_stored", lambda *given: names.append(given[2]) or read(*given))
    scene.frame_start, scene.frame_end = 1, FRAMES
    bpy.app.handlers.frame_change_post.append(edit)
    try:
        greens = [picture[16, 19, 1] for picture in pictures(scene, read_picture)]
    finally:
        bpy.app.handlers.frame_change_post.remove(edit)
    assert sorted(names) == ["edited"] * FRAMES + ["still"]
    np.testing.assert_allclose(greens, np.arange(1, FRAMES + 1) / FRAMES, atol=1e-3)
