# SPDX-License-Identifier: GPL-3.0-or-later
"""Builds node trees, and the images that they read, in the words of an artist: colours, numbers, places."""

from __future__ import annotations

import bpy
import numpy as np

Socket = bpy.types.NodeSocket


class Chain:
    """The nodes of one material, before its shader."""

    def __init__(self, tree: bpy.types.NodeTree):
        self.tree = tree

    def add(self, kind: str, inputs=None, **settings) -> bpy.types.Node:
        """A node. inputs: identifier, name or index of a socket that the node's mode uses -> value or socket."""
        node = self.tree.nodes.new(f"ShaderNode{kind}")
        for key, value in settings.items():
            setattr(node, key, value)
        for key, value in (inputs or {}).items():
            self.feed(_socket(node, key), value)
        return node

    def feed(self, socket: Socket, value) -> None:
        if isinstance(value, bpy.types.NodeSocket):
            self.tree.links.new(value, socket)
        else:
            socket.default_value = value

    def coordinates(self, output: str = "UV") -> Socket:
        return self.add("TexCoord").outputs[output]

    def placed(self, output: str, location=(0, 0, 0), turned=(0, 0, 0), scale=(1, 1, 1)) -> Socket:
        """Texture coordinates after a Mapping node."""
        given = {"Vector": self.coordinates(output), "Location": location, "Rotation": turned, "Scale": scale}
        return self.add("Mapping", given).outputs[0]

    def image(self, name: str, at: Socket | None = None, **settings) -> Socket:
        """The colour of an image: one of `PAINTED`."""
        given = {} if at is None else {"Vector": at}
        return self.add("TexImage", given, image=painted(name), **settings).outputs["Color"]

    def math(self, operation: str, a, b=0.0, c=0.0, clamp: bool = False) -> Socket:
        return self.add("Math", {0: a, 1: b, 2: c}, operation=operation, use_clamp=clamp).outputs[0]

    def mix(self, factor, a, b, blend: str = "MIX") -> Socket:
        given = {"Factor_Float": factor, "A_Color": a, "B_Color": b}
        return self.add("Mix", given, data_type="RGBA", blend_type=blend).outputs[2]

    def ramp(self, factor, *stops: tuple, interpolation: str = "LINEAR") -> Socket:
        """stops: place and colour of each."""
        node = self.add("ValToRGB", {0: factor})
        ramp = node.color_ramp
        ramp.interpolation = interpolation
        while len(ramp.elements) < len(stops):
            ramp.elements.new(0.5)
        for element, (place, color) in zip(ramp.elements, stops, strict=True):
            element.position, element.color = place, (*color, 1)
        return node.outputs[0]

    def mask(self, factor, low: float, high: float) -> Socket:
        """A ramp from black to white."""
        return self.ramp(factor, (low, (0, 0, 0)), (high, (1, 1, 1)))

    def noise(
        self, at: Socket, scale: float, detail: float = 2.0, distortion: float = 0.0, output: str = "Fac"
    ) -> Socket:
        given = {"Vector": at, "Scale": scale, "Detail": detail, "Distortion": distortion}
        return _output(self.add("TexNoise", given), output)

    def voronoi(self, at: Socket, scale: float, output: str = "Distance", **settings) -> Socket:
        return _output(self.add("TexVoronoi", {"Vector": at, "Scale": scale}, **settings), output)

    def bump(self, height: Socket, strength: float = 0.6, distance: float = 0.1) -> Socket:
        return self.add("Bump", {"Height": height, "Strength": strength, "Distance": distance}).outputs[0]

    def part(self, vector: Socket, axis: str) -> Socket:
        return self.add("SeparateXYZ", {0: vector}).outputs[axis]


def _socket(node: bpy.types.Node, key) -> Socket:
    if isinstance(key, int):
        return node.inputs[key]
    usable = [socket for socket in node.inputs if socket.enabled and key in (socket.identifier, socket.name)]
    return min(usable, key=lambda socket: socket.identifier != key)


def _output(node: bpy.types.Node, name: str) -> Socket:
    return next(socket for socket in node.outputs if socket.enabled and name in (socket.identifier, socket.name))


def painted(name: str) -> bpy.types.Image:
    """An image of `PAINTED`, made when it is first asked for. Colours are sRGB, all others data."""
    found = bpy.data.images.get(name)
    if found is None:
        size = _SIZE
        found = bpy.data.images.new(name, size, size, is_data=name != "color" and name != "print")
        x, y = np.meshgrid(*[(np.arange(size) + 0.5) / size] * 2)
        rgb = np.clip(PAINTED[name](x, y), 0, 1)
        found.pixels.foreach_set(np.concatenate([rgb, np.ones((size, size, 1))], axis=2).astype(np.float32).ravel())
        found.pack()
    return found


_SIZE = 128


def waves(x: np.ndarray, y: np.ndarray, seed: int, finest: int = 8) -> np.ndarray:
    """(n, n) 0 to 1: a few waves that repeat, finer ones weaker."""
    random, total = np.random.default_rng(seed), np.zeros_like(x)
    for _ in range(24):
        fx, fy = random.integers(-finest, finest + 1, 2)
        total += np.sin(2 * np.pi * (fx * x + fy * y + random.random())) / (1 + np.hypot(fx, fy))
    return 0.5 + total / (2 * np.abs(total).max())


def _color(x, y):
    """Rusty paint: two colours and speckles."""
    share = np.clip(4 * waves(x, y, 1) - 1.5, 0, 1)[..., None]
    return (0.75, 0.35, 0.2) + share * np.array((-0.5, 0.05, 0.3)) + 0.3 * (waves(x, y, 2, 14)[..., None] - 0.5)


def _print(x, y):
    """Printed squares of strong colours."""
    at = (np.floor(8 * x) + 3 * np.floor(8 * y)).astype(int) % 5
    return np.array([(0.9, 0.2, 0.1), (0.1, 0.5, 0.8), (0.9, 0.8, 0.2), (0.2, 0.2, 0.25), (0.9, 0.9, 0.85)])[at]


def _occlusion(x, y):
    return np.repeat(np.clip(0.45 + 0.8 * waves(x, y, 3), 0, 1)[..., None], 3, axis=2)


def _packed(x, y):
    """Occlusion, roughness and metal in one, as glTF packs them."""
    metal = np.clip(8 * waves(x, y, 5) - 4, 0, 1)
    return np.stack([_occlusion(x, y)[..., 0], 0.2 + 0.6 * waves(x, y, 4), metal], axis=2)


def _grunge(x, y):
    return np.repeat(np.clip(3 * waves(x, y, 6, 16) - 1, 0, 1)[..., None], 3, axis=2)


def _normal(x, y):
    """A tangent-space normal map of waves."""
    height = 0.02 * waves(x, y, 7, 6)
    slope = [np.gradient(height, 1 / _SIZE, axis=axis) for axis in (1, 0)]
    bent = np.stack([-slope[0], -slope[1], np.ones_like(height)], axis=2)
    return 0.5 + bent / (2 * np.linalg.norm(bent, axis=2, keepdims=True))


PAINTED = {
    "color": _color,
    "print": _print,
    "occlusion": _occlusion,
    "packed": _packed,
    "grunge": _grunge,
    "normal": _normal,
}
