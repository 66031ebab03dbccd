# SPDX-License-Identifier: GPL-3.0-or-later
"""What a material looks like, as a short text to compare with: its nodes that reach the output, what is linked to what,
and the images. Reading it takes about a millisecond, a thousandth of what evaluating it takes.

An image in a file or in the .blend is told by the bytes that it was read from. They are looked at once, until Blender
reports that an image may have been read again.
"""

from __future__ import annotations

import os
import zlib
from collections.abc import Iterator

import bpy
import numpy as np

from ..fingerprints import checksum, plain, settings
from ..geometry.node_groups import nodes_in
from .image_files import TILED, frame_of, frame_path, tile_path
from .node_trees import uses_nodes

#: Properties of nodes that change no picture, beside those that all nodes have.
_IGNORED = frozenset(bpy.types.Node.bl_rna.properties.keys()) | {"is_active_output", "show_texture", "active_item"}

#: session_uid and kind of an image -> checksum of its bytes
_bytes: dict[tuple, str] = {}


def forget_images() -> None:
    """Look at the bytes of images again."""
    _bytes.clear()


def told_of(material: bpy.types.Material | None) -> str:
    """The fingerprint of a material; an empty text without one."""
    if material is None:
        return ""
    return told_of_nodes(material) if uses_nodes(material) else checksum(["plain", plain(material.diffuse_color)])


def told_of_nodes(owner: bpy.types.Material | bpy.types.World) -> str:
    """The fingerprint of the nodes of a material or a world."""
    return checksum(_of_tree(owner.node_tree, owner.node_tree.get_output_node("ALL"), {}))


def missing_image(material: bpy.types.Material | None) -> str | None:
    """The name of an image of a material whose file is not there, so that nobody knows its pixels."""
    nodes = nodes_in(material.node_tree) if material is not None and uses_nodes(material) else ()
    for image in filter(None, (getattr(node, "image", None) for node in nodes)):
        is_held = image.source == "GENERATED" or image.packed_files or image.has_data
        if not is_held and b"missing" in _files(bpy.path.abspath(image.filepath_raw, library=image.library), image):
            return image.name
    return None


def _of_tree(tree: bpy.types.NodeTree, output: bpy.types.Node | None, known: dict) -> Iterator[str]:
    """known: the trees that were told before -> their numbers."""
    if tree in known:
        yield f"tree {known[tree]}"
        return
    known[tree] = len(known)
    into: dict[bpy.types.Node, list[bpy.types.NodeLink]] = {}
    for link in tree.links:
        into.setdefault(link.to_node, []).append(link)
    numbers, waiting = {output: 0}, [output] if output is not None else []
    while waiting:
        node = waiting.pop()
        yield from _of_node(node, known)
        for link in into.get(node, ()):
            before = link.from_node
            if before not in numbers:
                numbers[before] = len(numbers)
                waiting.append(before)
            ends = link.from_socket.identifier, link.to_socket.identifier
            yield f"{numbers[node]} {numbers[before]} {ends} {link.is_muted} {link.is_valid}"


def _of_node(node: bpy.types.Node, known: dict) -> Iterator[str]:
    yield f"{node.bl_idname} {node.mute}"
    yield from settings(node, _IGNORED.__contains__)
    for socket in (*node.inputs, *node.outputs):
        if hasattr(socket, "default_value"):
            yield plain(socket.default_value)
    if (frame := frame_of(getattr(node, "image", None), getattr(node, "image_user", None))) is not None:
        yield f"frame {frame} {frame_path(node.image, frame)}"
    for name, tell in _POINTERS.items():
        if (used := getattr(node, name, None)) is not None:
            yield from tell(used)
    inner = getattr(node, "node_tree", None)
    if inner is not None:
        outputs = (each for each in inner.nodes if each.bl_idname == "NodeGroupOutput" and each.is_active_output)
        yield from _of_tree(inner, next(outputs, None), known)


def _of_ramp(ramp: bpy.types.ColorRamp) -> Iterator[str]:
    yield f"{ramp.color_mode} {ramp.interpolation} {ramp.hue_interpolation}"
    yield from (f"{element.position:g} {plain(element.color)}" for element in ramp.elements)


def _of_curves(mapping: bpy.types.CurveMapping) -> Iterator[str]:
    yield from settings(mapping, lambda name: name.startswith("clip"))
    for curve in mapping.curves:
        yield from (f"{plain(point.location)} {point.handle_type}" for point in curve.points)


def _of_object(used: bpy.types.Object) -> Iterator[str]:
    yield plain([f"{value:.6g}" for row in used.matrix_world for value in row])


def of_image(image: bpy.types.Image) -> Iterator[str]:
    yield f"{image.source} {image.colorspace_settings.name} {image.alpha_mode}"
    if image.is_dirty:
        pixels = np.empty(len(image.pixels), np.float32)
        image.pixels.foreach_get(pixels)
        yield f"{zlib.crc32(pixels):08x}"
    elif image.packed_files:
        yield _kept((image.session_uid, "packed"), lambda: (each.packed_file.data for each in image.packed_files))
    elif image.source == "GENERATED":
        yield f"{image.generated_type} {plain(image.generated_color)} {plain(image.size)}"
    else:
        path = bpy.path.abspath(image.filepath_raw, library=image.library)
        yield _kept((image.session_uid, path), lambda: _files(path, image))


def _kept(key: tuple, contents) -> str:
    if key not in _bytes:
        code = 0
        for content in contents():
            code = zlib.crc32(content, code)
        _bytes[key] = f"{code:08x}"
    return _bytes[key]


def _files(path: str, image: bpy.types.Image) -> Iterator[bytes]:
    paths = [tile_path(path, tile.number) for tile in image.tiles] if image.source == TILED else [path]
    for each in paths:
        if os.path.isfile(each):
            with open(each, "rb") as file:
                yield file.read()
        else:
            yield b"missing"


#: property of a node -> function that describes the value
_POINTERS = {
    "color_ramp": _of_ramp,
    "mapping": _of_curves,
    "object": _of_object,
    "image": of_image,
    "image_user": lambda user: settings(user, {"frame_current", "tile"}.__contains__),
}
