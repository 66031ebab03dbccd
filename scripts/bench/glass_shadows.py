# SPDX-License-Identifier: GPL-3.0-or-later
"""Shadows of glass on a matt floor, beside Cycles: a globe with a wall, a ball and a pane, smooth and rough.

*Middle* is the light in the middle of a shadow, as a share of that without glass; *RMS* the difference over a square
of 2.4 units around it. Cycles has its own defaults, among them caustics and Filter Glossy.
"""

from __future__ import annotations

import math

import bpy
import numpy as np

import splat_addon
from measuring.blender_scene import lit_scene, rendered
from splat_addon.rendering.presets import PRESETS

from .reflecting import chosen
from .reflecting.glass import GLOBE, turned
from .reflecting.objects import ball, box, principled

QUICK = {"samples": 1, "cases": ["pane"]}
#: Height of the middles above the floor, and of the camera, which sees the shadow alone.
HEIGHT, EYE = 0.75, 0.2
SIDE, PIXELS = 2.4, 64
#: name -> what makes it of a material, roughness, angle and elevation of the sun in degrees, or a lamp's radius
CASES = {
    "pane": ("pane", 0.0, 0.0, 45),
    "rough pane": ("pane", 0.6, 0.0, 45),
    "pane, high sun": ("pane", 0.0, 0.0, 75),
    "pane, wide sun": ("pane", 0.0, 20.0, 75),
    "ball": ("ball", 0.0, 0.0, 45),
    "rough ball": ("ball", 0.5, 0.0, 45),
    "globe": ("globe", 0.0, 0.0, 45),
    "rough globe": ("globe", 0.5, 0.0, 45),
    "globe, lamp": ("globe", 0.3, 0.05, None),
}


def arguments(parser) -> None:
    parser.add_argument("--samples", type=int, default=256, help="of Cycles, a pixel")
    parser.add_argument("--cases", nargs="+", choices=tuple(CASES), default=tuple(CASES))
    parser.add_argument("--preset", choices=tuple(PRESETS), default="balanced")
    parser.add_argument("--set", nargs="*", default=(), metavar="NAME=VALUE", help="render properties of ours")


def run(options, report) -> None:
    splat_addon.register()
    report.header()
    names = ["shadow of a", "middle in Cycles", "middle", "RMS", "RMS of black", "RMS of light"]
    report.table(names, [row(name, options) for name in report.steps(options.cases, "shadows")])


def row(name: str, options) -> tuple:
    shares = []
    for engine in ("CYCLES", "SURFEL_SPLATTING"):
        lit, bare = (picture(CASES[name], engine, is_there, options) for is_there in (True, False))
        shares.append(lit / bare)
    truth, ours = shares
    ticks = np.abs(np.arange(PIXELS) - (PIXELS - 1) / 2) * SIDE / PIXELS
    middle = np.hypot(*np.meshgrid(ticks, ticks)) < 0.25
    hidden = np.where(truth < 0.99, 0.0, 1.0)
    apart = (f"{np.sqrt(np.mean((one - truth) ** 2)):.3f}" for one in (ours, hidden, np.ones_like(truth)))
    return name, f"{truth[middle].mean():.2f}", f"{ours[middle].mean():.2f}", *apart


def picture(case: tuple, engine: str, is_there: bool, options) -> np.ndarray:
    """(h, w) of the floor's red."""
    kind, roughness, size, elevation = case
    bpy.ops.wm.read_factory_settings(use_empty=True)
    turned_by = math.radians(90 - (elevation or 45))
    scene = lit_scene((PIXELS, PIXELS), (0, 0, 0), (turned_by, 0, 0), 3.0)
    scene.render.film_transparent = False
    (sun,) = (one for one in scene.objects if one.type == "LIGHT")
    sun.data.angle = math.radians(size)
    if elevation is None:
        bpy.data.objects.remove(sun)
        lamp = bpy.data.lights.new("lamp", "POINT")
        lamp.energy, lamp.shadow_soft_size = 300.0, size
        made = bpy.data.objects.new("lamp", lamp)
        made.location = 0, -3, HEIGHT + 3
        scene.collection.objects.link(made)
    bpy.ops.mesh.primitive_plane_add(size=30)
    bpy.context.object.data.materials.append(principled("floor", (0.8,) * 3, roughness=1.0, specular_ior_level=0.0))
    if is_there:
        glass = principled("glass", (0.95,) * 3, transmission_weight=1.0, roughness=roughness, ior=1.45)
        OBJECTS[kind](glass)
    camera = scene.camera
    camera.data.type, camera.data.ortho_scale, camera.data.clip_start = "ORTHO", SIDE, 1e-3
    camera.location, camera.rotation_euler = (0, HEIGHT * math.tan(turned_by), EYE), (0, 0, 0)
    if engine == "CYCLES":
        scene.render.engine = engine
        scene.cycles.samples, scene.cycles.use_denoising, scene.cycles.pixel_filter_type = options.samples, False, "BOX"
    else:
        chosen(scene, options)
    return rendered(scene)[..., 0]


def _pane(glass: bpy.types.Material) -> None:
    box((0, 0, HEIGHT), (1, 1, 0.03), (1, 1, 1)).data.materials[0] = glass


OBJECTS = {
    "pane": _pane,
    "ball": lambda glass: ball((0, 0, HEIGHT), 0.45, glass),
    "globe": lambda glass: turned("globe", GLOBE, glass),
}
