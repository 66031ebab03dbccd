# SPDX-License-Identifier: GPL-3.0-or-later
"""Evaluates the nodes of a world in all directions, as a picture of its radiance."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from ....rendering.scene.equirectangular import directions_at, equirectangular_directions, pixels_around
from ....sampling import Image
from ....shading_nodes import Graph, Inputs, evaluate
from ..image_files import frame_of
from ..mesh_layers import GENERATED, POSITION, MeshLayers
from ..node_walks import Node
from ..surface_shaders import Shader
from ..texture_images import UnreadableError, linear_pixels
from .channels import ReadGraph
from .mixes import combined
from .reading import STRAIGHT_ON, GraphReading, Value, reads, unreadable
from .sources import coordinates, derived

#: Shaders that a world shines with, which do the same; others are black.
SHINING = ("BACKGROUND", "EMISSION")

#: Rows of the picture: of patterns, and the most of one that has images.
_ROWS, _MOST_ROWS = 256, 1024
#: Pixels across the disc of a sun.
_PIXELS_ACROSS = 3


class _Nowhere:
    """Where a world is: its own space is that of the scene. Nothing else of an object is asked for."""

    matrix_world = np.eye(4)


class _Sun(NamedTuple):
    """A disc in the direction (3,), radians across, where the picture needs so many times the rows of a pattern."""

    toward: np.ndarray
    size: float
    times: int


class Sampling(NamedTuple):
    """At how many rows the nodes of a world are evaluated, and the suns around which they are evaluated finer."""

    rows: int
    suns: list[_Sun]


class _Directions:
    """Stands for the layers of a mesh, whose places are directions and whose surface faces the viewer."""

    mesh = material = None
    owner, asks_owner = _Nowhere, False

    def __init__(self):
        self.kept_images: dict = {}
        self.rows, self.suns = _ROWS, []
        self.image = MeshLayers(None, _images=self.kept_images).image

    def show_sun(self, toward: tuple[float, float, float], size: float) -> float:
        """Make the picture fine enough for a disc so many radians across; the angle across its pixels there."""
        wanted = min(_PIXELS_ACROSS * math.pi / size, _MOST_ROWS)
        times = max(1, round(wanted / _ROWS))
        self.suns.append(_Sun(np.array(toward), size, times))
        return math.pi / (times * _ROWS)

    def derived(self, name: str) -> int:
        return 0 if name in (GENERATED, POSITION) else 1

    def uv(self, name: str) -> int:
        raise UnreadableError("a UV map, which a world does not have")

    def color(self, name: str) -> int:
        raise UnreadableError(f"the attribute {name!r}, which a world does not have")


def read_radiance(
    shader: Shader,
    factor: Callable[[Shader], float | None] | None = None,
    plain: Callable[[Shader], tuple[float, float, float]] | None = None,
) -> tuple[ReadGraph, Sampling]:
    """What a Background or Emission node sends out, or a tree that mixes and adds them, and what its picture needs.

    factor: of a Mix Shader in a tree, None if it depends on the direction. plain: what of a shader is sent out if
    nothing of it can be read; without it, that raises UnreadableError.
    """
    layers = _Directions()

    def share(reading: GraphReading, mix: Shader) -> Value:
        number = factor(mix)
        return reading.read(mix.node.inputs[0]) if number is None else Value((number,))

    def sent_by(reading: GraphReading, shader: Shader) -> Value:
        if shader.node.type not in SHINING:
            return Value((0.0,) * 3, 3, True)
        try:
            color, strength = (reading.read_strictly(shader.node.inputs[name]) for name in ("Color", "Strength"))
        except UnreadableError:
            if plain is None:
                raise
            return Value(plain(shader), 3, True)
        return reading.color("multiplied", reading.three(color, True), strength)

    reading = GraphReading(layers)
    sent = combined(reading, shader, sent_by, share)
    doubts = {what: how for what, how in reading.doubts.items() if how != STRAIGHT_ON}
    return ReadGraph(*reading.graph(sent), doubts), Sampling(layers.rows, layers.suns)


def radiance(graph: Graph, sampling: Sampling) -> np.ndarray:
    """(rows, 2 rows, 3) float32 in all directions, as `Environment` has them."""
    shape = sampling.rows, 2 * sampling.rows
    found = _sent(graph, equirectangular_directions(shape)[0]).reshape(*shape, 3)
    times = max((sun.times for sun in sampling.suns), default=1)
    wanted = max(sampling.rows, times * _ROWS)
    if wanted > sampling.rows:
        found = _finer(found, wanted // sampling.rows)
    for sun in sampling.suns:
        # where the coarse picture may have met the disc
        reach = sun.size + 2 * math.pi / sampling.rows
        rows, columns = pixels_around(sun.toward, reach, found.shape[:2])
        directions, _ = directions_at(rows, columns, found.shape[:2])
        found[rows[:, None], columns] = _sent(graph, directions.reshape(-1, 3)).reshape(directions.shape)
    return found


def _sent(graph: Graph, directions: np.ndarray) -> np.ndarray:
    """(n, 3) float32 in directions (n, 3)."""
    directions = directions.T.astype(np.float32)
    ones = np.ones_like(directions[:1])
    layers = np.concatenate([directions, ones, -directions, ones])
    found = evaluate(graph, Inputs(directions.shape[1], colors=layers))
    return np.ascontiguousarray(np.broadcast_to(found, directions.shape).T)


def _finer(pixels: np.ndarray, times: int) -> np.ndarray:
    """A picture of all directions with so many times the rows and columns, interpolated."""
    for axis in (0, 1):
        size = pixels.shape[axis]
        place = (np.arange(size * times) + 0.5) / times - 0.5
        low = np.floor(place).astype(int)
        share = np.expand_dims((place - low).astype(np.float32), (1 - axis, 2))
        # columns go round, rows end at the poles
        ends = [np.clip(at, 0, size - 1) if axis == 0 else at % size for at in (low, low + 1)]
        first, second = (np.take(pixels, at, axis) for at in ends)
        pixels = first + (second - first) * share
    return pixels


@reads("TexEnvironment")
def _environment(tree: GraphReading, node: Node, output: str) -> Value:
    if node.image is None:
        raise unreadable(node, "without an image")
    frame = frame_of(node.image, node.image_user)
    key = "environment", node.image.session_uid, node.interpolation == "Closest", frame
    kept = tree.layers.kept_images
    if key not in kept:
        interpolation = "Closest" if node.interpolation == "Closest" else "Linear"
        kept[key] = Image(linear_pixels(node.image, keep_alpha=False, frame=frame), "REPEAT", interpolation)
    if isinstance(tree.layers, _Directions):
        tree.layers.rows = max(tree.layers.rows, min(kept[key].pixels.shape[0], _MOST_ROWS))
    vector = coordinates(tree, node.inputs["Vector"], lambda tree: derived(tree, POSITION))
    return tree.color("rgb", tree.add("image", vector, settings=(kept[key], node.projection)))
