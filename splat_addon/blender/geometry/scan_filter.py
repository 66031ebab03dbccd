# SPDX-License-Identifier: GPL-3.0-or-later
"""A modifier that leaves out surfels of a scan: beyond a box, of some classes, or closer together than a spacing.

It is Geometry Nodes, so nothing stored changes, every engine and export has what is left, and Apply makes it last.
"""

from __future__ import annotations

import bpy

from ..ids import FILTER_GROUP, POINT_ATTRIBUTES
from .node_groups import give, known_group, new_modifier_group
from .node_maths import Maths, Socket, enabled

#: Custom property of the node group, which distinguishes our groups from others of the same name.
_MAKE, _VERSION = "surfels_filter", 1

#: input -> ranges of the classes of LAS that it shows; all others have one of their own.
CLASSES = {
    "Unclassified": ((0, 1),),
    "Ground": ((2, 2),),
    "Vegetation": ((3, 5),),
    "Building": ((6, 6),),
    "Noise": ((7, 7), (18, 18)),
    "Water": ((9, 9),),
}
OTHERS = "Other Classes"

#: Half-axis of a thinned surfel, in spacings: as of surfels that are made of points.
_SIZE = 1.25


def add_filter(made: bpy.types.Object, box: bpy.types.Object) -> bpy.types.NodesModifier:
    """Give a surfel object the modifier, which acts after the others that it has. box: the object whose local cube from
    -1 to 1 is shown."""
    modifier = made.modifiers.new(FILTER_GROUP, "NODES")
    modifier.node_group = known_group(_MAKE, _VERSION) or _new_group()
    made.modifiers.move(len(made.modifiers) - 1, len(made.modifiers) - 1 - _pinned(made))
    give(modifier, "Box", box)
    return modifier


def _pinned(made: bpy.types.Object) -> int:
    return sum(modifier.use_pin_to_last for modifier in made.modifiers)


def _new_group() -> bpy.types.NodeTree:
    group = new_modifier_group(FILTER_GROUP, _MAKE, _VERSION)
    _add_inputs(group)
    given, result = group.nodes.new("NodeGroupInput"), group.nodes.new("NodeGroupOutput")
    maths = Maths(group)
    left_out = maths.number("MAXIMUM", _beyond_box(group, maths, given.outputs), _of_hidden_class(maths, given.outputs))
    shown = _without(group, given.outputs["Geometry"], left_out)
    group.links.new(_thinned(group, maths, shown, given.outputs["Spacing"]), result.inputs[0])
    return group


def _add_inputs(group: bpy.types.NodeTree) -> None:
    def add(name: str, kind: str, default=None):
        socket = group.interface.new_socket(name, in_out="INPUT", socket_type=f"NodeSocket{kind}")
        if default is not None:
            socket.default_value = default
        return socket

    add("Box", "Object")
    add("Crop", "Bool", True)
    add("Keep Outside", "Bool", False)
    for name in (*CLASSES, OTHERS):
        add(name, "Bool", True)
    spacing = add("Spacing", "Float", 0.0)
    spacing.subtype, spacing.min_value = "DISTANCE", 0.0


def _beyond_box(group: bpy.types.NodeTree, maths: Maths, given) -> Socket:
    """Whether a point is on the side of the box that is not shown."""
    new, link = group.nodes.new, group.links.new
    box, inverse, place = (
        new("GeometryNodeObjectInfo"),
        new("FunctionNodeInvertMatrix"),
        new("FunctionNodeTransformPoint"),
    )
    box.transform_space = "RELATIVE"
    link(given["Box"], box.inputs["Object"])
    link(box.outputs["Transform"], inverse.inputs[0])
    link(new("GeometryNodeInputPosition").outputs[0], place.inputs[0])
    link(inverse.outputs[0], place.inputs[1])
    x, y, z = maths.separated(maths.vector("ABSOLUTE", place.outputs[0]))
    is_outside = maths.number("GREATER_THAN", maths.number("MAXIMUM", maths.number("MAXIMUM", x, y), z), 1.0)
    is_wrong = maths.number("ABSOLUTE", maths.number("SUBTRACT", is_outside, given["Keep Outside"]))
    return maths.number("MULTIPLY", is_wrong, given["Crop"])


def _of_hidden_class(maths: Maths, given) -> Socket:
    """Whether a point's class is not shown."""
    number, known, hidden = maths.attribute("classification", "INT"), None, None
    for name, ranges in CLASSES.items():
        for low, high in ranges:
            above, below = (
                maths.number("GREATER_THAN", number, low - 0.5),
                maths.number("LESS_THAN", number, high + 0.5),
            )
            is_one = maths.number("MULTIPLY", above, below)
            hides = maths.number("MULTIPLY", is_one, maths.number("SUBTRACT", 1.0, given[name]))
            known = is_one if known is None else maths.number("MAXIMUM", known, is_one)
            hidden = hides if hidden is None else maths.number("MAXIMUM", hidden, hides)
    is_other = maths.number("SUBTRACT", 1.0, known)
    hides = maths.number("MULTIPLY", is_other, maths.number("SUBTRACT", 1.0, given[OTHERS]))
    return maths.number("MAXIMUM", hidden, hides)


def _thinned(group: bpy.types.NodeTree, maths: Maths, geometry: Socket, spacing: Socket) -> Socket:
    """The first point in each cell of a grid, as large as the gaps are then; all points if the spacing is 0."""
    new, link = group.nodes.new, group.links.new
    place, cell, counted = (
        new("GeometryNodeInputPosition"),
        new("FunctionNodeHashValue"),
        new("GeometryNodeAccumulateField"),
    )
    cell.data_type, counted.data_type, counted.domain = "VECTOR", "INT", "POINT"
    per_spacing = maths.number("DIVIDE", 1.0, spacing)
    corner = maths.vector("FLOOR", maths.vector("SCALE", place.outputs[0], scale=per_spacing))
    link(corner, enabled(cell.inputs, "Value"))
    link(cell.outputs[0], counted.inputs["Group ID"])
    enabled(counted.inputs, "Value").default_value = 1
    is_thinned = maths.number("GREATER_THAN", spacing, 0.0)
    is_later = maths.number("GREATER_THAN", enabled(counted.outputs, "Trailing"), 0.5)
    left = _without(group, geometry, maths.number("MULTIPLY", is_later, is_thinned))
    least = maths.number("MULTIPLY", spacing, _SIZE)
    scale, radius = POINT_ATTRIBUTES["scales"], POINT_ATTRIBUTES["radius"]
    wide = maths.vector("MAXIMUM", maths.attribute(scale.name, scale.data_type), maths.joined(least, least))
    left = maths.stored(left, scale.name, scale.data_type, wide)
    return maths.stored(
        left, radius.name, "FLOAT", maths.number("MAXIMUM", maths.attribute(radius.name, "FLOAT"), least)
    )


def _without(group: bpy.types.NodeTree, geometry: Socket, is_left_out: Socket) -> Socket:
    node = group.nodes.new("GeometryNodeDeleteGeometry")
    node.domain = "POINT"
    group.links.new(geometry, node.inputs["Geometry"])
    group.links.new(is_left_out, node.inputs["Selection"])
    return node.outputs[0]
