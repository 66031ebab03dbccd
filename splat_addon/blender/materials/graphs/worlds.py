# SPDX-License-Identifier: GPL-3.0-or-later
"""Evaluates the nodes of a world in all directions, as a picture of its radiance."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np

from ....rendering.scene.equirectangular import equirectangular_directions
from ....sampling import Image
from ....shading_nodes import Graph, Inputs, evaluate
from ..mesh_layers import GENERATED, POSITION, MeshLayers
from ..node_walks import Node
from ..surface_shaders import Shader
from ..texture_images import UnreadableError, linear_pixels
from .channels import ReadGraph
from .reading import STRAIGHT_ON, GraphReading, Value, reads, unreadable
from .sources import coordinates, derived

#: Rows of the picture: of patterns, and the most of one that has images.
_ROWS, _MOST_ROWS = 256, 1024

#: A world has no place of its own.
_NOWHERE = SimpleNamespace(matrix_world=np.eye(4), data=None)


class _Directions:
    """Stands for the layers of a mesh, whose places are directions and whose surface faces the viewer."""

    mesh = material = None
    owner, asks_owner = _NOWHERE, False

    def __init__(self):
        self.kept_images: dict = {}
        self.rows = _ROWS
        self.image = MeshLayers(None, _images=self.kept_images).image

    def derived(self, name: str) -> int:
        return 0 if name in (GENERATED, POSITION) else 1

    def uv(self, name: str) -> int:
        raise UnreadableError("a UV map, which a world does not have")

    def color(self, name: str) -> int:
        raise UnreadableError(f"the attribute {name!r}, which a world does not have")


def read_radiance(shader: Shader) -> tuple[ReadGraph, int]:
    """What a Background or Emission node sends out, and the rows that its picture needs. Raises UnreadableError if
    nothing of it can be read."""
    layers = _Directions()
    reading = GraphReading(layers, shader.groups)
    color, strength = (reading.read_strictly(shader.node.inputs[name]) for name in ("Color", "Strength"))
    sent = reading.color("multiplied", reading.three(color, True), strength)
    doubts = {what: how for what, how in reading.doubts.items() if how != STRAIGHT_ON}
    return ReadGraph(*reading.graph(sent), doubts), layers.rows


def radiance(graph: Graph, rows: int) -> np.ndarray:
    """(rows, 2 rows, 3) float32 in all directions, as `Environment` has them."""
    shape = rows, 2 * rows
    directions = equirectangular_directions(shape)[0].T.astype(np.float32)
    ones = np.ones_like(directions[:1])
    layers = np.concatenate([directions, ones, -directions, ones])
    found = evaluate(graph, Inputs(rows * 2 * rows, colors=layers))
    return np.ascontiguousarray(np.broadcast_to(found, (3, rows * 2 * rows)).T).reshape(*shape, 3)


@reads("TexEnvironment")
def _environment(tree: GraphReading, node: Node, output: str) -> Value:
    if node.image is None:
        raise unreadable(node, "without an image")
    key = "environment", node.image.session_uid, node.interpolation == "Closest"
    kept = tree.layers.kept_images
    if key not in kept:
        interpolation = "Closest" if node.interpolation == "Closest" else "Linear"
        kept[key] = Image(linear_pixels(node.image, keep_alpha=False), "REPEAT", interpolation)
    if isinstance(tree.layers, _Directions):
        tree.layers.rows = max(tree.layers.rows, min(kept[key].pixels.shape[0], _MOST_ROWS))
    vector = coordinates(tree, node.inputs["Vector"], lambda tree: derived(tree, POSITION))
    return tree.color("rgb", tree.add("image", vector, settings=(kept[key], node.projection)))
