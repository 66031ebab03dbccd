# SPDX-License-Identifier: GPL-3.0-or-later
"""Shows a surfel object outside this engine: a modifier turns its surfels into points with their size and colour, or
with none where its source is seen there.

This makes it visible and clickable in Solid, Material Preview, EEVEE and Cycles, where a mesh of vertices alone is only
black dots or invisible. The points share the mesh's attributes, so they cost no memory, and the engine reads the
surfels from them. Joined faces and other kinds of geometry stay as they are.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

import bpy

from ..ids import POINT_ATTRIBUTES, POINTS_GROUP, POINTS_MATERIAL, SIZELESS_GROUP, SOLID
from .node_groups import known_group, new_modifier_group, uses_group
from .node_maths import enabled
from .reading import readable_mesh

#: Custom property of the node group, which distinguishes our groups from others of the same name. Its values: of one
#: whose points have the surfels' sizes, and of one whose points have none, so that only this engine sees them.
_MAKE, _SIZED, _SIZELESS = "surfels_points", 1, 2
#: The same of the material.
_VERSION = 1


def show_as_points(made: bpy.types.Object) -> bpy.types.Modifier:
    """Give a surfel object the modifier, which stays behind all modifiers added later."""
    modifier = made.modifiers.new(POINTS_GROUP, "NODES")
    modifier.node_group = _group(_SIZED)
    # In edit mode the vertices themselves must be visible.
    modifier.show_in_editmode = False
    modifier.use_pin_to_last = True
    modifier.show_expanded = False
    return modifier


def let_others_see(made: bpy.types.Object, is_seen: bool) -> None:
    """Show a surfel object to other engines and shading modes, or not. This engine shows it in any case."""
    version = _SIZED if is_seen else _SIZELESS
    for modifier in filter(is_points_modifier, made.modifiers):
        if modifier.node_group[_MAKE] != version:
            modifier.node_group = _group(version)


def shows_as_points(owner: bpy.types.Object) -> bool:
    """Whether an object in the file has the modifier."""
    return owner.type == "MESH" and any(map(is_points_modifier, owner.modifiers))


@contextmanager
def points_of(evaluated: bpy.types.Object) -> Iterator[list[bpy.types.Mesh | bpy.types.PointCloud]]:
    """All data of an evaluated object whose points may be surfels, for as long as the context lives."""
    if evaluated.type == "POINTCLOUD":
        yield [evaluated.data]
    elif evaluated.type == "MESH":
        with shown_points(evaluated) as cloud, readable_mesh(evaluated) as mesh:
            yield [mesh] if cloud is None else [mesh, cloud]
    else:
        yield []


@contextmanager
def shown_points(evaluated: bpy.types.Object) -> Iterator[bpy.types.PointCloud | None]:
    """The points that the modifiers of an evaluated mesh object made, for as long as the context lives.

    They are read here and not from the depsgraph's instances, which lack them in a render if the object itself is
    hidden and visible only as an instance.
    """
    geometry = evaluated.evaluated_geometry()
    yield geometry.pointcloud


def is_solid(owner: bpy.types.Object) -> bool:
    """Whether the points of an object in the file are solid if its mesh is; true if no other modifier has
    changed them.
    """
    return bool(owner.data.get(SOLID)) and all(map(is_points_modifier, owner.modifiers))


def is_points_modifier(modifier: bpy.types.Modifier) -> bool:
    """Whether a modifier was added by `show_as_points`."""
    return uses_group(modifier, _MAKE)


def _group(version: int) -> bpy.types.NodeTree:
    return known_group(_MAKE, version) or _new_group(version)


def _new_group(version: int) -> bpy.types.NodeTree:
    group = new_modifier_group(SIZELESS_GROUP if version == _SIZELESS else POINTS_GROUP, _MAKE, version)
    material = group.interface.new_socket("Material", in_out="INPUT", socket_type="NodeSocketMaterial")
    material.default_value = _material()
    new, link = group.nodes.new, group.links.new
    given, result = new("NodeGroupInput"), new("NodeGroupOutput")
    kinds, everything = new("GeometryNodeSeparateComponents"), new("GeometryNodeJoinGeometry")
    link(given.outputs["Geometry"], kinds.inputs[0])

    neighbours, is_loose = new("GeometryNodeInputMeshVertexNeighbors"), new("FunctionNodeCompare")
    is_loose.data_type, is_loose.operation = "INT", "EQUAL"
    link(neighbours.outputs["Face Count"], enabled(is_loose.inputs, "A"))
    enabled(is_loose.inputs, "B").default_value = 0

    points = new("GeometryNodeMeshToPoints")
    link(kinds.outputs["Mesh"], points.inputs["Mesh"])
    link(is_loose.outputs[0], points.inputs["Selection"])
    if version == _SIZELESS:
        points.inputs["Radius"].default_value = 0.0
    else:
        radius = new("GeometryNodeInputNamedAttribute")
        radius.data_type = "FLOAT"
        radius.inputs["Name"].default_value = POINT_ATTRIBUTES["radius"].name
        link(enabled(radius.outputs, "Attribute"), points.inputs["Radius"])
    painted = new("GeometryNodeSetMaterial")
    link(points.outputs[0], painted.inputs["Geometry"])
    link(given.outputs["Material"], painted.inputs["Material"])

    faces = new("GeometryNodeDeleteGeometry")
    faces.domain = "POINT"
    link(kinds.outputs["Mesh"], faces.inputs["Geometry"])
    link(is_loose.outputs[0], faces.inputs["Selection"])

    others = [output for output in kinds.outputs if output.enabled and output.name != "Mesh"]
    for output in (painted.outputs[0], faces.outputs[0], *others):
        link(output, everything.inputs[0])
    link(everything.outputs[0], result.inputs[0])
    return group


def _material() -> bpy.types.Material:
    """A material that shows the surfels' own colours, opacities and emission."""
    known = bpy.data.materials.get(POINTS_MATERIAL)
    if known is not None and known.get(_MAKE) == _VERSION:
        return known
    made = bpy.data.materials.new(POINTS_MATERIAL)
    made[_MAKE] = _VERSION
    if made.node_tree is None:
        made.use_nodes = True
    nodes, link = made.node_tree.nodes, made.node_tree.links.new
    shader = next(node for node in nodes if node.bl_idname == "ShaderNodeBsdfPrincipled")
    color, emission = (nodes.new("ShaderNodeAttribute") for _ in range(2))
    color.attribute_name = POINT_ATTRIBUTES["colors"].name
    emission.attribute_name = POINT_ATTRIBUTES["emission"].name
    link(color.outputs["Color"], shader.inputs["Base Color"])
    link(color.outputs["Alpha"], shader.inputs["Alpha"])
    link(emission.outputs["Color"], shader.inputs["Emission Color"])
    shader.inputs["Emission Strength"].default_value = 1.0
    return made
