# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfaces that reflect what stands around them, beside Cycles: balls of metal, a car's paint, a wet floor, contact.

*PSNR* is that of sRGB, clamped above white, within the pixels of what reflects. Meshes are drawn as polygons with the
settings of *Balanced*; Cycles takes the same meshes. The figures show ours, Cycles and four times the difference.
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
from measuring.blender_scene import lit_scene, rendered
from splat_addon.reference.metrics import mean_flip, psnr, srgb
from splat_addon.rendering.presets import PRESETS
from splat_addon.whole_files import whole_file

#: Amplification of the difference in the figure.
MAGNIFIED = 4
#: Share of a pixel that is the reflecting object's, to count.
WHOLE = 0.99
QUICK = {"size": (32, 24), "samples": 1, "scenes": ["chrome"]}


class Made(NamedTuple):
    """The objects whose pixels count."""

    reflecting: list[bpy.types.Object]


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


def principled(name: str, base, **values) -> bpy.types.Material:
    made = bpy.data.materials.new(name)
    made.use_nodes = True
    inputs = made.node_tree.nodes["Principled BSDF"].inputs
    inputs["Base Color"].default_value = (*base, 1.0)
    for key, value in values.items():
        inputs[" ".join(w.upper() if w == "ior" else w.capitalize() for w in key.split("_"))].default_value = value
    return made


def added(material: bpy.types.Material, is_smooth: bool = False) -> bpy.types.Object:
    """The object that an operator has just made, of a material."""
    made = bpy.context.object
    made.data.materials.append(material)
    if is_smooth:
        made.data.shade_smooth()
    return made


def ball(place, radius: float, material: bpy.types.Material, stretch=(1, 1, 1)) -> bpy.types.Object:
    bpy.ops.mesh.primitive_uv_sphere_add(segments=96, ring_count=48, radius=radius, location=place)
    bpy.context.object.scale = stretch
    return added(material, is_smooth=True)


def box(place, size, color, turn: float = 0.0) -> bpy.types.Object:
    bpy.ops.mesh.primitive_cube_add(size=1, location=place, rotation=(0, 0, turn))
    bpy.context.object.scale = size
    return added(principled("box", color, roughness=0.9, specular_ior_level=0.0))


def checkered_floor(half: int = 8) -> bpy.types.Object:
    """Squares of half a unit, of two materials."""
    ticks = np.arange(-half, half + 1) / 2
    places = [(x, y, 0) for y in ticks for x in ticks]
    side = 2 * half + 1
    corners = [(r * side + c, r * side + c + 1, (r + 1) * side + c + 1, (r + 1) * side + c)
               for r in range(side - 1) for c in range(side - 1)]  # fmt: skip
    mesh = bpy.data.meshes.new("floor")
    mesh.from_pydata(places, [], corners)
    for shade in (0.7, 0.12):
        mesh.materials.append(principled("square", (shade,) * 3, roughness=0.9, specular_ior_level=0.0))
    for number, polygon in enumerate(mesh.polygons):
        polygon.material_index = (number % (side - 1) + number // (side - 1)) % 2
    made = bpy.data.objects.new("floor", mesh)
    bpy.context.scene.collection.objects.link(made)
    return made


def around() -> None:
    box((-1.1, 0.6, 0.6), (0.8, 0.8, 1.2), (0.8, 0.1, 0.05), 0.4)
    box((1.2, 0.9, 0.4), (0.7, 0.7, 0.8), (0.05, 0.25, 0.8), -0.3)


def metal(roughness: float) -> Callable[[], list]:
    def make() -> list:
        checkered_floor()
        around()
        return [ball((0, 0, 0.5), 0.5, principled("metal", (0.9, 0.9, 0.9), metallic=1.0, roughness=roughness))]

    return make


def car_paint() -> list:
    checkered_floor()
    around()
    paint = principled("paint", (0.4, 0.02, 0.03), metallic=0.4, roughness=0.45, coat_weight=1.0, coat_roughness=0.03)
    return [ball((0, -0.1, 0.35), 0.35, paint, (2.0, 1.2, 1.0))]


def wet_floor() -> list:
    bpy.ops.mesh.primitive_plane_add(size=8)
    floor = added(principled("wet", (0.05, 0.05, 0.055), roughness=0.08, ior=1.33))
    around()
    ball((0, 0, 0.5), 0.5, principled("matt", (0.8, 0.6, 0.1), roughness=0.9, specular_ior_level=0.0))
    return [floor]


def contact() -> list:
    bpy.ops.mesh.primitive_plane_add(size=8)
    floor = added(principled("matt", (0.7, 0.7, 0.7), roughness=1.0, specular_ior_level=0.0))
    around()
    ball((0, 0, 0.5), 0.5, principled("matt", (0.8, 0.6, 0.1), roughness=0.9, specular_ior_level=0.0))
    return [floor]


_EYE, _TARGET = (0.6, -3.4, 1.5), (0, 0.1, 0.45)
#: name -> linear colour of the world, camera, what it looks at, its focal length, and what makes the objects
SCENES = {
    "chrome": ((0.5, 0.6, 0.75), _EYE, _TARGET, 50, metal(0.0)),
    "rough": ((0.5, 0.6, 0.75), _EYE, _TARGET, 50, metal(0.35)),
    "paint": ((0.5, 0.6, 0.75), _EYE, _TARGET, 50, car_paint),
    "wet": ((0.5, 0.6, 0.75), _EYE, _TARGET, 40, wet_floor),
    "contact": ((0.5, 0.6, 0.75), _EYE, _TARGET, 40, contact),
}
