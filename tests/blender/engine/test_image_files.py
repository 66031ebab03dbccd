# SPDX-License-Identifier: GPL-3.0-or-later
"""Images of several files, UDIM tiles and sequences, are shown as Cycles shows them: on polygons and by surfels."""

import bpy
import numpy as np
import pytest

from splat_addon.blender.conversion.color_watch import out_of_date, refresh
from splat_addon.blender.materials.image_files import frame_of, frame_path, tile_path
from splat_addon.reference.metrics import psnr

SIDE = 16


def inside(picture):
    """The middles of the four quarters: at edges, pixel filters differ."""
    size = len(picture) // 2
    quarters = picture[..., :3].reshape(2, size, 2, size, 3)
    return quarters[:, 2:-2, :, 2:-2]


@pytest.fixture
def save(tmp_path):
    """save(name, seed, side) -> path of a file of smooth colours."""

    def saved(name, seed, side=SIDE) -> str:
        rows, columns = np.mgrid[:side, :side] / side
        angle = np.random.default_rng(seed).uniform(0, 6, 3)
        colors = 0.5 + 0.4 * np.sin(angle + 3 * rows[..., None] + np.outer(columns, (1, 2, 3)).reshape(side, side, 3))
        image = bpy.data.images.new(name, side, side)
        image.pixels.foreach_set(np.dstack([colors, np.ones((side, side))]).astype(np.float32).ravel())
        image.filepath_raw, image.file_format = str(tmp_path / name), "PNG"
        image.save()
        bpy.data.images.remove(image)
        return str(tmp_path / name)

    return saved


@pytest.fixture
def tiled(save):
    """Tiles 1001, 1002 and 1012, the last of which is smaller."""
    path = save("tile.1001.png", 1)
    save("tile.1002.png", 2)
    save("tile.1012.png", 3, SIDE // 2)
    image = bpy.data.images.load(path)
    image.source = "TILED"
    image.filepath = path.replace("1001", "<UDIM>")
    for number in (1002, 1012):
        image.tiles.new(number)
    return image


def material_of(image, steps=()):
    """A matt surface of an image. steps: nodes between it and the shader."""
    material = bpy.data.materials.new("shown")
    if material.node_tree is None:
        material.use_nodes = True
    tree = material.node_tree
    tree.nodes.clear()
    texture, shader, output = (tree.nodes.new(f"ShaderNode{n}") for n in ("TexImage", "BsdfDiffuse", "OutputMaterial"))
    texture.image, last = image, texture
    for kind in steps:
        node = tree.nodes.new(f"ShaderNode{kind}")
        tree.links.new(last.outputs[0], next(socket for socket in node.inputs if socket.type == "RGBA"))
        last = node
    tree.links.new(last.outputs[0], shader.inputs[0])
    tree.links.new(shader.outputs[0], output.inputs[0])
    return material


@pytest.fixture
def add_sheets(scene, add_camera):
    """Three squares, one for each tile, seen from above."""
    add_camera((1, 1, 5), type="ORTHO", ortho_scale=2.0)
    scene.render.film_transparent = False
    # matt surfaces that face nothing else have their own colour in it
    scene.world = bpy.data.worlds.new("white")
    if scene.world.node_tree is None:
        scene.world.use_nodes = True
    scene.world.node_tree.nodes["Background"].inputs["Color"].default_value = (1, 1, 1, 1)

    def add(material) -> bpy.types.Object:
        mesh = bpy.data.meshes.new("sheets")
        corners = [
            (x, y) for x, y in ((0, 0), (1, 0), (1, 1)) for x, y in ((x, y), (x + 1, y), (x + 1, y + 1), (x, y + 1))
        ]
        mesh.from_pydata([(*corner, 0) for corner in corners], [], np.arange(12).reshape(3, 4).tolist())
        mesh.uv_layers.new().uv.foreach_set("vector", np.float32(corners).ravel())
        mesh.materials.append(material)
        made = bpy.data.objects.new("sheets", mesh)
        scene.collection.objects.link(made)
        return made

    return add


@pytest.mark.parametrize("steps", [(), ("Gamma",)], ids=["image", "nodes"])
@pytest.mark.parametrize("is_packed", [False, True], ids=["files", "packed"])
def test_tiles_on_polygons(steps, is_packed, tiled, add_sheets, picture, switch_to_cycles, said):
    add_sheets(material_of(tiled, steps))
    if is_packed:
        tiled.pack()
    ours = picture()
    assert "sheets" not in said()
    switch_to_cycles(samples=16, filter_width=1.0)
    assert psnr(inside(ours), inside(picture())) > 35


def test_tiles_by_surfels(tiled, add_sheets, convert, picture, switch_to_cycles):
    sheets = add_sheets(material_of(tiled))
    bpy.context.view_layer.objects.active = sheets
    sheets.select_set(True)
    (made,) = convert(resolution=64, source="HIDE")
    ours = picture()
    made.hide_render, sheets.hide_render = True, False
    sheets.hide_set(False)
    switch_to_cycles(samples=16, filter_width=1.0)
    assert psnr(inside(ours), inside(picture())) > 30


def test_a_painted_tile_shows_before_it_is_saved(tiled, add_sheets, picture):
    add_sheets(material_of(tiled))
    before = picture()
    tiled.pixels.foreach_set(np.tile(np.float32([1, 0, 0, 1]), SIDE * SIDE))
    after = picture()
    size = len(after) // 2
    np.testing.assert_allclose(after[2 : size - 2, 2 : size - 2, :3] - (1, 0, 0), 0, atol=0.01)
    assert psnr(after[size + 2 :], before[size + 2 :]) > 50


def test_a_tile_that_is_not_there_is_named_and_magenta(tiled, add_sheets, picture, said, tmp_path):
    (tmp_path / "tile.1002.png").unlink()
    add_sheets(material_of(tiled))
    ours = picture()
    assert "lacks the tiles 1002; they are magenta" in said()
    size = len(ours) // 2
    np.testing.assert_allclose(ours[size // 2, size + size // 2, :3], (1, 0, 1), atol=0.01)


@pytest.fixture
def sequence(save):
    paths = [save(f"shot_{number:04d}.png", number) for number in (1, 2, 3)]
    image = bpy.data.images.load(paths[0])
    image.source = "SEQUENCE"
    return image


def test_a_sequence_shows_the_scene_s_frame(scene, sequence, add_sheets, picture, switch_to_cycles):
    material = material_of(sequence)
    sheets = add_sheets(material)
    sheets.data.uv_layers[0].uv.foreach_set("vector", np.float32([0, 0, 0.9, 0, 0.9, 0.9, 0, 0.9] * 3))
    user = next(node for node in material.node_tree.nodes if node.type == "TEX_IMAGE").image_user
    user.frame_duration, user.use_auto_refresh = 3, True
    ours, theirs = [], []
    for found in (ours, theirs):  # in this order
        for frame in (1, 3):
            scene.frame_set(frame)
            found.append(inside(picture()))
        switch_to_cycles(samples=16, filter_width=1.0)
    assert psnr(ours[0], ours[1]) < 20
    assert min(map(psnr, ours, theirs)) > 35


def test_surfels_of_a_sequence_are_painted_as_the_frame_of_a_still(scene, sequence, add_sheets, convert, picture):
    material = material_of(sequence)
    sheets = add_sheets(material)
    sheets.data.uv_layers[0].uv.foreach_set("vector", np.float32([0, 0, 0.9, 0, 0.9, 0.9, 0, 0.9] * 3))
    next(node for node in material.node_tree.nodes if node.type == "TEX_IMAGE").image_user.frame_duration = 3
    scene.frame_set(3)
    polygons = inside(picture())
    scene.frame_set(1)
    bpy.context.view_layer.objects.active = sheets
    sheets.select_set(True)
    (made,) = convert(resolution=64, source="HIDE")
    assert "keep the colours of one frame" in out_of_date(made)
    scene.frame_set(3)
    refresh(bpy.context)
    assert psnr(inside(picture()), polygons) > 35


def test_a_frame_that_is_not_there_is_named(scene, sequence, add_sheets, picture, said, tmp_path):
    material = material_of(sequence)
    next(node for node in material.node_tree.nodes if node.type == "TEX_IMAGE").image_user.frame_duration = 9
    add_sheets(material)
    scene.frame_set(5)
    picture()
    assert "the image sequence 'shot_0001.png', whose file 'shot_0005.png' is not there" in said()


@pytest.mark.parametrize(
    ("how", "frames"),
    # As Cycles shows them: duration, start, offset, cyclic -> the files of the frames -3, 0, 1, 2, 4, 5, 6 and 9.
    [
        ((4, 1, 0, False), (0, 0, 1, 2, 4, 4, 4, 4)),
        ((4, 1, 0, True), (1, 4, 1, 2, 4, 1, 2, 1)),
        ((2, 3, 1, False), (1, 1, 1, 1, 3, 3, 3, 3)),
        ((2, 3, 1, True), (2, 3, 2, 3, 3, 2, 3, 2)),
    ],
)
def test_which_file_of_a_sequence_shows(how, frames, scene, sequence):
    user = material_of(sequence).node_tree.nodes["Image Texture"].image_user
    user.frame_duration, user.frame_start, user.frame_offset, user.use_cyclic = how
    found = []
    for frame in (-3, 0, 1, 2, 4, 5, 6, 9):
        scene.frame_set(frame)
        found.append(frame_of(sequence, user))
    assert tuple(found) == frames


def test_names_of_files(sequence):
    assert frame_path(sequence, 12).endswith("shot_0012.png") and frame_path(sequence, 12345).endswith("shot_12345.png")
    assert tile_path("a.<UDIM>.png", 1012) == "a.1012.png" and tile_path("<UVTILE>.exr", 1012) == "u2_v2.exr"
