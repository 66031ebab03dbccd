# SPDX-License-Identifier: GPL-3.0-or-later
"""A small animated scene in a file of its own, and a way to call the commands as the command line does."""

import math
import shutil
from pathlib import Path

import bpy
import numpy as np
import pytest

from splat_addon.blender import commands

SIZE = (48, 32)


@pytest.fixture(scope="session")
def animation_file(add_on, tmp_path_factory) -> Path:
    """A file with a ball of surfels that moves over frames 1 to 4 and shadows a floor of polygons."""
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    scene = bpy.context.scene
    scene.render.engine = "SURFEL_SPLATTING"
    bpy.ops.mesh.primitive_uv_sphere_add(segments=16, ring_count=8, radius=0.8, location=(-1, 0, 0.8))
    ball = bpy.context.object
    bpy.ops.object.surfels_from_mesh(resolution=24, source="HIDE")
    surfels = bpy.context.object
    for frame, x in ((1, -1.0), (4, 1.0)):
        surfels.location.x = x
        surfels.keyframe_insert("location", frame=frame)
    bpy.ops.mesh.primitive_plane_add(size=6)
    bpy.context.object.name = "floor"
    sun = bpy.data.objects.new("sun", bpy.data.lights.new("sun", "SUN"))
    sun.rotation_euler = (0.6, 0.4, 0)
    camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    camera.location, camera.rotation_euler = (0, -7, 4), (math.radians(62), 0, 0)
    for each in (sun, camera):
        scene.collection.objects.link(each)
    scene.camera = camera
    scene.render.resolution_x, scene.render.resolution_y = SIZE
    scene.frame_start, scene.frame_end = 1, 4
    scene.surfel_splatting.samples = scene.surfel_splatting.blur_samples = 2
    settings = scene.render.image_settings
    settings.file_format, settings.color_depth, settings.color_mode = "OPEN_EXR", "32", "RGBA"
    scene.render.filepath = "//frame_"
    ball.name = "ball"
    file = tmp_path_factory.mktemp("animation") / "anim.blend"
    bpy.ops.wm.save_as_mainfile(filepath=str(file))
    return file


@pytest.fixture
def animation(animation_file, empty_file, tmp_path):
    """The scene of a file of one's own, anim.blend in tmp_path, as animation_file makes it."""
    file = shutil.copy(animation_file, tmp_path / "anim.blend")
    bpy.ops.wm.open_mainfile(filepath=str(file))
    return bpy.context.scene


@pytest.fixture
def surfels_command(capfd):
    """surfels_command(*arguments) -> the command's exit code and what it printed."""

    def run(*arguments) -> tuple[int, str]:
        capfd.readouterr()
        code = commands.run([str(argument) for argument in arguments])
        out, err = capfd.readouterr()
        return code, out + err

    return run


@pytest.fixture
def pixels():
    """pixels(path) -> (h, w, 4) float32 of a picture, row 0 at the bottom."""

    def read(path: Path) -> np.ndarray:
        image = bpy.data.images.load(str(path))
        image.colorspace_settings.is_data = True
        values = np.empty(image.size[0] * image.size[1] * 4, np.float32)
        image.pixels.foreach_get(values)
        values = values.reshape(image.size[1], image.size[0], 4)
        bpy.data.images.remove(image)
        return values

    return read
