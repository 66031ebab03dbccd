# SPDX-License-Identifier: GPL-3.0-or-later
"""Random trees of nodes: of materials, worlds and lights, and of Geometry Nodes."""

from __future__ import annotations

import bpy

from .extremes import Chance

#: Shader nodes at a time.
MOST_NODES = 12

#: Nodes that read files or other objects at their own cost.
_SKIPPED = {"ShaderNodeScript", "ShaderNodeTexIES", "ShaderNodeRaycast", "ShaderNodeCustomGroup"}

#: What people put at an output, so that random trees are not mostly cut off.
_SHADERS = (
    *("ShaderNodeBsdfPrincipled",) * 6,
    *("ShaderNodeBsdfDiffuse", "ShaderNodeEmission", "ShaderNodeBsdfGlass", "ShaderNodeBsdfAnisotropic"),
    *("ShaderNodeMixShader", "ShaderNodeAddShader", "ShaderNodeBsdfTransparent", "ShaderNodeHoldout"),
    *("ShaderNodeBackground", "ShaderNodeBsdfMetallic", "ShaderNodeBsdfSheen", "ShaderNodeBsdfToon"),
)

#: Geometry nodes that pass geometry on, and cost little.
_GEOMETRY = (
    *("SetMaterial", "SetMaterialIndex", "StoreNamedAttribute", "SetPosition", "Transform", "DeleteGeometry"),
    *("MergeByDistance", "Triangulate", "ExtrudeMesh", "DualMesh", "SplitEdges", "MeshToPoints", "RealizeInstances"),
    *("ScaleElements", "FlipFaces", "SetShadeSmooth", "PointsToVertices", "ConvexHull", "BoundBox", "InstanceOnPoints"),
    *("RemoveAttribute", "DuplicateElements", "SetPointRadius", "SeparateGeometry", "GeometryToInstance", "SetID"),
    *("MeshToCurve", "CurveToMesh", "CurveToPoints", "TranslateInstances", "RotateInstances", "ScaleInstances"),
)

#: Attributes that this extension reads.
NAMES = (
    *("position", "rotation", "scale", "normal", "Col", "radius", "material", "roughness", "metallic", "emission"),
    *("surfel_rest", "uv_along_x", "clip_line", "blend_depth", "UVMap", "opacity", "nonsense"),
)

_shader_kinds: list[str] = []


def shader_kinds() -> list[str]:
    """All nodes that a material can have."""
    if not _shader_kinds:
        material = bpy.data.materials.new("kinds")
        with_nodes(material)
        for name in dir(bpy.types):
            if name.startswith("ShaderNode") and name not in _SKIPPED:
                try:
                    material.node_tree.nodes.new(name)
                except RuntimeError:
                    continue
                _shader_kinds.append(name)
        bpy.data.materials.remove(material)
    return _shader_kinds


def with_nodes(owner) -> None:
    """Before Blender 5.0 they have to be switched on."""
    if owner.node_tree is None:
        owner.use_nodes = True


def fill_shader(by: Chance, owner, images: list[bpy.types.Image]) -> int:
    """Random nodes for a material, a world or a light; returns their number."""
    with_nodes(owner)
    tree = owner.node_tree
    kinds = [by.pick(_SHADERS if by.some(0.35) else shader_kinds()) for _ in range(by.pick(range(1, MOST_NODES)))]
    for kind in kinds:
        node = tree.nodes.new(kind)
        by.fill(node, 0.4, without=("width", "height", "location", "parent", "hide"))
        if "image" in node.bl_rna.properties and images:
            node.image = by.pick(images)
        if "attribute_name" in node.bl_rna.properties:
            node.attribute_name = by.pick(NAMES)
    if by.some(0.2):
        _add_group(by, tree)
    for node in tree.nodes:
        _fill_inputs(by, node)
    for _ in range(2 * len(kinds)):
        _link(by, tree, by.pick(tree.nodes), by.pick(tree.nodes))
    ends = [node for node in tree.nodes if node.bl_idname.startswith("ShaderNodeOutput")]
    starts = [node for node in tree.nodes if any(s.type == "SHADER" for s in node.outputs)]
    if ends and starts and by.some(0.95):
        tree.links.new(next(s for s in by.pick(starts).outputs if s.type == "SHADER"), by.pick(ends).inputs[0])
    return len(tree.nodes)


def _add_group(by: Chance, tree) -> None:
    inner = bpy.data.node_groups.new("group", "ShaderNodeTree")
    for direction in ("INPUT", "OUTPUT"):
        for kind in ("NodeSocketFloat", "NodeSocketColor", "NodeSocketShader"):
            inner.interface.new_socket(kind, in_out=direction, socket_type=kind)
    for kind in ("NodeGroupInput", "NodeGroupOutput", by.pick(_SHADERS), by.pick(shader_kinds())):
        _fill_inputs(by, inner.nodes.new(kind))
    for _ in range(8):
        _link(by, inner, by.pick(inner.nodes), by.pick(inner.nodes))
    group = tree.nodes.new("ShaderNodeGroup")
    group.node_tree, group.mute = inner, by.some(0.1)


def _fill_inputs(by: Chance, node) -> None:
    node.mute = by.some(0.05)
    for socket in node.inputs:
        if hasattr(socket, "default_value") and by.some(0.4):
            value = socket.default_value
            try:
                socket.default_value = by.numbers(len(value)) if hasattr(value, "__len__") else by.number()
            except (TypeError, ValueError):
                continue  # a name, a menu or a data-block


def _link(by: Chance, tree, source, target) -> None:
    if len(source.outputs) and len(target.inputs):
        output, into = by.pick(source.outputs), by.pick(target.inputs)
        if (output.type == "SHADER") == (into.type == "SHADER"):
            tree.links.new(output, into)


def geometry_group(by: Chance, materials: list[bpy.types.Material]) -> tuple[bpy.types.NodeTree, int]:
    """A random chain of geometry nodes, and their number."""
    tree = bpy.data.node_groups.new("geometry", "GeometryNodeTree")
    for direction in ("INPUT", "OUTPUT"):
        tree.interface.new_socket("Geometry", in_out=direction, socket_type="NodeSocketGeometry")
    last = tree.nodes.new("NodeGroupInput").outputs[0]
    for kind in [by.pick(_GEOMETRY) for _ in range(by.pick(range(1, 6)))]:
        try:
            node = tree.nodes.new(f"GeometryNode{kind}")
        except RuntimeError:
            continue  # another version's
        by.fill(node, 0.3, without=("width", "height", "parent"))
        _fill_inputs(by, node)
        for socket in node.inputs:
            if socket.type == "STRING":
                socket.default_value = by.pick(NAMES)
            elif socket.type == "MATERIAL" and materials:
                socket.default_value = by.pick(materials)
            elif socket.type == "INT" and not hasattr(socket.default_value, "__len__"):
                socket.default_value = by.pick((-1, 0, 1, 2))
        into = [s for s in node.inputs if s.type == "GEOMETRY"]
        tree.links.new(last, into[0])
        if kind == "InstanceOnPoints":
            tree.links.new(tree.nodes.new("GeometryNodeMeshCube").outputs[0], into[1])
        last = next(s for s in node.outputs if s.type == "GEOMETRY")
    tree.links.new(last, tree.nodes.new("NodeGroupOutput").inputs[0])
    return tree, len(tree.nodes)
