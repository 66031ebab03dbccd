# SPDX-License-Identifier: GPL-3.0-or-later
"""Materials of nodes beside Cycles, unlit: forty of one family of nodes each, and ten trees of downloaded kind.

*PSNR* is that of sRGB within the pixels that the object fills, over Cycles' picture with this engine's pixel filter: a
square pixel, for surfels after the Gaussian of Mip Filter. *Sharp* is that of surfels over the square pixel alone.
Cycles shows the socket that feeds an input as an emission; this engine shows the base colour or the normal of the
Principled shader that it feeds, in a shading without light, and a roughness as an emission. *Polygons* are named where
the mesh stays polygons, *white* is the share of pixels that are white and should not be. *Notes* say what was not read.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import NamedTuple

import bpy
import numpy as np

import splat_addon
from measuring.blender_scene import rendered
from splat_addon.blender.meshes.mesh_extraction import read_mesh
from splat_addon.blender.meshes.mesh_polygons import needs_surfels
from splat_addon.reference.metrics import psnr, srgb
from splat_addon.rendering import Settings

from .chains import Chain, Socket
from .downloaded import TREES
from .families import OF_VIEWS, PLAIN, PROCEDURAL

#: Amplification of the difference in the figure.
MAGNIFIED = 4
#: sRGB values from which a pixel is white.
WHITE = 0.97
#: input -> the shading model that shows it without light
SHADINGS = {"Base Color": "flat", "Roughness": "principled", "Normal": "normals"}
#: Pixels of Cycles along a side of one of ours, and those at the object's rim that do not count.
FINER, RIM = 4, 3
QUICK = {"size": 24, "samples": 1, "only": ["Gamma", "Noise, bumped", "skin"]}
NAMES = (*PLAIN, *PROCEDURAL, *OF_VIEWS, *TREES)


class Case(NamedTuple):
    """One input of one material. build: function of a `Chain` that returns what feeds the input. goal: dB."""

    name: str
    kind: str
    input: str
    goal: int
    build: object


def cases() -> Iterator[Case]:
    for kind, goal, found in (("plain", 38, PLAIN), ("procedural", 32, PROCEDURAL), ("of views", 0, OF_VIEWS)):
        for name, (socket, build) in found.items():
            yield Case(name, kind, socket, goal, build)
    for name, build in TREES.items():
        for socket in ("Base Color", "Roughness", "Normal"):
            yield Case(name, "tree", socket, 30, lambda c, build=build, socket=socket: build(c)[socket])


def arguments(parser) -> None:
    parser.add_argument("--size", type=int, default=96)
    parser.add_argument("--samples", type=int, default=16, help="of Cycles, in each of 16 parts of a pixel")
    parser.add_argument("--only", nargs="+", choices=NAMES, default=NAMES, metavar="NAME", help="of these materials")


def run(options, report) -> None:
    splat_addon.register()
    report.header()
    chosen = [case for case in cases() if case.name in options.only]
    rows = [_row(case, options, report) for case in report.steps(chosen, "materials")]
    rows.sort(key=lambda row: row[3])
    columns = ["material", "kind", "input", "surfels", "polygons", "sharp", "goal", "white", "notes"]
    report.table(columns, [[*row[:3], *map(_decibels, row[3:6]), *row[6:]] for row in rows])
    missed = sorted({row[0] for row in rows if min(row[3:5]) < row[6]})
    report.say(f"{len(missed)} of {len(set(options.only))} materials miss their goal: {', '.join(missed) or 'none'}.")


def _decibels(value: float) -> str:
    return "" if math.isinf(value) else f"{value:.1f}"


def _row(case: Case, options, report) -> list:
    scene, shown = _prepared(options)
    fine = _by_cycles(scene, shown, case, options)
    truth, filtered = _pixels(fine), _pixels(_blurred(fine, FINER * Settings.filter_variance**0.5))
    covered = _inside(truth[..., 3] > 0.999)
    shown.data.materials[0] = _material(case, is_emission=case.input == "Roughness")
    evaluated = shown.evaluated_get(bpy.context.evaluated_depsgraph_get())
    read = read_mesh(evaluated, evaluated.data)
    forms = ["SURFELS"] if needs_surfels(read.triangles) else ["SURFELS", "POLYGONS"]
    scene.render.engine = "SURFEL_SPLATTING"
    scene.surfel_splatting.shading = SHADINGS[case.input]
    pictures, found = [], {}
    for form in forms:
        scene.surfel_splatting.render_meshes = form
        pictures.append(rendered(scene)[..., :3])
        for name, whole in ((form, truth if form == "POLYGONS" else filtered), (f"sharp {form}", truth)):
            found[name] = psnr(pictures[-1][covered][None], whole[covered][None, :, :3])
    apart = [MAGNIFIED * np.abs(srgb(picture) - srgb(truth[..., :3])) for picture in pictures]
    shown = [srgb(truth[..., :3]), *(each for pair in zip(map(srgb, pictures), apart, strict=True) for each in pair)]
    report.picture(f"{case.name}-{case.input}".lower().replace(" ", "-").replace("/", "-"), shown, encode=None)
    is_white = (srgb(pictures[0]) > WHITE).all(axis=2) & ~(srgb(truth[..., :3]) > WHITE).all(axis=2)
    white = f"{is_white[covered].mean():.0%}"
    return [
        case.name,
        case.kind,
        case.input,
        found["SURFELS"],
        found.get("POLYGONS", math.inf),
        found["sharp SURFELS"],
        case.goal,
        white,
        "; ".join(read.notes),
    ]


def _inside(covered: np.ndarray) -> np.ndarray:
    """Pixels whose neighbours are covered, too."""
    inside = covered.copy()
    for axis in (0, 1):
        for _ in range(RIM):
            inside &= np.roll(inside, 1, axis) & np.roll(inside, -1, axis)
    return inside


def _pixels(fine: np.ndarray) -> np.ndarray:
    """The means over pixels."""
    size = len(fine) // FINER
    return fine.reshape(size, FINER, size, FINER, 4).mean(axis=(1, 3))


def _blurred(picture: np.ndarray, deviation: float) -> np.ndarray:
    """A picture with a transparent rim after a Gaussian of this standard deviation, in pixels."""
    reach = round(4 * deviation)
    weights = np.exp(-0.5 * (np.arange(-reach, reach + 1) / deviation) ** 2)
    for axis in (0, 1):
        moved = zip(weights / weights.sum(), range(-reach, reach + 1), strict=True)
        picture = sum(weight * np.roll(picture, step, axis) for weight, step in moved)
    return picture


def _by_cycles(scene: bpy.types.Scene, shown: bpy.types.Object, case: Case, options) -> np.ndarray:
    shown.data.materials[0] = _material(case, is_emission=True)
    scene.render.engine = "CYCLES"
    scene.cycles.samples, scene.cycles.use_denoising, scene.cycles.pixel_filter_type = options.samples, False, "BOX"
    scene.render.resolution_percentage = 100 * FINER
    picture = rendered(scene)
    scene.render.resolution_percentage = 100
    return picture


def _material(case: Case, is_emission: bool) -> bpy.types.Material:
    """The material of a case; is_emission: with what feeds the input as its light, a normal as a colour."""
    made = bpy.data.materials.new(case.name)
    made.use_nodes = True
    tree = made.node_tree
    chain, shader = Chain(tree), tree.nodes["Principled BSDF"]
    socket: Socket = case.build(chain)
    if not is_emission:
        tree.links.new(socket, shader.inputs[case.input])
        return made
    if case.input == "Normal":
        half = (0.5, 0.5, 0.5)
        socket = chain.add("VectorMath", {0: socket, 1: half, 2: half}, operation="MULTIPLY_ADD").outputs[0]
    light = chain.add("Emission", {"Color": socket})
    tree.links.new(light.outputs[0], tree.get_output_node("ALL").inputs["Surface"])
    return made


def _prepared(options) -> tuple[bpy.types.Scene, bpy.types.Object]:
    """A scene without light, and a box with round edges, turned, of uneven scale, painted, with a UV map."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    bpy.ops.mesh.primitive_cube_add(size=2.0, rotation=(0.2, 0.1, 0.3), scale=(1.0, 1.15, 0.9))
    shown = bpy.context.object
    mesh = shown.data
    bevel = shown.modifiers.new("Bevel", "BEVEL")
    bevel.width, bevel.segments, bevel.limit_method = 0.5, 8, "NONE"
    mesh.shade_smooth()
    painted = mesh.color_attributes.new("Col", "FLOAT_COLOR", "POINT")
    places = np.array([vertex.co for vertex in mesh.vertices])
    colors = np.concatenate([0.5 + 0.45 * np.sin(2 * places), np.ones((len(places), 1))], axis=1)
    painted.data.foreach_set("color", colors.astype(np.float32).ravel())
    shown.color = 0.2, 0.5, 0.8, 1
    mesh.materials.append(None)
    camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    scene.collection.objects.link(camera)
    camera.location = 3.6, -4.6, 3.0
    camera.rotation_euler = (-camera.location).to_track_quat("-Z", "Y").to_euler()
    camera.data.lens = 75
    scene.camera = camera
    scene.render.resolution_x = scene.render.resolution_y = options.size
    scene.render.film_transparent = True
    return scene, shown
