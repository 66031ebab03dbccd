# SPDX-License-Identifier: GPL-3.0-or-later
"""What the procedural texture nodes become."""

from __future__ import annotations

import bpy

from ..mesh_layers import GENERATED
from ..node_walks import Node
from .reading import GraphReading, Value, reads
from .sources import coordinates, derived

_ZERO = Value((0.0,))

#: The version from which on Voronoi textures have other random numbers.
_PCG = (5, 0, 0)


def _place(tree: GraphReading, node: Node) -> Value:
    return coordinates(tree, node.inputs["Vector"], lambda tree: derived(tree, GENERATED))


def _inputs(tree: GraphReading, node: Node, *names: str) -> list[Value]:
    """Inputs by identifier; 0 for those that the node's mode does not use, or that this Blender does not have."""
    found = {socket.identifier: socket for socket in node.inputs if socket.enabled}
    return [tree.read(found[name]) if name in found else _ZERO for name in names]


def _rows(tree: GraphReading, made: Value, first: int, last: int, is_color: bool = False) -> Value:
    """Some rows of what a step made."""
    if last == first + 1:
        return tree.add("component", made, settings=(first,))
    return tree.add("rows", made, settings=(first, last), width=3, is_color=is_color)


@reads("TexNoise")
def _noise(tree: GraphReading, node: Node, output: str) -> Value:
    names = ("W", "Scale", "Detail", "Roughness", "Lacunarity", "Offset", "Gain", "Distortion")
    is_color = output == "Color"
    how = node.noise_dimensions, node.noise_type, node.normalize, is_color
    place = _place(tree, node) if node.noise_dimensions != "1D" else Value((0.0,) * 3, 3)
    made = tree.add("noise", place, *_inputs(tree, node, *names), settings=how)
    return _rows(tree, made, 0, 3 if is_color else 1, is_color)


@reads("TexVoronoi")
def _voronoi(tree: GraphReading, node: Node, output: str) -> Value:
    names = ("W", "Scale", "Detail", "Roughness", "Lacunarity", "Smoothness", "Exponent", "Randomness")
    how = node.voronoi_dimensions, node.feature, node.distance, node.normalize, bpy.app.version >= _PCG
    place = _place(tree, node) if node.voronoi_dimensions != "1D" else Value((0.0,) * 3, 3)
    made = tree.add("voronoi", place, *_inputs(tree, node, *names), settings=how)
    first, last = {"Color": (1, 4), "Position": (4, 7), "W": (7, 8)}.get(output, (0, 1))
    return _rows(tree, made, first, last, output == "Color")


@reads("TexWhiteNoise")
def _white_noise(tree: GraphReading, node: Node, output: str) -> Value:
    place = _place(tree, node) if node.noise_dimensions != "1D" else Value((0.0,) * 3, 3)
    made = tree.add("white noise", place, *_inputs(tree, node, "W"), settings=(node.noise_dimensions,))
    return _rows(tree, made, *((0, 3) if output == "Color" else (3, 4)), output == "Color")


@reads("TexWave")
def _wave(tree: GraphReading, node: Node, output: str) -> Value:
    names = ("Scale", "Distortion", "Detail", "Detail Scale", "Detail Roughness", "Phase Offset")
    direction = node.bands_direction if node.wave_type == "BANDS" else node.rings_direction
    how = node.wave_type, direction, node.wave_profile
    return tree.add("wave", _place(tree, node), *_inputs(tree, node, *names), settings=how)


@reads("TexGradient")
def _gradient(tree: GraphReading, node: Node, output: str) -> Value:
    return tree.add("gradient", _place(tree, node), settings=(node.gradient_type,))


@reads("TexMagic")
def _magic(tree: GraphReading, node: Node, output: str) -> Value:
    given = _inputs(tree, node, "Scale", "Distortion")
    made = tree.color("magic", _place(tree, node), *given, settings=(node.turbulence_depth,))
    return made if output == "Color" else tree.add("weighted", made, settings=(1 / 3,) * 3)


@reads("TexChecker")
def _checker(tree: GraphReading, node: Node, output: str) -> Value:
    made = tree.add("checker", _place(tree, node), *_inputs(tree, node, "Color1", "Color2", "Scale"))
    return _rows(tree, made, *((0, 3) if output == "Color" else (3, 4)), output == "Color")


@reads("TexBrick")
def _brick(tree: GraphReading, node: Node, output: str) -> Value:
    names = ("Color1", "Color2", "Mortar", "Scale", "Mortar Size", "Mortar Smooth", "Bias", "Brick Width", "Row Height")
    how = node.offset, node.offset_frequency, node.squash, node.squash_frequency
    made = tree.add("brick", _place(tree, node), *_inputs(tree, node, *names), settings=how)
    return _rows(tree, made, *((0, 3) if output == "Color" else (3, 4)), output == "Color")


@reads("TexGabor")
def _gabor(tree: GraphReading, node: Node, output: str) -> Value:
    given = _inputs(tree, node, "Scale", "Frequency", "Anisotropy", "Orientation 2D")
    (direction,) = _inputs(tree, node, "Orientation 3D")
    direction = direction if direction.width == 3 else Value((0.0, 0.0, 1.0), 3)
    made = tree.add("gabor", _place(tree, node), *given, direction, settings=(node.gabor_type,))
    return _rows(tree, made, *{"Value": (0, 1), "Phase": (1, 2)}.get(output, (2, 3)))
