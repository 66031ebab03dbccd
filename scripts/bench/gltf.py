# SPDX-License-Identifier: GPL-3.0-or-later
"""Renders a model as surfels and as meshes in EEVEE or Cycles, and compares the pictures.

Both scenes have one sun without shadows and a uniform world, which both renderers support. The figure shows surfels,
meshes, and four times the difference.
"""

from __future__ import annotations

import math
import time
from pathlib import Path

import bpy
import numpy as np
from mathutils import Vector

import splat_addon
from demonstration.models import convert, import_model
from measuring.blender_scene import lit_scene, rendered
from splat_addon.reference.metrics import psnr, srgb
from splat_addon.rendering.presets import PRESETS

BACKGROUND = 0.18
#: Amplification of the difference in the figure.
MAGNIFIED = 4
QUICK = {"size": (32, 24), "pixels": 4.0, "engine": "CYCLES", "samples": 1}


def arguments(parser) -> None:
    parser.add_argument("model", type=Path, nargs="?", help="a model file; CesiumMilkTruck.glb of --models")
    parser.add_argument("--engine", default="BLENDER_EEVEE", help="Blender's name of the renderer of the meshes")
    parser.add_argument("--samples", type=int, default=32, help="of that renderer, a pixel")
    parser.add_argument("--preset", choices=tuple(PRESETS), default="final", help="of ours")
    parser.add_argument("--pixels", type=float, default=1.0, help="between surfels, where the model is nearest")
    parser.add_argument("--size", type=int, nargs=2, default=(320, 240))
    parser.add_argument("--angle", type=float, default=40.0, help="degrees of the camera around the model")
    parser.add_argument("--bake", action="store_true", help="bake what cannot be read")


def run(options, report) -> None:
    splat_addon.register()
    bpy.ops.wm.read_factory_settings(use_empty=True)
    report.header()
    model = (options.model or options.models / "CesiumMilkTruck.glb").resolve()
    meshes = import_model(model)
    scene = framed(meshes, options)
    surfels, seconds = convert(meshes, density="CAMERA", pixels=options.pixels, bake_materials=options.bake)
    scene.render.engine = "SURFEL_SPLATTING"
    scene.surfel_splatting.shading = "principled"
    for name, value in PRESETS[options.preset].render_values.items():
        setattr(scene.surfel_splatting, name, value)
    ours, our_seconds = picture(scene, hidden=meshes)
    scene.render.engine = options.engine
    if options.engine == "CYCLES":
        scene.cycles.samples, scene.cycles.pixel_filter_type = options.samples, "BOX"  # as ours
    else:
        scene.eevee.taa_render_samples = options.samples
    theirs, their_seconds = picture(scene, hidden=surfels)

    both = np.minimum(ours[..., 3], theirs[..., 3]) > 0.99
    a, b = (p[..., :3] + BACKGROUND * (1 - p[..., 3:]) for p in (ours, theirs))
    apart = np.abs(srgb(a) - srgb(b))
    count, off = sum(len(made.data.vertices) for made in surfels), 255 * apart[both]
    inside = psnr(a[both][None], b[both][None])
    times = f"{our_seconds:.1f} s, {options.engine} in {their_seconds:.1f} s"
    report.say(f"{model.name}: {count:,} surfels in {seconds:.1f} s, rendered in {times}, shaders compiled.")
    report.say(f"PSNR of sRGB {psnr(a, b):.1f} dB over the picture, {inside:.1f} dB inside both.")
    report.say(f"Mean difference inside {off.mean():.2f} of 255, 95 % below {np.percentile(off, 95):.1f}.")
    shown = [srgb(a), srgb(b), MAGNIFIED * apart]
    report.picture(f"{model.stem}-beside-{options.engine.lower()}", shown, encode=None)


def framed(meshes: list[bpy.types.Object], options) -> bpy.types.Scene:
    """A sun without shadow, a grey world, and a camera that frames all meshes."""
    turn = math.radians(options.angle)
    scene = lit_scene(options.size, (0.28, 0.31, 0.35), (math.radians(40), math.radians(25), turn), 1.6)
    scene.objects["Sun"].data.use_shadow = False
    corners = np.array([o.matrix_world @ Vector(c) for o in meshes for c in o.bound_box])
    middle, radius = (corners.min(0) + corners.max(0)) / 2, np.linalg.norm(np.ptp(corners, axis=0)) / 2
    towards, camera = Vector((math.sin(turn), -math.cos(turn), 0.45)).normalized(), scene.camera
    is_tall = options.size[0] < options.size[1]
    distance = radius / math.tan(camera.data.angle_y / 2) if is_tall else radius / 0.36
    camera.location = Vector(middle) + towards * distance
    camera.data.clip_start, camera.data.clip_end = distance / 100, distance * 10
    camera.rotation_euler = towards.to_track_quat("Z", "Y").to_euler()
    bpy.context.view_layer.update()
    return scene


def picture(scene: bpy.types.Scene, hidden: list[bpy.types.Object]) -> tuple[np.ndarray, float]:
    """(h, w, 4) picture without these objects, and its time in seconds."""
    for one in bpy.data.objects:
        one.hide_render = one in hidden
    started = time.perf_counter()
    pixels = rendered(scene)
    return pixels, time.perf_counter() - started
