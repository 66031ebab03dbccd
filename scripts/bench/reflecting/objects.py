# SPDX-License-Identifier: GPL-3.0-or-later
"""The scenes: balls of metal, a car's paint, a wet floor, and what stands around them."""

from __future__ import annotations

from collections.abc import Callable

import bpy
import numpy as np


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
