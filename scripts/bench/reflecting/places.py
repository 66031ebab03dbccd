# SPDX-License-Identifier: GPL-3.0-or-later
"""Two places full of things that reflect one another: a kitchen and a street in the rain."""

from __future__ import annotations

import bpy
import numpy as np

from .glass import smoothed, turned
from .objects import added, ball, box, checkered_floor, principled

#: Radius and height of the corners of a bowl's outline, up outside and down inside.
BOWL = ((0.0, 0.0), (0.12, 0.0), (0.14, 0.02), (0.24, 0.16), (0.25, 0.17), (0.23, 0.16), (0.13, 0.03), (0.0, 0.02))
#: The same of a kettle.
KETTLE = ((0.0, 0.0), (0.2, 0.0), (0.22, 0.05), (0.17, 0.3), (0.09, 0.36), (0.04, 0.38), (0.03, 0.42), (0.0, 0.43))


def of_material(one: bpy.types.Object, material: bpy.types.Material) -> bpy.types.Object:
    one.data.materials.clear()
    one.data.materials.append(material)
    return one


def kitchen() -> list[bpy.types.Object]:
    """A counter of polished stone with steel bowls and a kettle, before a cupboard, a brushed fridge and tiles."""
    floor = checkered_floor()
    for tile in floor.data.materials:
        tile.node_tree.nodes["Principled BSDF"].inputs["Roughness"].default_value = 0.2
        tile.node_tree.nodes["Principled BSDF"].inputs["Specular IOR Level"].default_value = 0.5
    box((0, 2.0, 1.0), (6, 0.1, 2.4), (0.75, 0.7, 0.6))
    box((-0.9, 1.6, 1.5), (1.4, 0.5, 0.7), (0.25, 0.12, 0.05))
    stone = principled("stone", (0.06, 0.06, 0.07), roughness=0.12)
    steel = principled("steel", (0.8, 0.8, 0.8), metallic=1.0, roughness=0.15)
    brushed = principled("brushed", (0.7, 0.7, 0.72), metallic=1.0, roughness=0.3)
    box((0, 0.7, 0.42), (2.6, 0.8, 0.84), (0.5, 0.55, 0.45))
    top = of_material(box((0, 0.7, 0.87), (2.7, 0.9, 0.06), (1, 1, 1)), stone)
    fridge = of_material(box((1.9, 1.4, 0.9), (0.8, 0.8, 1.8), (1, 1, 1)), brushed)
    bowls = [turned("bowl", smoothed(BOWL), steel), turned("kettle", smoothed(KETTLE), steel)]
    bowls[0].location, bowls[1].location = (-0.45, 0.55, 0.9), (0.35, 0.75, 0.9)
    for place, color in (((-0.5, 0.5, 1.0), (0.8, 0.25, 0.02)), ((-0.05, 0.6, 0.99), (0.6, 0.05, 0.03))):
        ball(place, 0.09, principled("fruit", color, roughness=0.8, specular_ior_level=0.0))
    return [floor, top, fridge, *bowls]


def street() -> list[bpy.types.Object]:
    """A car on a wet road between houses."""
    bpy.ops.mesh.primitive_plane_add(size=16)
    road = added(principled("road", (0.05, 0.05, 0.055), roughness=0.2, ior=1.33))
    for place, size, color in (
        ((-2.6, 2.6, 1.2), (2.2, 1.0, 2.4), (0.6, 0.3, 0.2)),
        ((0.3, 3.0, 0.9), (2.4, 1.0, 1.8), (0.7, 0.65, 0.5)),
        ((3.0, 2.4, 1.5), (1.8, 1.0, 3.0), (0.3, 0.4, 0.5)),
        ((-1.7, 0.9, 0.5), (0.1, 0.1, 1.0), (0.8, 0.7, 0.05)),
    ):
        box(place, size, color)
    paint = principled("paint", (0.02, 0.1, 0.3), metallic=0.3, roughness=0.4, coat_weight=1.0, coat_roughness=0.03)
    dark = principled("window", (0.01, 0.01, 0.012), roughness=0.05, ior=1.5)
    chrome = principled("chrome", (0.9, 0.9, 0.9), metallic=1.0, roughness=0.05)
    car = [ball((0, 0, 0.42), 0.4, paint, (2.2, 1.0, 0.6)), ball((-0.1, 0, 0.62), 0.36, dark, (1.4, 0.9, 0.8))]
    for x in (-0.5, 0.5):
        for y in (-0.36, 0.36):
            bpy.ops.mesh.primitive_cylinder_add(
                vertices=64, radius=0.17, depth=0.12, location=(x, y, 0.17), rotation=(np.pi / 2, 0, 0)
            )
            added(principled("tyre", (0.02, 0.02, 0.02), roughness=0.9, specular_ior_level=0.0))
            car.append(ball((x, y * 1.12, 0.17), 0.1, chrome, (1, 0.3, 1)))
    return [road, *car]
