# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfaces that reflect what stands around them, beside Cycles: balls of metal, a car's paint, a wet floor, contact, a
kitchen, a street.

*PSNR* is that of sRGB, clamped above white, within the pixels of what reflects. Meshes are drawn as polygons with the
settings of *Balanced*; Cycles takes the same meshes. The figures show ours, Cycles and four times the difference.
"""

from __future__ import annotations

import math
import time

import bpy
import numpy as np
from mathutils import Vector

import splat_addon
from measuring.blender_scene import lit_scene, rendered
from splat_addon.reference.metrics import mean_flip, psnr, srgb
from splat_addon.rendering.presets import PRESETS
from splat_addon.whole_files import whole_file

from . import glass, places
from .objects import car_paint, contact, metal, principled, wet_floor

#: Amplification of the difference in the figure.
MAGNIFIED = 4
#: Share of a pixel that is the reflecting object's, to count.
WHOLE = 0.99
QUICK = {"size": (32, 24), "samples": 1, "scenes": ["chrome"]}


def arguments(parser) -> None:
    parser.add_argument("--size", type=int, nargs=2, default=(160, 120))
    parser.add_argument("--samples", type=int, default=256, help="of Cycles, a pixel")
    parser.add_argument("--scenes", nargs="+", choices=tuple(SCENES), default=tuple(SCENES))
    parser.add_argument("--preset", choices=tuple(PRESETS), default="balanced")
    parser.add_argument("--set", nargs="*", default=(), metavar="NAME=VALUE", help="render properties of ours")


def run(options, report) -> None:
    splat_addon.register()
    report.header()
    report.table(
        ["scene", "PSNR within", "of the picture", "FLIP", "first, s", "again, s"], list(rows(options, report))
    )


def rows(options, report):
    for name in report.steps(options.scenes, "scenes"):
        scene, reflecting = prepared(name, options)
        scene.render.engine = "CYCLES"
        scene.cycles.samples, scene.cycles.use_denoising, scene.cycles.pixel_filter_type = options.samples, False, "BOX"
        truth = truth_of(name, scene, options)
        chosen(scene, options)
        times = []
        for _ in range(2):
            started = time.perf_counter()
            ours = rendered(scene)
            times.append(time.perf_counter() - started)
        within = mask(scene, reflecting)
        ours, truth = ours[..., :3], truth[..., :3]
        inside = psnr(ours[within][None], truth[within][None])
        apart = np.abs(srgb(ours) - srgb(truth))
        report.picture(f"{name}-beside-cycles", [srgb(ours), srgb(truth), MAGNIFIED * apart], encode=None)
        flip = mean_flip(ours, truth)
        yield name, f"{inside:.1f}", f"{psnr(ours, truth):.1f}", f"{flip:.3f}", *(f"{t:.2f}" for t in times)


def truth_of(name: str, scene: bpy.types.Scene, options) -> np.ndarray:
    """Cycles' picture, kept in the folder of the report."""
    kept = options.out / f"{name}-{options.size[0]}-{options.samples}.npy"
    if not kept.exists():
        with whole_file(kept, np.load) as stream:
            np.save(stream, rendered(scene))
    return np.load(kept)


def chosen(scene: bpy.types.Scene, options) -> None:
    """Our engine with the preset, and what was set by hand."""
    scene.render.engine, ours = "SURFEL_SPLATTING", scene.surfel_splatting
    for name, value in PRESETS[options.preset].render_values.items():
        setattr(ours, name, value)
    for pair in options.set:
        name, _, value = pair.partition("=")
        setattr(ours, name, type(getattr(ours, name))(float(value)))


def mask(scene: bpy.types.Scene, reflecting: list[bpy.types.Object]) -> np.ndarray:
    """(h, w) bool: the pixels in which Cycles sees nothing but these objects. The scene's materials are lost."""
    glowing, black = flat("glowing", 1.0), flat("black", 0.0)
    for one in scene.objects:
        if one.type == "MESH":
            one.data.materials.clear()
            one.data.materials.append(glowing if one in reflecting else black)
        one.hide_render = one.type == "LIGHT"
    scene.render.engine, scene.cycles.samples, scene.world = "CYCLES", 16, None
    return rendered(scene)[..., 0] > WHOLE


def flat(name: str, strength: float) -> bpy.types.Material:
    made = principled(name, base=(0, 0, 0), roughness=1.0, specular_ior_level=0.0)
    shader = made.node_tree.nodes["Principled BSDF"].inputs
    shader["Emission Color"].default_value, shader["Emission Strength"].default_value = (1, 1, 1, 1), strength
    return made


def prepared(name: str, options) -> tuple[bpy.types.Scene, list[bpy.types.Object]]:
    bpy.ops.wm.read_factory_settings(use_empty=True)
    world, eye, target, lens, make = SCENES[name]
    scene = lit_scene(options.size, world, (math.radians(40), math.radians(25), 0.5), 2.5 if name != "contact" else 0.0)
    scene.render.film_transparent = False
    scene.camera.location, scene.camera.data.lens = eye, lens
    scene.camera.rotation_euler = (Vector(eye) - Vector(target)).to_track_quat("Z", "Y").to_euler()
    reflecting = make()
    bpy.context.view_layer.update()
    return scene, reflecting


_EYE, _TARGET = (0.6, -3.4, 1.5), (0, 0.1, 0.45)
#: name -> linear colour of the world, camera, what it looks at, its focal length, and what makes the objects
SCENES = {
    "chrome": ((0.5, 0.6, 0.75), _EYE, _TARGET, 50, metal(0.0)),
    "rough": ((0.5, 0.6, 0.75), _EYE, _TARGET, 50, metal(0.35)),
    "paint": ((0.5, 0.6, 0.75), _EYE, _TARGET, 50, car_paint),
    "wet": ((0.5, 0.6, 0.75), _EYE, _TARGET, 40, wet_floor),
    "kitchen": ((0.6, 0.62, 0.65), (0.9, -2.4, 1.75), (0, 0.8, 0.8), 35, places.kitchen),
    "street": ((0.5, 0.6, 0.75), (1.2, -3.6, 1.1), (0, 0.2, 0.5), 40, places.street),
    "bottle": ((0.5, 0.6, 0.75), _EYE, (0, 0.1, 0.6), 50, glass.bottle),
    "window": ((0.5, 0.6, 0.75), _EYE, (0, 0.1, 0.5), 50, glass.window),
    "lamp": ((0.3, 0.36, 0.45), _EYE, (0, 0.1, 0.6), 50, glass.lamp),
    "contact": ((0.5, 0.6, 0.75), _EYE, _TARGET, 40, contact),
}
