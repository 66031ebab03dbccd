# SPDX-License-Identifier: GPL-3.0-or-later
"""What nodes become that depend on the view: what they are for a camera that looks straight at the surface.

A surfel has one value for all views.
"""

from __future__ import annotations

from ..node_walks import Node
from .reading import GraphReading, Value, reads, unreadable


@reads("LayerWeight", "Fresnel")
def _fresnel(tree: GraphReading, node: Node, output: str) -> Value:
    tree.seen_straight_on(node)
    if output == "Facing":
        return Value((0.0,))
    zero, one = Value((0.0,)), Value((1.0,))
    index = tree.read(node.inputs[0])
    if node.bl_idname == "ShaderNodeLayerWeight":
        # its Blend is turned into an index of refraction
        rest = tree.add("math", one, index, zero, settings=("SUBTRACT", False))
        least = tree.add("math", rest, Value((1e-5,)), zero, settings=("MAXIMUM", False))
        index = tree.add("math", one, least, zero, settings=("DIVIDE", False))
    above, below = (tree.add("math", index, one, zero, settings=(how, False)) for how in ("SUBTRACT", "ADD"))
    ratio = tree.add("math", above, below, zero, settings=("DIVIDE", False))
    return tree.add("math", ratio, Value((2.0,)), zero, settings=("POWER", False))


@reads("LightPath")
def _light_path(tree: GraphReading, node: Node, output: str) -> Value:
    tree.seen_straight_on(node)
    return Value((float(output == "Is Camera Ray"),))


@reads("CameraData")
def _camera_data(tree: GraphReading, node: Node, output: str) -> Value:
    if output != "View Vector":
        raise unreadable(node, f"that gives {output}, which depends on the view")
    tree.seen_straight_on(node)
    return Value((0.0, 0.0, 1.0), 3)
