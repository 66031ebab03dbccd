# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender scenes with the same lighting for every engine, and their pictures as arrays."""

from __future__ import annotations

import tempfile
from pathlib import Path

import bpy
import numpy as np

from demonstration.scene import add_light, even_world


def lit_scene(size: tuple[int, int], world, sun_turned, sun_energy: float) -> bpy.types.Scene:
    """The current scene with a uniform world, a sun, a transparent film and a camera at the origin.

    world: linear colour. sun_turned: its Euler angles.
    """
    scene = bpy.context.scene
    scene.render.resolution_x, scene.render.resolution_y = size
    scene.render.film_transparent = True
    scene.world = even_world(world)
    sun = add_light("SUN", sun_energy, (1.0, 1.0, 1.0))
    sun.data.angle, sun.rotation_euler = 0.0, sun_turned
    scene.camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    scene.collection.objects.link(scene.camera)
    return scene


def rendered(scene: bpy.types.Scene) -> np.ndarray:
    """(h, w, 4) linear, premultiplied, row 0 at the bottom."""
    settings = scene.render.image_settings
    if hasattr(settings, "media_type"):
        settings.media_type = "IMAGE"
    settings.file_format, settings.color_mode, settings.color_depth = "OPEN_EXR", "RGBA", "32"
    with tempfile.TemporaryDirectory() as folder:
        scene.render.filepath = str(Path(folder) / "picture.exr")
        bpy.ops.render.render(write_still=True)
        image = bpy.data.images.load(scene.render.filepath)
        width, height = image.size
        pixels = np.empty(4 * width * height, np.float32)
        image.pixels.foreach_get(pixels)
        bpy.data.images.remove(image)
    return pixels.reshape(height, width, 4)
