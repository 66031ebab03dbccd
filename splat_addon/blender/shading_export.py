# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's lights, worlds and materials -> the renderer's, as far as it models them."""

from __future__ import annotations

import bpy
import numpy as np

from ..rendering import Light, Material

#: Blender's light type -> the renderer's kind
_LIGHT_KINDS = {"SUN": "sun", "POINT": "point"}


def light_of(light: bpy.types.Light, matrix_world: np.ndarray) -> Light | None:
    """None for a type that the renderer has not. matrix_world: (4, 4), of the light's object."""
    if light.type not in _LIGHT_KINDS:
        return None
    color = np.array(light.color, np.float64)
    if getattr(light, "use_temperature", False):
        color = color * np.array(light.temperature_color, np.float64)
    return Light(
        _LIGHT_KINDS[light.type],
        tuple(color),
        light.energy * 2.0 ** getattr(light, "exposure", 0.0),
        position=tuple(matrix_world[:3, 3]),
        direction=tuple(-matrix_world[:3, 2]),
    )


def world_radiance(world: bpy.types.World | None, notes) -> tuple[float, float, float]:
    """Colour times strength of the world's Background node, or the world's plain colour; black without a world."""
    if world is None:
        return 0.0, 0.0, 0.0
    node = _output_source(world.node_tree, "OUTPUT_WORLD", "BACKGROUND") if world.use_nodes else None
    if node is None:
        return (0.0, 0.0, 0.0) if world.use_nodes else tuple(world.color)
    if node.inputs["Color"].is_linked or node.inputs["Strength"].is_linked:
        notes.add(f"The world {world.name!r} is textured; its Background node's plain colour and strength are used")
    strength = node.inputs["Strength"].default_value
    return tuple(c * strength for c in node.inputs["Color"].default_value[:3])


def shading_material(material: bpy.types.Material | None, notes) -> Material:
    """Roughness, metallic and index of refraction of the material's Principled node; the defaults without one."""
    if material is None or not material.use_nodes:
        return Material()
    node = _output_source(material.node_tree, "OUTPUT_MATERIAL", "BSDF_PRINCIPLED")
    if node is None:
        notes.add(f"The material {material.name!r} has no Principled BSDF at its output; it is shaded as a default one")
        return Material()
    values = {field: node.inputs[socket] for field, socket in _SOCKETS.items()}
    linked = [s.name for s in values.values() if s.is_linked]
    if linked:
        notes.add(f"The material {material.name!r} textures {', '.join(linked)}; the sockets' plain values are used")
    return Material(**{field: float(socket.default_value) for field, socket in values.items()})


_SOCKETS = {"roughness": "Roughness", "metallic": "Metallic", "ior": "IOR"}


def _output_source(tree: bpy.types.NodeTree, output_type: str, wanted: str) -> bpy.types.Node | None:
    """The node of type `wanted` that feeds the tree's active output, or None."""
    for node in tree.nodes:
        if node.type == output_type and node.is_active_output and node.inputs["Surface"].links:
            source = node.inputs["Surface"].links[0].from_node
            return source if source.type == wanted else None
    return None
