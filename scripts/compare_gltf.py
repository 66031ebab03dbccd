# SPDX-License-Identifier: GPL-3.0-or-later
"""A glTF model as surfels beside the same model as meshes in EEVEE (or Cycles): pictures, and how far they differ.

    PYTHON scripts/compare_gltf.py MODEL.glb [--engine BLENDER_EEVEE] [--pixels 1] [--size 320 240] [--out DIR]

PYTHON must have bpy, numpy and Pillow (the environment that scripts/test.py makes). Both pictures have one sun without
shadows and an even world, which is what both renderers can do. The picture written is: surfels, meshes, and four times
the difference.
"""

import argparse
import math
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT))

import bpy  # noqa: E402
import numpy as np  # noqa: E402
from leaving import run_and_leave  # noqa: E402
from mathutils import Vector  # noqa: E402
from PIL import Image  # noqa: E402

import splat_addon  # noqa: E402
from splat_addon.reference.metrics import psnr, srgb  # noqa: E402
from splat_addon.rendering.presets import PRESETS  # noqa: E402

BACKGROUND = 0.18
#: Of the difference, in the picture.
MAGNIFIED = 4


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("model", type=Path)
    parser.add_argument("--engine", default="BLENDER_EEVEE", help="Blender's name of the renderer of the meshes")
    parser.add_argument("--samples", type=int, default=32, help="of that renderer, a pixel")
    parser.add_argument("--preset", choices=tuple(PRESETS), default="final", help="of ours")
    parser.add_argument("--pixels", type=float, default=1.0, help="between surfels, where the model is nearest")
    parser.add_argument("--size", type=int, nargs=2, default=(320, 240))
    parser.add_argument("--angle", type=float, default=40.0, help="degrees of the camera around the model")
    parser.add_argument("--bake", action="store_true", help="bake what cannot be read")
    parser.add_argument("--out", type=Path, default=ROOT / "build")
    options = parser.parse_args()

    bpy.ops.wm.read_factory_settings(use_empty=True)
    splat_addon.register()
    bpy.ops.import_scene.gltf(filepath=str(options.model.resolve()))
    meshes = [o for o in bpy.context.view_layer.objects if o.type == "MESH" and o.visible_get()]
    scene = light_and_frame(meshes, options)
    surfels, seconds = converted(meshes, options)
    options.out.mkdir(parents=True, exist_ok=True)

    scene.render.engine = "SURFEL_SPLATTING"
    scene.surfel_splatting.shading = "principled"
    for name, value in PRESETS[options.preset].values.items():
        setattr(scene.surfel_splatting, name, value)
    ours, our_seconds = picture(scene, hidden=meshes)
    scene.render.engine = options.engine
    samples = scene.cycles if options.engine == "CYCLES" else scene.eevee
    setattr(samples, "samples" if options.engine == "CYCLES" else "taa_render_samples", options.samples)
    if options.engine == "CYCLES":
        samples.pixel_filter_type = "BOX"  # as ours
    theirs, their_seconds = picture(scene, hidden=surfels)

    both = np.minimum(ours[..., 3], theirs[..., 3]) > 0.99
    a, b = (over_background(p) for p in (ours, theirs))
    count = sum(len(made.data.vertices) for made in surfels)
    print(f"{options.model.name}: {count:,} surfels in {seconds:.1f} s")
    print(f"rendered in {our_seconds:.1f} s, {options.engine} in {their_seconds:.1f} s (with its shaders' compilation)")
    print(f"PSNR {psnr(a, b):.1f} dB over the picture, {psnr(a[both][None], b[both][None]):.1f} dB inside both")
    off = np.abs(srgb(a) - srgb(b))[both]
    print(f"mean difference inside {off.mean() * 255:.2f} of 255, 95 % below {np.percentile(off, 95) * 255:.1f}")
    path = options.out / f"{options.model.stem}-beside-{options.engine.lower()}.png"
    difference = MAGNIFIED * np.abs(srgb(a) - srgb(b))
    shown = np.concatenate([srgb(a), srgb(b), np.clip(difference, 0, 1)], axis=1)[::-1]
    Image.fromarray(np.rint(255 * shown).astype(np.uint8)).save(path, optimize=True)
    print(path)
    return 0


def light_and_frame(meshes: list[bpy.types.Object], options) -> bpy.types.Scene:
    """A sun without shadow, a grey world, and a camera that sees all of the meshes."""
    scene = bpy.context.scene
    scene.render.resolution_x, scene.render.resolution_y = options.size
    scene.render.film_transparent = True
    world = bpy.data.worlds.new("world")
    if bpy.app.version < (5, 0, 0):  # from then on every world has nodes
        world.use_nodes = True
    background = next(node for node in world.node_tree.nodes if node.type == "BACKGROUND")
    background.inputs["Color"].default_value = (0.28, 0.31, 0.35, 1.0)
    scene.world = world
    sun = bpy.data.lights.new("sun", "SUN")
    sun.energy, sun.angle, sun.use_shadow = 1.6, 0.0, False
    lamp = bpy.data.objects.new("sun", sun)
    lamp.rotation_euler = (math.radians(40), math.radians(25), math.radians(options.angle))
    camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    for new in (lamp, camera):
        scene.collection.objects.link(new)
    scene.camera = camera
    corners = np.array([o.matrix_world @ Vector(c) for o in meshes for c in o.bound_box])
    middle, radius = (corners.min(0) + corners.max(0)) / 2, np.linalg.norm(np.ptp(corners, axis=0)) / 2
    turn = math.radians(options.angle)
    towards = Vector((math.sin(turn), -math.cos(turn), 0.45)).normalized()
    distance = radius / math.tan(camera.data.angle_y / 2) if options.size[0] < options.size[1] else radius / 0.36
    camera.location = Vector(middle) + towards * distance
    camera.data.clip_start, camera.data.clip_end = distance / 100, distance * 10
    camera.rotation_euler = towards.to_track_quat("Z", "Y").to_euler()
    bpy.context.view_layer.update()
    return scene


def converted(meshes: list[bpy.types.Object], options) -> tuple[list[bpy.types.Object], float]:
    """The surfel objects of the meshes, and the seconds that it took."""
    before = set(bpy.data.objects)
    for mesh in bpy.context.view_layer.objects:
        mesh.select_set(mesh in meshes)
    started = time.perf_counter()
    bpy.ops.object.surfels_from_mesh(density="CAMERA", pixels=options.pixels, bake_materials=options.bake)
    return sorted(set(bpy.data.objects) - before, key=lambda o: o.name), time.perf_counter() - started


def picture(scene: bpy.types.Scene, hidden: list[bpy.types.Object]) -> tuple[np.ndarray, float]:
    """(h, w, 4) float32 linear, premultiplied, row 0 at the bottom, without these objects; and its seconds."""
    for one in bpy.data.objects:
        one.hide_render = one in hidden
    with tempfile.TemporaryDirectory() as folder:
        scene.render.filepath = str(Path(folder) / "picture.exr")
        if hasattr(scene.render.image_settings, "media_type"):
            scene.render.image_settings.media_type = "IMAGE"
        scene.render.image_settings.file_format = "OPEN_EXR"
        scene.render.image_settings.color_mode = "RGBA"
        scene.render.image_settings.color_depth = "32"
        started = time.perf_counter()
        bpy.ops.render.render(write_still=True)
        seconds = time.perf_counter() - started
        image = bpy.data.images.load(scene.render.filepath)
        pixels = np.empty(len(image.pixels), np.float32)
        image.pixels.foreach_get(pixels)
        width, height = image.size
        bpy.data.images.remove(image)
    return pixels.reshape(height, width, 4), seconds


def over_background(premultiplied: np.ndarray) -> np.ndarray:
    """(h, w, 3) over grey."""
    return premultiplied[..., :3] + BACKGROUND * (1 - premultiplied[..., 3:])


if __name__ == "__main__":
    run_and_leave(main)
