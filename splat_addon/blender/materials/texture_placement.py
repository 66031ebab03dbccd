# SPDX-License-Identifier: GPL-3.0-or-later
"""Finds the place of an image on a mesh: the UV map that an Image Texture node uses, and the effect of a Mapping
node."""

from __future__ import annotations

import bpy
import numpy as np
from mathutils import Euler

from .image_files import TILED, grid_of
from .node_trees import called
from .node_walks import linked
from .texture_images import UnreadableError


def uv_layer(name: str, mesh: bpy.types.Mesh) -> str:
    """The UV map of this name, or for "" the render UV map. Raises UnreadableError if there is none."""
    names = [layer.name for layer in mesh.uv_layers if layer.name == name or (not name and layer.active_render)]
    if not names:
        raise UnreadableError(f"an image texture on the UV map {name!r}, which the mesh does not have")
    return names[0]


def placement(
    node: bpy.types.ShaderNodeTexImage, mesh: bpy.types.Mesh
) -> tuple[str, np.ndarray | None, tuple[str, str] | None]:
    """The UV map of an Image Texture node, and the (2, 3) matrix from its coordinates to the image's (None: identity).

    Also how the image's coordinates are wrapped, in the form of `sampling.Texture`. Raises UnreadableError.
    """
    matrix, wraps = tiles_matrix(node.image), None
    is_tiled = not np.array_equal(matrix, np.eye(3))
    socket, passed = node.inputs["Vector"], set()
    while (source := linked(socket)) is not None:
        by, output = source
        if by in passed:
            raise UnreadableError(f"an image texture that is placed by {called(by)} in a ring of nodes")
        passed.add(by)
        if by.bl_idname == "ShaderNodeMapping" and not by.mute:
            matrix = matrix @ _mapping(by)
            socket = by.inputs["Vector"]
        elif by.bl_idname == "ShaderNodeCombineXYZ" and socket.node == node:
            wraps, socket = _wrapped(by)
            if is_tiled:
                raise UnreadableError("an image of tiles whose coordinates are wrapped")
        elif by.bl_idname == "ShaderNodeUVMap":
            return uv_layer(by.uv_map, mesh), _rows(matrix), wraps
        elif (by.bl_idname, output) == ("ShaderNodeTexCoord", "UV"):
            return uv_layer("", mesh), _rows(matrix), wraps
        elif (by.bl_idname, output) == ("ShaderNodeAttribute", "Vector") and by.attribute_type == "GEOMETRY":
            return uv_layer(by.attribute_name, mesh), _rows(matrix), wraps
        else:
            raise UnreadableError(f"an image texture that is placed by {called(by)}")
    if socket.node != node:
        raise UnreadableError(f"an image texture that a {socket.node.bl_label} node places without coordinates")
    return uv_layer("", mesh), _rows(matrix), None


def tiles_matrix(image: bpy.types.Image | None) -> np.ndarray:
    """(3, 3) from texture coordinates to those of all UDIM tiles together, as `linear_pixels` lays them out."""
    matrix = np.eye(3)
    if image is not None and image.source == TILED:
        column, row, columns, rows = grid_of(image)
        matrix[:2] = [1 / columns, 0, -column / columns], [0, 1 / rows, -row / rows]
    return matrix


def _wrapped(combine: bpy.types.ShaderNodeCombineXYZ) -> tuple[tuple[str, str], bpy.types.NodeSocket]:
    """How u and v are wrapped separately, as built by glTF's importer if they differ, and the socket that both come
    from.

    The nodes are Separate XYZ, a Math node or none for each of X and Y, and Combine XYZ. Raises UnreadableError for
    anything else.
    """
    wraps, separates = [], []
    for axis in ("X", "Y"):
        source, wrap = linked(combine.inputs[axis]), "NONE"
        if source is not None and source[0].bl_idname == "ShaderNodeMath":
            math = source[0]
            numbers = [socket.default_value for socket in math.inputs[1:3]]
            wrap = next((name for name, (operation, given) in _WRAPS.items() if math.operation == operation
                         and numbers[: len(given)] == given and not math.mute), None)  # fmt: skip
            source = linked(math.inputs[0])
        if wrap is None or source is None or (source[0].bl_idname, source[1]) != ("ShaderNodeSeparateXYZ", axis):
            raise UnreadableError("an image texture that is placed by a Combine XYZ node")
        wraps.append(wrap)
        separates.append(source[0])
    if separates[0] != separates[1]:
        raise UnreadableError("an image texture that is placed by a Combine XYZ node")
    return (wraps[0], wraps[1]), separates[0].inputs[0]


#: wrap -> the operation of a Math node that does it, and the numbers of its further inputs
_WRAPS = {"REPEAT": ("WRAP", [0.0, 1.0]), "MIRROR": ("PINGPONG", [1.0])}


def _rows(matrix: np.ndarray) -> np.ndarray | None:
    return None if (matrix == np.eye(3)).all() else matrix[:2]


#: Products of coordinates of textures must fit into float32.
_FARTHEST = 1e15


def _mapping(node: bpy.types.ShaderNodeMapping) -> np.ndarray:
    """(3, 3) matrix of a Mapping node for u, v, 1; the third coordinate of a texture is 0 and is ignored."""
    names = ("Location", "Rotation", "Scale")
    sockets = [node.inputs[name] for name in names]
    if node.vector_type not in _MAPPINGS or any(linked(s) for s in sockets if s.enabled):
        raise UnreadableError(f"an image texture that is placed by a {node.vector_type.title()} or linked Mapping node")
    location, rotation, scale = (np.array(socket.default_value, np.float64) for socket in sockets)
    linear, shift = _MAPPINGS[node.vector_type](location, np.array(Euler(rotation).to_matrix(), np.float64), scale)
    matrix = np.eye(3)
    matrix[:2, :2], matrix[:2, 2] = linear[:2, :2], shift[:2]
    if not (np.abs(matrix) <= _FARTHEST).all():
        raise UnreadableError("an image texture that is placed by a Mapping node with infinite or too large numbers")
    return matrix


def _as_point(location, rotation, scale):
    return rotation * scale, location


def _as_texture(location, rotation, scale):
    """The inverse of a point mapping; a scale of 0 divides as in shaders."""
    inverse = np.divide(1, scale, out=np.zeros(3), where=scale != 0)[:, None] * rotation.T
    return inverse, -inverse @ location


#: vector type -> function of location, rotation matrix and scale that returns a (3, 3) matrix and an offset
_MAPPINGS = {"POINT": _as_point, "TEXTURE": _as_texture}
