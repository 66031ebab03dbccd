# SPDX-License-Identifier: GPL-3.0-or-later
"""The scenes of glass: a bottle, a window, a lamp in a frosted globe."""

from __future__ import annotations

import bpy
import numpy as np

from .objects import around, ball, box, checkered_floor, principled

#: Radius and height of the corners of a bottle's outline, up outside and down inside.
BOTTLE = (
    *((0.0, 0.0), (0.30, 0.0), (0.34, 0.02), (0.34, 0.40), (0.34, 0.78), (0.30, 0.92), (0.12, 1.00), (0.11, 1.18)),
    *((0.11, 1.32), (0.14, 1.33), (0.14, 1.38), (0.10, 1.38), (0.085, 1.30), (0.085, 1.16), (0.10, 0.97)),
    *((0.27, 0.89), (0.31, 0.77), (0.31, 0.40), (0.31, 0.06), (0.28, 0.04), (0.0, 0.04)),
)
#: The same of a lamp's globe.
GLOBE = tuple(
    (radius * np.sin(turn), 0.75 - radius * np.cos(turn))
    for radius, turns in ((0.45, np.linspace(0, np.pi, 33)), (0.42, np.linspace(np.pi, 0, 33)))
    for turn in turns
)


def bottle() -> list[bpy.types.Object]:
    checkered_floor()
    around()
    glass = principled("bottle", (0.5, 0.8, 0.6), transmission_weight=1.0, roughness=0.0, ior=1.45)
    return [turned("bottle", smoothed(BOTTLE), glass)]


def window() -> list[bpy.types.Object]:
    checkered_floor()
    around()
    ball((0, 0, 0.5), 0.5, principled("matt", (0.8, 0.6, 0.1), roughness=0.9, specular_ior_level=0.0))
    glass = bpy.data.materials.new("pane")
    glass.use_nodes = True
    nodes = glass.node_tree.nodes
    made = nodes.new("ShaderNodeBsdfGlass")
    made.inputs["Roughness"].default_value, made.inputs["IOR"].default_value = 0.0, 1.5
    glass.node_tree.links.new(made.outputs[0], nodes["Material Output"].inputs["Surface"])
    pane = box((0, -0.9, 0.65), (2.0, 0.02, 1.2), (1, 1, 1), 0.35)
    pane.data.materials[0] = glass
    for side in (-1, 0, 1):
        along = np.array((np.cos(0.35), np.sin(0.35))) * side
        box((along[0], along[1] - 0.9, 0.65), (0.05, 0.05, 1.3), (0.3, 0.15, 0.08), 0.35)
    return [pane]


def lamp() -> list[bpy.types.Object]:
    checkered_floor()
    around()
    box((0, 0, 0.15), (0.3, 0.3, 0.3), (0.1, 0.1, 0.1), 0.3)
    bulb = principled("bulb", (0, 0, 0), emission_color=(1.0, 0.6, 0.3, 1.0), emission_strength=6.0)
    ball((0, 0, 0.75), 0.1, bulb)
    glass = principled("frosted", (0.95, 0.95, 0.95), transmission_weight=1.0, roughness=0.5, ior=1.45)
    return [turned("globe", GLOBE, glass)]


def smoothed(outline, times: int = 3) -> np.ndarray:
    """(n, 2) places along an outline whose corners are cut this often (Chaikin 1974)."""
    places = np.array(outline)
    for _ in range(times):
        cut = np.concatenate([0.75 * places[:-1] + 0.25 * places[1:], 0.25 * places[:-1] + 0.75 * places[1:]], axis=1)
        places = np.concatenate([places[:1], cut.reshape(-1, 2), places[-1:]])
    return places


def turned(name: str, outline, material: bpy.types.Material, segments: int = 96) -> bpy.types.Object:
    """A closed surface of revolution around the Z axis. outline: (n, 2) radius and height, from axis to axis."""
    radius, height = np.array(outline)[1:-1].T
    turn = 2 * np.pi * np.arange(segments) / segments
    rings = np.stack(
        [np.outer(radius, np.cos(turn)), np.outer(radius, np.sin(turn)), np.repeat(height[:, None], segments, 1)], -1
    )
    (_, low), (_, high) = outline[0], outline[-1]
    places = [*rings.reshape(-1, 3).tolist(), (0, 0, low), (0, 0, high)]
    count, around_it = len(places), [(k, (k + 1) % segments) for k in range(segments)]
    faces = [(count - 2, b, a) for a, b in around_it]
    for row in range(0, count - 2 - segments, segments):
        faces += [(row + a, row + b, row + segments + b, row + segments + a) for a, b in around_it]
    faces += [(count - 1, count - 2 - segments + a, count - 2 - segments + b) for a, b in around_it]
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(places, [], faces)
    mesh.materials.append(material)
    mesh.shade_smooth()
    made = bpy.data.objects.new(name, mesh)
    bpy.context.scene.collection.objects.link(made)
    return made
