# SPDX-License-Identifier: GPL-3.0-or-later
"""Scenes of bounced light beside Cycles: a Cornell box, a room lit through its window, a courtyard under sun and sky.

*PSNR* and *FLIP* are those of the whole picture, sRGB, clamped above white. Meshes are drawn as polygons, or converted
with `--surfels`; Cycles takes the same meshes, and its noise is removed. Times are of all processors: *setup* is what
the first picture takes longer than the next, and *frame* that over one without bounced light. The figures show ours,
Cycles and four times the difference.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from typing import NamedTuple

import bpy
import numpy as np
from mathutils import Vector

import splat_addon
from bench.reflecting import MAGNIFIED, chosen, truth_of
from bench.reflecting.objects import added, principled
from demonstration.scene import add_light, even_world
from measuring.blender_scene import rendered
from splat_addon.reference.metrics import mean_flip, psnr, srgb
from splat_addon.rendering.presets import PRESETS

QUICK = {"size": (32, 24), "samples": 1, "scenes": ["cornell"]}
WHITE, RED, GREEN = (0.73, 0.71, 0.68), (0.63, 0.06, 0.05), (0.14, 0.45, 0.09)


class Setting(NamedTuple):
    """world: linear colour. eye, target: of the camera. lens: mm. make: makes the objects and lamps."""

    world: tuple[float, float, float]
    eye: tuple[float, float, float]
    target: tuple[float, float, float]
    lens: float
    make: Callable[[], None]


def arguments(parser) -> None:
    parser.add_argument("--size", type=int, nargs=2, default=(160, 120))
    parser.add_argument("--samples", type=int, default=512, help="of Cycles, a pixel")
    parser.add_argument("--scenes", nargs="+", choices=tuple(SCENES), default=tuple(SCENES))
    parser.add_argument("--preset", choices=tuple(PRESETS), default="balanced")
    parser.add_argument("--surfels", type=int, default=0, help="convert each mesh with this resolution")
    parser.add_argument("--set", nargs="*", default=(), metavar="NAME=VALUE", help="render properties of ours")


def run(options, report) -> None:
    splat_addon.register()
    report.header()
    columns = ["scene", "PSNR without", "PSNR", "FLIP without", "FLIP", "setup, s", "frame"]
    report.table(columns, list(rows(options, report)))


def rows(options, report):
    for name in report.steps(options.scenes, "scenes"):
        scene = prepared(name, options)
        truth = truth_of(name, scene, options)[..., :3]
        if options.surfels:
            convert(options.surfels)
        found = []
        for is_on in (False, True):
            chosen(scene, options)
            scene.surfel_splatting.use_bounced_light = is_on
            times = []
            for _ in range(3):
                started = time.process_time()
                ours = rendered(scene)[..., :3]
                times.append(time.process_time() - started)
            found.append((psnr(ours, truth), mean_flip(ours, truth), times[0], min(times[1:])))
        apart = np.abs(srgb(ours) - srgb(truth))
        report.picture(f"{name}-beside-cycles", [srgb(ours), srgb(truth), MAGNIFIED * apart], encode=None)
        (before, flip_before, _, plain), (after, flip, first, again) = found
        yield (name, f"{before:.1f}", f"{after:.1f}", f"{flip_before:.3f}", f"{flip:.3f}", f"{first - again:.2f}",
               f"{again / plain:.2f}")  # fmt: skip


def convert(resolution: int) -> None:
    """Surfels of every mesh."""
    for one in [o for o in bpy.context.scene.objects if o.type == "MESH"]:
        bpy.context.view_layer.objects.active = one
        one.select_set(True)
        bpy.ops.object.surfels_from_mesh(resolution=resolution)
        one.select_set(False)


def prepared(name: str, options) -> bpy.types.Scene:
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene, setting = bpy.context.scene, SCENES[name]
    scene.render.resolution_x, scene.render.resolution_y = options.size
    scene.render.use_persistent_data = True
    scene.world = even_world(setting.world)
    scene.camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    scene.collection.objects.link(scene.camera)
    scene.camera.location, scene.camera.data.lens = setting.eye, setting.lens
    scene.camera.rotation_euler = (Vector(setting.eye) - Vector(setting.target)).to_track_quat("Z", "Y").to_euler()
    setting.make()
    bpy.context.view_layer.update()
    scene.render.engine = "CYCLES"
    scene.cycles.samples, scene.cycles.use_denoising, scene.cycles.pixel_filter_type = options.samples, True, "BOX"
    return scene


def box(place, size, color, turn: float = 0.0) -> bpy.types.Object:
    bpy.ops.mesh.primitive_cube_add(size=1, location=place, rotation=(0, 0, turn))
    bpy.context.object.scale = size
    return added(matt(color))


def ball(place, radius: float, color) -> bpy.types.Object:
    bpy.ops.mesh.primitive_uv_sphere_add(segments=64, ring_count=32, radius=radius, location=place)
    return added(matt(color), is_smooth=True)


def matt(color) -> bpy.types.Material:
    return principled("matt", color, roughness=1.0, specular_ior_level=0.0)


def cornell() -> None:
    """2.7 units across, open at the front, with a lamp below its ceiling."""
    half, thick = 1.35, 0.1
    off = half + thick / 2
    for place, size, color in (
        ((0, 0, -off), (2 * half, 2 * half, thick), WHITE),
        ((0, 0, off), (2 * half, 2 * half, thick), WHITE),
        ((0, off, 0), (2 * half, thick, 2 * half + 2 * thick), WHITE),
        ((-off, 0, 0), (thick, 2 * half, 2 * half + 2 * thick), RED),
        ((off, 0, 0), (thick, 2 * half, 2 * half + 2 * thick), GREEN),
    ):
        box(place, size, color)
    box((-0.45, 0.4, -half + 0.8), (0.75, 0.75, 1.6), WHITE, 0.3)
    box((0.45, -0.35, -half + 0.38), (0.75, 0.75, 0.76), WHITE, -0.3)
    lamp = add_light("AREA", 45.0, (1.0, 0.85, 0.6))
    lamp.location, lamp.data.size = (0, 0, half - 0.02), 0.6


def room() -> None:
    """5 by 4 units and 2.6 high, with a window in the wall to the left; a sun shines in."""
    wide, deep, high, thick = 2.5, 2.0, 2.6, 0.2
    box((0, 0, -thick / 2), (2 * wide, 2 * deep, thick), (0.45, 0.3, 0.18))
    box((0, 0, high + thick / 2), (2 * wide + 2 * thick, 2 * deep + 2 * thick, thick), WHITE)
    box((0, deep + thick / 2, high / 2), (2 * wide + 2 * thick, thick, high), (0.7, 0.66, 0.55))
    box((0, -deep - thick / 2, high / 2), (2 * wide + 2 * thick, thick, high), WHITE)
    box((wide + thick / 2, 0, high / 2), (thick, 2 * deep, high), (0.3, 0.45, 0.6))
    left = -wide - thick / 2
    box((left, 0, 0.4), (thick, 2 * deep, 0.8), WHITE)
    box((left, 0, 2.4), (thick, 2 * deep, 0.4), WHITE)
    for side in (-1, 1):
        box((left, side * 1.5, 1.5), (thick, 1.0, 1.4), WHITE)
    box((0.9, 0.9, 0.4), (1.4, 0.8, 0.8), (0.5, 0.12, 0.08))
    box((-0.6, 1.2, 0.25), (0.6, 0.6, 0.5), WHITE, 0.4)
    ball((0.9, 0.9, 1.1), 0.3, (0.2, 0.5, 0.2))
    sun = add_light("SUN", 6.0, (1.0, 0.9, 0.75))
    sun.data.angle, sun.rotation_euler = math.radians(1), (0.15, math.radians(-58), 0)


def courtyard() -> None:
    """12 by 12 units, among walls with an arcade on one side."""
    box((0, 0, -0.15), (24, 24, 0.3), (0.5, 0.47, 0.42))
    for place, size, color in (
        ((0, 6.5, 2.5), (14, 1, 5), (0.75, 0.6, 0.4)),
        ((-6.5, 0, 2.0), (1, 12, 4), (0.7, 0.3, 0.2)),
        ((6.5, 0, 2.5), (1, 12, 5), (0.7, 0.68, 0.62)),
        ((4.75, 0, 2.6), (2.5, 12, 0.3), (0.7, 0.68, 0.62)),
    ):
        box(place, size, color)
    for k in range(6):
        box((3.75, -5 + 2 * k, 1.23), (0.4, 0.4, 2.45), (0.7, 0.68, 0.62))
    box((-2, 2, 0.4), (2, 2, 0.8), (0.6, 0.58, 0.5), 0.5)
    ball((-2, 2, 1.5), 0.7, (0.7, 0.65, 0.5))
    sun = add_light("SUN", 4.0, (1.0, 0.92, 0.8))
    sun.data.angle, sun.rotation_euler = math.radians(0.5), (math.radians(25), math.radians(-40), 0)


SCENES = {
    "cornell": Setting((0, 0, 0), (0, -4.9, 0), (0, 0, 0), 40, cornell),
    "room": Setting((1.2, 1.5, 2.0), (-1.7, -1.8, 1.5), (0.6, 1.2, 0.9), 22, room),
    "courtyard": Setting((0.5, 0.7, 1.1), (-4, -5.5, 2.4), (1.2, 2.0, 1.4), 24, courtyard),
}
