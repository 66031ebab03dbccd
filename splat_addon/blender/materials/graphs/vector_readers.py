# SPDX-License-Identifier: GPL-3.0-or-later
"""What the Vector nodes become."""

from __future__ import annotations

import numpy as np

from ....interchange.placement import flattens
from ....shading_nodes import vectors
from ..node_walks import Node
from ..texture_images import UnreadableError
from .reading import GraphReading, Value, reads, unreadable


@reads("SeparateXYZ")
def _separate(tree: GraphReading, node: Node, output: str) -> Value:
    return tree.add("component", tree.read(node.inputs[0]), settings=("XYZ".index(output),))


@reads("CombineXYZ")
def _combine(tree: GraphReading, node: Node, output: str) -> Value:
    return tree.vector("stacked", *map(tree.read, node.inputs))


@reads("VectorMath")
def _vector_math(tree: GraphReading, node: Node, output: str) -> Value:
    if node.operation not in vectors.OPERATIONS and node.operation not in vectors.SCALED:
        raise unreadable(node, f"that does {node.operation.replace('_', ' ').title()}")
    is_number = node.operation in vectors.NUMBERS
    if is_number != (output == "Value"):
        return Value((0.0,)) if output == "Value" else Value((0.0,) * 3, 3)
    given = [tree.read(s) if s.enabled else Value((0.0,) * (1 if s.type == "VALUE" else 3)) for s in node.inputs]
    return tree.add("vector math", *given, settings=(node.operation,), width=1 if is_number else 3)


@reads("Mapping")
def _mapping(tree: GraphReading, node: Node, output: str) -> Value:
    still = Value((0.0,) * 3, 3)
    given = [tree.read(socket) if socket.enabled else still for socket in node.inputs]
    return tree.vector("mapping", *given, settings=(node.vector_type,))


@reads("VectorRotate")
def _rotate(tree: GraphReading, node: Node, output: str) -> Value:
    given = [tree.read(s) if s.enabled else Value((0.0,) * (1 if s.type == "VALUE" else 3)) for s in node.inputs]
    return tree.vector("rotated", *given, settings=(node.rotation_type, node.invert))


@reads("Normal")
def _normal(tree: GraphReading, node: Node, output: str) -> Value:
    direction = Value(tuple(node.outputs["Normal"].default_value), 3)
    if output == "Normal":
        return direction
    return tree.add("dot", tree.vector("unit", direction), tree.vector("unit", tree.read(node.inputs[0])))


@reads("VectorTransform")
def _transform(tree: GraphReading, node: Node, output: str) -> Value:
    if "CAMERA" in (node.convert_from, node.convert_to):
        raise unreadable(node, "to or from the camera, which depends on the view")
    given = tree.read(node.inputs[0])
    if node.convert_from == node.convert_to:
        return given
    matrix = np.array(tree.owner.matrix_world, np.float64)
    if node.convert_from == "WORLD":
        matrix = inverse_of(tree.owner)
    return as_direction(tree, given, matrix, node.vector_type)


def inverse_of(object_) -> np.ndarray:
    """(4, 4) from the world to an object. Raises UnreadableError if its transform has no inverse."""
    matrix = np.array(object_.matrix_world, np.float64)
    if not np.isfinite(matrix).all() or flattens(matrix[:3, :3]):
        raise UnreadableError(f"the transform of {object_.name!r}, which has a scale of 0 or is not finite")
    return np.linalg.inv(matrix)


def as_direction(tree: GraphReading, given: Value, matrix: np.ndarray, kind: str) -> Value:
    """A vector through a (4, 4) matrix: as a point, a vector, or a normal, which becomes a unit vector."""
    linear = matrix[:3, :3] if kind != "NORMAL" else _of_normals(matrix[:3, :3])
    shift = matrix[:3, 3:] if kind == "POINT" else np.zeros((3, 1))
    moved = tree.vector("transformed", given, settings=(np.hstack([linear, shift]).astype(np.float32),))
    return tree.vector("unit", moved) if kind == "NORMAL" else moved


def _of_normals(linear: np.ndarray) -> np.ndarray:
    """(3, 3) what turns normals where `linear` moves places."""
    if not np.isfinite(linear).all() or flattens(linear):
        raise UnreadableError("a normal in the space of an object that has a scale of 0 or is not finite")
    return np.linalg.inv(linear).T
