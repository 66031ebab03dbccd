# SPDX-License-Identifier: GPL-3.0-or-later
"""What nodes become that read the surface or its object: coordinates, attributes, images, Object Info, Geometry."""

from __future__ import annotations

import bpy
import numpy as np

from ....shading_nodes import ATTRIBUTE, ATTRIBUTE_ALPHA, BUMP, UV
from ..mesh_layers import GENERATED, NORMAL, POINTINESS, POSITION, TRUE_NORMAL
from ..node_products import ImageSource
from ..node_walks import Node, Socket, linked
from ..texture_images import UnreadableError
from ..texture_placement import tiles_matrix, uv_layer
from .reading import REST, GraphReading, Value, reads, unreadable
from .vector_readers import as_direction, inverse_of


def uv(tree: GraphReading, name: str) -> Value:
    """The coordinates of a UV map, "" for the render one."""
    mesh = tree.layers.mesh
    return tree.vector(UV, settings=(tree.layers.uv(uv_layer(name, mesh) if mesh else name),))


def derived(tree: GraphReading, name: str) -> Value:
    """A layer that follows from the mesh itself, in object space."""
    return tree.vector(ATTRIBUTE, settings=(tree.layers.derived(name),))


def in_world(tree: GraphReading, value: Value, kind: str) -> Value:
    return as_direction(tree, value, np.array(tree.owner.matrix_world, np.float64), kind)


def coordinates(tree: GraphReading, socket: Socket, unlinked) -> Value:
    """A texture's coordinates. unlinked: function of the tree for what it uses if nothing feeds them, or nothing that
    can be read."""
    if linked(socket) is not None:
        try:
            return tree.read_strictly(socket)
        except UnreadableError as error:
            tree.doubts.setdefault(str(error), REST)
    return unlinked(tree)


@reads("TexCoord")
def _coordinates(tree: GraphReading, node: Node, output: str) -> Value:
    if output == "UV":
        return uv(tree, "")
    if output == "Generated":
        return derived(tree, GENERATED)
    if output == "Normal":
        return tree.vector("unit", derived(tree, NORMAL))
    if output == "Object":
        place = derived(tree, POSITION)
        if node.object is None:
            return place
        return as_direction(tree, in_world(tree, place, "POINT"), inverse_of(node.object), "POINT")
    raise unreadable(node, f"that gives {output}, which depends on the view")


@reads("UVMap")
def _uv_map(tree: GraphReading, node: Node, output: str) -> Value:
    if node.from_instancer:
        raise unreadable(node, "of the instancer")
    return uv(tree, node.uv_map)


@reads("NewGeometry")
def _geometry(tree: GraphReading, node: Node, output: str) -> Value:
    if output == "Position":
        return in_world(tree, derived(tree, POSITION), "POINT")
    if output in ("Normal", "True Normal"):
        return in_world(tree, derived(tree, NORMAL if output == "Normal" else TRUE_NORMAL), "NORMAL")
    if output == "Incoming":
        tree.seen_straight_on(node)
        return in_world(tree, derived(tree, NORMAL), "NORMAL")
    if output == "Backfacing":
        tree.seen_straight_on(node)
        return Value((0.0,))
    if output == "Pointiness" and tree.layers.mesh is not None:
        return tree.add("component", derived(tree, POINTINESS), settings=(0,))
    raise unreadable(node, f"that gives {output}")


@reads("Bump")
def _bump(tree: GraphReading, node: Node, output: str) -> Value:
    """The bent normal, in world space."""
    normal = in_world(tree, derived(tree, NORMAL), "NORMAL")
    if linked(node.inputs["Normal"]) is not None:
        try:
            normal = tree.read_strictly(node.inputs["Normal"])
        except UnreadableError as error:
            tree.doubts.setdefault(str(error), REST)
    if linked(node.inputs["Height"]) is None:
        return normal
    place = in_world(tree, derived(tree, POSITION), "POINT")
    strength, distance = (tree.read(node.inputs[name]) for name in ("Strength", "Distance"))
    if node.invert:
        distance = tree.add("multiplied", distance, Value((-1.0,)))
    return tree.vector(BUMP, tree.read_strictly(node.inputs["Height"]), place, normal, strength, distance)


@reads("Attribute", "VertexColor")
def _attribute(tree: GraphReading, node: Node, output: str) -> Value:
    if node.bl_idname == "ShaderNodeVertexColor":
        name = node.layer_name
    elif node.attribute_type == "OBJECT":
        return _property(tree, node, output)
    elif node.attribute_type != "GEOMETRY":
        raise unreadable(node, f"of the {node.attribute_type.replace('_', ' ').lower()}")
    else:
        name = node.attribute_name
        if tree.layers.mesh is not None and name in tree.layers.mesh.uv_layers:
            found = uv(tree, name)
            return tree.number(found) if output == "Fac" else found
    layer = (tree.layers.color(name),)
    if output == "Alpha":
        return tree.add(ATTRIBUTE_ALPHA, settings=layer)
    if output == "Fac":
        return tree.number(tree.vector(ATTRIBUTE, settings=layer))
    return tree.add(ATTRIBUTE, settings=layer, width=3, is_color=output == "Color")


def _property(tree: GraphReading, node: Node, output: str) -> Value:
    """An attribute of the object: a custom property of it or its data, or a property by its path."""
    name, found, shown = node.attribute_name, None, _object(tree, node)
    for owner in (shown, shown.data):
        if found is None and owner is not None:
            found = owner[name] if name in owner.keys() else _by_path(owner, name)
    if isinstance(found, int | float):
        found = (float(found),) * 3 + (1.0,)
    elif found is None or isinstance(found, str) or len(found) not in (2, 3, 4):
        raise unreadable(node, f"of the object's {name!r}, which it does not have as numbers")
    numbers = [float(number) for number in found]
    numbers += [0.0] * (3 - len(numbers)) + [1.0] * (len(numbers) < 4)
    if output == "Alpha":
        return Value((numbers[3],))
    return Value((sum(numbers[:3]) / 3,)) if output == "Fac" else Value(tuple(numbers[:3]), 3, output == "Color")


def _by_path(owner, path: str):
    try:
        found = owner.path_resolve(path)
    except ValueError:
        return None
    return found if isinstance(found, int | float) or hasattr(found, "__len__") else None


def _object(tree: GraphReading, node: Node) -> bpy.types.Object:
    """What shows the surface. Raises UnreadableError for a world, which only has a place."""
    if not isinstance(tree.owner, bpy.types.Object):
        raise unreadable(node, "of an object, which a world is not")
    return tree.owner


@reads("ObjectInfo")
def _object_info(tree: GraphReading, node: Node, output: str) -> Value:
    owner = _object(tree, node)
    if output == "Location":
        return Value(tuple(owner.matrix_world.translation), 3)
    if output == "Color":
        return Value(tuple(owner.color[:3]), 3, True)
    numbers = {
        "Alpha": lambda: owner.color[3],
        "Object Index": lambda: owner.pass_index,
        "Material Index": lambda: tree.layers.material.pass_index if tree.layers.material else 0,
        "Random": lambda: random_number(owner.name),
    }
    return Value((float(numbers[output]()),))


def random_number(name: str) -> float:
    """0 to 1, which Blender makes of an object's name: its hash, mixed by the last steps of Jenkins' lookup3."""
    hashed, mask = 0, 0xFFFFFFFF
    for byte in name.encode():
        hashed = (hashed * 37 + byte) & mask
    a = b = c = (0xDEADBEEF + (2 << 2) + 13) & mask
    a = (a + hashed) & mask
    for turn in (14, 11, 25, 16, 4, 14, 24):
        # each step mixes the next of the three numbers with the one before
        c = ((c ^ b) - ((b << turn | b >> (32 - turn)) & mask)) & mask
        a, b, c = b, c, a
    return b / mask


@reads("TexImage")
def _image(tree: GraphReading, node: Node, output: str) -> Value:
    keeps_alpha = output == "Alpha"
    image = tree.layers.image(ImageSource(node), keeps_alpha, any_projection=True)
    vector = coordinates(tree, node.inputs["Vector"], lambda tree: uv(tree, ""))
    to_tiles = tiles_matrix(node.image)
    if not np.array_equal(to_tiles, np.eye(3)):
        if node.projection != "FLAT":
            raise unreadable(node, f"that projects UDIM tiles as a {node.projection.title()}")
        flat = np.insert(to_tiles, 2, 0, axis=1)[[0, 1]]
        vector = tree.vector("transformed", vector, settings=(np.vstack([flat, [0, 0, 1, 0]]).astype(np.float32),))
    if node.projection == "BOX":
        looked_up = tree.add("box image", vector, derived(tree, NORMAL), settings=(image, node.projection_blend))
    else:
        looked_up = tree.add("image", vector, settings=(image, node.projection))
    tree.images[looked_up.given] = node, keeps_alpha
    return tree.add("component", looked_up, settings=(3,)) if keeps_alpha else tree.color("rgb", looked_up)
