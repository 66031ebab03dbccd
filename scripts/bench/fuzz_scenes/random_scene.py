# SPDX-License-Identifier: GPL-3.0-or-later
"""A random scene: objects with modifiers, surfels that somebody edited, lights, cameras, a world, settings."""

from __future__ import annotations

from collections import Counter

import bpy
import numpy as np

from splat_addon.blender.geometry.points_proxy import show_as_points

from .extremes import Chance
from .random_nodes import NAMES, fill_shader, geometry_group

#: Cameras in a scene, each of which looks at it.
CAMERAS = 5

#: Modifiers whose own cost does not depend on the numbers that they are given.
MODIFIERS = (
    *("ARRAY", "MIRROR", "SOLIDIFY", "EDGE_SPLIT", "DISPLACE", "SMOOTH", "SIMPLE_DEFORM", "CAST", "WAVE", "WELD"),
    *("WIREFRAME", "BUILD", "MASK", "SUBSURF", "WARP", "HOOK", "NORMAL_EDIT", "WEIGHTED_NORMAL", "TRIANGULATE"),
    *("NODES", "NODES", "NODES"),
)

#: Numbers that would make Blender itself run for minutes.
_COSTLY = {"levels", "render_levels", "fit_length", "fit_type", "count", "iterations", "repeat"}

_KINDS = (("FLOAT_VECTOR", "vector", 3), ("FLOAT_COLOR", "color", 4), ("FLOAT", "value", 1), ("FLOAT2", "vector", 2))


def build(by: Chance) -> Counter:
    """Fill the current scene, which is empty; returns what it holds."""
    scene, held = bpy.context.scene, Counter()
    images = [_image(by) for _ in range(by.pick((0, 1, 1, 2)))]
    materials = [bpy.data.materials.new("material") for _ in range(by.pick(range(1, 6)))]
    for material in materials:
        by.fill(material, 0.2, without=("use_nodes",))
        held["nodes"] += fill_shader(by, material, images)
    held["materials"] += len(materials)
    for _ in range(by.pick(range(7))):
        _add(by, scene, _mesh(by, held) if by.some(0.6) else _surfels(by, held), materials, held)
    for kind in ("POINT", "SUN", "SPOT", "AREA"):
        if by.some(0.4):
            light = bpy.data.lights.new(kind, kind)
            by.fill(light, 0.4, without=("type", "use_nodes"))
            if by.some(0.2):
                held["nodes"] += fill_shader(by, light, images)
            _add(by, scene, light, [], held)
            held["lights"] += 1
    if by.some(0.8):
        scene.world = bpy.data.worlds.new("world")
        by.fill(scene.world, 0.2, without=("use_nodes",))
        held["nodes"] += fill_shader(by, scene.world, images)
        held["worlds"] += 1
    for _ in range(CAMERAS):
        camera(by, scene)
    held["cameras"] += CAMERAS
    return held


def camera(by: Chance, scene: bpy.types.Scene) -> bpy.types.Object:
    """A random camera; most see the origin."""
    data = bpy.data.cameras.new("camera")
    made = bpy.data.objects.new("camera", data)
    scene.collection.objects.link(made)
    made.location, made.rotation_euler.x = (0, -4, 0), np.pi / 2
    data.type = by.pick(("PERSP", "PERSP", "ORTHO", "PANO"))
    by.fill(data, by.pick((0.0, 0.0, 0.1, 0.5)), without=("type", "angle", "angle_x", "angle_y"))
    by.fill(data.dof, 0.2)
    data.dof.aperture_blades = min(data.dof.aperture_blades, 8)
    _place(by, made, 0.15)
    return made


def settings(by: Chance, scene: bpy.types.Scene) -> None:
    """Random settings of the scene and its view layer, for a picture of 8 x 8 pixels."""
    own, render, layer = scene.surfel_splatting, scene.render, scene.view_layers[0]
    by.fill(own, by.pick((0.0, 0.1, 0.4)), without=("broken_objects", "profile"))
    own.mesh_density, own.mesh_resolution = "RESOLUTION", by.pick((1, 4, 8))
    if own.shading == "matcap" and bpy.data.images and by.some(0.9):
        own.matcap = bpy.data.images[0]
    for name, most in (("samples", 2), ("blur_samples", 2), ("supersampling", 2), ("shadow_resolution", 64)):
        setattr(own, name, min(getattr(own, name), most))
    own.layers, own.motion_blur_steps = min(own.layers, 4), 2
    render.resolution_x, render.resolution_y, render.resolution_percentage = 8, by.pick((8, 8, 1, 5)), 100
    for name in ("use_border", "use_crop_to_border", "film_transparent", "use_motion_blur"):
        setattr(render, name, by.some(0.15))
    for name in ("border_min_x", "border_min_y", "border_max_x", "border_max_y"):
        setattr(render, name, by.number())
    for name in ("pixel_aspect_x", "pixel_aspect_y", "motion_blur_shutter"):
        setattr(render, name, by.number() if by.some(0.2) else 1.0)
    by.fill(layer, 0.2, without=("use", "samples"))
    layer.samples = by.pick((0, 0, 1))
    if own.lights_splats and by.some(0.9):
        layer.use_pass_diffuse_color = layer.use_pass_emit = layer.use_pass_shadow = False


def _add(by: Chance, scene, data, materials: list, held: Counter) -> None:
    made = bpy.data.objects.new(data.name, data)
    scene.collection.objects.link(made)
    _place(by, made, 0.3)
    if isinstance(data, bpy.types.Mesh):
        for material in by.pick(([], materials[:1], [*materials, None])):
            data.materials.append(material)
        for kind in [by.pick(MODIFIERS) for _ in range(by.pick((0, 0, 1, 2)))]:
            _modify(by, made, kind, materials, held)
        by.fill(made.surfel_splatting, 0.2, without=("detail",))  # millions of surfels, if it is large
        if not data.polygons and by.some(0.5):
            show_as_points(made)
    by.fill(made, 0.1, only=[p.identifier for p in made.bl_rna.properties if p.identifier.startswith("visible_")])
    made.is_holdout, made.pass_index = by.some(0.1), by.pick((0, 3))
    held["objects"] += 1


def _place(by: Chance, made: bpy.types.Object, share: float) -> None:
    for name in ("location", "rotation_euler", "scale", "delta_scale"):
        if by.some(share):
            setattr(made, name, by.numbers(3))
    if by.some(0.1):
        others = [each for each in bpy.data.objects if each != made and each.parent is None]
        made.parent = by.pick([None, *others[:3]])


def _modify(by: Chance, made: bpy.types.Object, kind: str, materials: list, held: Counter) -> None:
    modifier = made.modifiers.new(kind, kind)
    if modifier is None:
        return
    held["modifiers"] += 1
    if kind == "NODES":
        modifier.node_group, count = geometry_group(by, materials)
        held["nodes"] += count
    else:
        by.fill(modifier, 0.3, without=_COSTLY)


def _mesh(by: Chance, held: Counter) -> bpy.types.Mesh:
    """A few triangles and quads, some of them broken, with layers of random values."""
    mesh = bpy.data.meshes.new("mesh")
    count = by.pick((0, 1, 3, 4, 8, 20))
    sides = [3 + k % 2 for k in range(by.pick((0, 1, 6, 12)))] if count > 3 else []
    faces = [by.numpy.choice(count, side, replace=False).tolist() for side in sides]
    mesh.from_pydata(by.array(count, 3).tolist(), [], faces)
    mesh.validate(clean_customdata=False)
    if len(mesh.loops):
        if by.some(0.6):
            mesh.uv_layers.new(name="UVMap").uv.foreach_set("vector", by.array(len(mesh.loops), 2).ravel())
        if by.some(0.5):
            kind, domain = by.pick(("FLOAT_COLOR", "BYTE_COLOR")), by.pick(("POINT", "CORNER"))
            made = mesh.color_attributes.new("Col", kind, domain)
            with np.errstate(invalid="ignore"):
                made.data.foreach_set("color", by.array(len(made.data), 4).ravel())
        if by.some(0.3):
            mesh.normals_split_custom_set(by.array(len(mesh.loops), 3).tolist())
        for polygon in mesh.polygons:
            polygon.use_smooth, polygon.material_index = by.some(0.5), by.pick((0, 1, 9))
    return mesh


def _surfels(by: Chance, held: Counter) -> bpy.types.Mesh:
    """Points with the attributes of surfels, and what somebody did to some of them by hand."""
    mesh, count = bpy.data.meshes.new("surfels"), by.pick((0, 1, 5, 40))
    mesh.vertices.add(count)
    held["surfels"] += count
    usual = {"rotation": ("QUATERNION", "value", 4), "scale": ("FLOAT_VECTOR", "vector", 3)}
    usual |= {"normal": ("FLOAT_VECTOR", "vector", 3), "Col": ("FLOAT_COLOR", "color", 4)}
    usual["material"] = ("INT", "value", 1)
    for name in dict.fromkeys((*usual, *(each for each in NAMES if by.some(0.2)))):
        kind, key, width = usual.get(name, by.pick(_KINDS)) if by.some(0.95) else by.pick(_KINDS)
        if name == "position":
            continue
        made = mesh.attributes.new(name, kind, "POINT")
        if made is None or not count:
            continue
        values = by.array(len(made.data), width)
        if name == "scale":
            values = np.abs(values) if by.some(0.9) else values
        if kind == "INT":
            values = by.numpy.integers(-1, 3, count).astype(np.int32)
        made.data.foreach_set(key, values.ravel())
    if count:
        mesh.attributes["position"].data.foreach_set("vector", by.array(count, 3).ravel())
    return mesh


def _image(by: Chance) -> bpy.types.Image:
    image = bpy.data.images.new("image", by.pick((1, 3, 8)), by.pick((1, 2, 8)), alpha=True, float_buffer=by.some(0.5))
    image.pixels.foreach_set(by.array(len(image.pixels)))
    image.update()
    return image
