# SPDX-License-Identifier: GPL-3.0-or-later
"""Formulas as Geometry Nodes: each function adds a node and returns its output socket."""

from __future__ import annotations

import bpy

Socket = bpy.types.NodeSocket


def enabled(sockets, name: str) -> Socket:
    """The active one among sockets that share a name, one for each data type."""
    return next(socket for socket in sockets if socket.enabled and socket.name == name)


class Maths:
    """group: the node group to add nodes to."""

    def __init__(self, group: bpy.types.NodeTree):
        self._new, self._link = group.nodes.new, group.links.new

    def attribute(self, name: str, kind: str) -> Socket:
        node = self._new("GeometryNodeInputNamedAttribute")
        node.data_type = kind
        node.inputs["Name"].default_value = name
        return enabled(node.outputs, "Attribute")

    def sampled(self, geometry: Socket, index: Socket) -> Socket:
        """The position of a vertex."""
        return self._sampled(geometry, index, "POINT", "GeometryNodeInputPosition")

    def sampled_normal(self, geometry: Socket, index: Socket) -> Socket:
        """The shading normal of a face's corner."""
        return self._sampled(geometry, index, "CORNER", "GeometryNodeInputNormal")

    def _sampled(self, geometry: Socket, index: Socket, domain: str, field: str) -> Socket:
        node, value = self._new("GeometryNodeSampleIndex"), self._new(field)
        node.data_type, node.domain = "FLOAT_VECTOR", domain
        self._link(geometry, node.inputs["Geometry"])
        self._link(value.outputs[0], enabled(node.inputs, "Value"))
        self._link(index, node.inputs["Index"])
        return enabled(node.outputs, "Value")

    def vector(self, operation: str, *vectors: Socket, scale: Socket | None = None) -> Socket:
        node = self._new("ShaderNodeVectorMath")
        node.operation = operation
        for socket, vector in zip(node.inputs, vectors, strict=False):
            self._link(vector, socket)
        if scale is not None:
            self._link(scale, node.inputs["Scale"])
        return next(socket for socket in node.outputs if socket.enabled)

    def dot(self, a: Socket, b: Socket) -> Socket:
        return self.vector("DOT_PRODUCT", a, b)

    def length(self, a: Socket) -> Socket:
        return self.vector("LENGTH", a)

    def number(self, operation: str, *numbers: Socket | float) -> Socket:
        node = self._new("ShaderNodeMath")
        node.operation = operation
        for socket, number in zip(node.inputs, numbers, strict=False):
            if isinstance(number, float):
                socket.default_value = number
            else:
                self._link(number, socket)
        return node.outputs[0]

    def separated(self, vector: Socket) -> tuple[Socket, Socket, Socket]:
        node = self._new("ShaderNodeSeparateXYZ")
        self._link(vector, node.inputs[0])
        return tuple(node.outputs)

    def joined(self, *numbers: Socket) -> Socket:
        """A vector; 0 for missing components."""
        node = self._new("ShaderNodeCombineXYZ")
        for socket, number in zip(node.inputs, numbers, strict=False):
            self._link(number, socket)
        return node.outputs[0]

    def combined(self, basis: tuple[Socket, Socket, Socket], coordinates: Socket) -> Socket:
        """The vector with these coordinates."""
        parts = [
            self.vector("SCALE", axis, scale=factor)
            for axis, factor in zip(basis, self.separated(coordinates), strict=True)
        ]
        return self.vector("ADD", self.vector("ADD", parts[0], parts[1]), parts[2])

    def rotation(self, x: Socket, y: Socket) -> Socket:
        """The rotation of the frame with these axes, which need not be unit vectors."""
        node = self._new("FunctionNodeAxesToRotation")
        node.primary_axis, node.secondary_axis = "X", "Y"
        self._link(x, node.inputs[0])
        self._link(y, node.inputs[1])
        return node.outputs[0]

    def stored(self, geometry: Socket, name: str, kind: str, value: Socket) -> Socket:
        node = self._new("GeometryNodeStoreNamedAttribute")
        node.data_type, node.domain = kind, "POINT"
        self._link(geometry, node.inputs["Geometry"])
        node.inputs["Name"].default_value = name
        self._link(value, enabled(node.inputs, "Value"))
        return node.outputs["Geometry"]
