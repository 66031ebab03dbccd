# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs in a separate Blender: installs the zip, converts a cube, renders it, and reports the results.

PYTHON -I session.py -- ZIP REPORT.json
"""

import json
import runpy
import sys
from pathlib import Path

import bpy
import numpy as np

MODULE = "bl_ext.user_default.surfel_splatting"
SIZE = 64


def main(package: str, report: Path) -> dict:
    """Collect facts for the tests, in the order in which they become available."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.extensions.package_install_files(repo="user_default", filepath=package, enable_on_install=True)
    facts = {"enabled": MODULE in bpy.context.preferences.addons, "path": list(sys.path)}
    facts["files"] = [m.__file__ for name, m in sys.modules.items() if "splat_addon" in name and m.__file__]
    bpy.ops.mesh.primitive_cube_add(size=2)
    cube = bpy.context.object
    bpy.ops.object.surfels_from_mesh(resolution=32, use_adaptive=False)
    facts["surfels"] = [len(o.data.vertices) for o in bpy.data.objects if o.type == "MESH" and o is not cube]
    facts["pixels"] = picture(report.with_name("picture.exr")).tolist()
    facts["once"] = handlers()
    bpy.ops.script.reload()
    facts["reloaded"] = handlers()
    bpy.ops.preferences.addon_disable(module=MODULE)
    facts["left"] = [name for name in ("surfel_splatting", "surfel_conversion") if hasattr(bpy.types.Scene, name)]
    facts["left"] += handlers()
    bpy.ops.preferences.addon_enable(module=MODULE)
    facts["again"] = handlers()
    facts["pixels_again"] = picture(report.with_name("again.exr")).tolist()
    return facts


def handlers() -> list[str]:
    """The extension's functions among Blender's handlers."""
    lists = [value for name in dir(bpy.app.handlers) if isinstance(value := getattr(bpy.app.handlers, name), list)]
    return sorted(f.__qualname__ for functions in lists for f in functions if f.__module__.startswith(MODULE))


def picture(file: Path) -> np.ndarray:
    """The (4, 4) rgba of one pixel in the middle and three in corners, rendered from straight above the cube."""
    scene = bpy.context.scene
    for old in [each for each in scene.objects if each.type in {"CAMERA", "LIGHT"}]:
        bpy.data.objects.remove(old)
    camera = bpy.data.cameras.new("above")
    camera.type, camera.ortho_scale = "ORTHO", 4.0
    scene.camera = bpy.data.objects.new("above", camera)
    scene.camera.location.z = 10
    scene.collection.objects.link(scene.camera)
    sun = bpy.data.objects.new("sun", bpy.data.lights.new("sun", "SUN"))
    scene.collection.objects.link(sun)
    scene.render.engine = "SURFEL_SPLATTING"
    scene.render.film_transparent = True
    scene.render.resolution_x = scene.render.resolution_y = SIZE
    scene.render.image_settings.file_format = "OPEN_EXR"
    scene.render.image_settings.color_mode = "RGBA"
    scene.render.filepath = str(file)
    bpy.ops.render.render(write_still=True)
    image = bpy.data.images.load(str(file))
    values = np.empty(SIZE * SIZE * 4, np.float32)
    image.pixels.foreach_get(values)
    return values.reshape(SIZE, SIZE, 4)[[32, 2, 2, 61], [32, 2, 61, 61]]


def report_facts() -> None:
    package, report = sys.argv[sys.argv.index("--") + 1 :]
    Path(report).write_text(json.dumps(main(package, Path(report))))


# Imported by its file, because the checkout must not be on the path.
leaving = runpy.run_path(str(Path(__file__).resolve().parents[2] / "scripts" / "environment" / "leaving.py"))
leaving["run_and_leave"](report_facts)
