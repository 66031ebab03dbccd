# SPDX-License-Identifier: GPL-3.0-or-later
"""Walks up a node tree and makes a graph of steps.

Something that cannot be read ends no walk: a number takes the value of its own socket, and a node whose colour or
vector cannot be read is passed by: what else feeds it, or its own colour, takes its place. What was not read is kept.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial

import bpy
import numpy as np

from ....shading_nodes import Graph, Step, pruned
from ...working_space import luminance
from ..node_trees import called
from ..node_walks import Node, Socket, Walk, input_of, linked
from ..texture_images import UnreadableError

#: How a sentence about something that was not read ends.
REST = "what can be read of its nodes is used"
STRAIGHT_ON = "it looks as if seen straight on"


@dataclass(frozen=True)
class Value:
    """given: as an input of a `Step`. width: 1 for a number, 3. is_color: whether three numbers are a colour."""

    given: int | tuple[float, ...]
    width: int = 1
    is_color: bool = False


class GraphReading(Walk):
    """One walk. layers: the mesh's `MeshLayers`. groups: as in `Walk`.

    doubts: what was not read -> how the sentence about it ends.
    images: number of the step that looks up an image -> its node, and whether it keeps its alpha.
    """

    def __init__(self, layers, groups: tuple[Node, ...] = ()):
        super().__init__(groups)
        self.layers = layers
        self.steps: list[Step] = []
        self._same: dict[tuple, int] = {}
        self.doubts: dict[str, str] = {}
        self._asked: list[bool] = []
        self.images: dict[int, tuple[Node, bool]] = {}

    def inside(self, groups: tuple[Node, ...]) -> GraphReading:
        """A walk from somewhere else in the tree that adds to the same steps."""
        other = GraphReading(self.layers, groups)
        other.steps, other._same, other.images = self.steps, self._same, self.images
        other.doubts, other._asked = self.doubts, self._asked
        return other

    @property
    def asks_owner(self) -> bool:
        """Whether something depends on the object that shows the mesh."""
        return bool(self._asked)

    def add(self, kind: str, *inputs: Value, settings: tuple = (), width: int = 1, is_color: bool = False) -> Value:
        """One more step. width, is_color: of its result."""
        step = Step(kind, tuple(each.given for each in inputs), settings)
        try:
            key = kind, step.inputs, settings
            number = self._same.setdefault(key, len(self.steps))
        except TypeError:  # tables have no hash
            number = len(self.steps)
        if number == len(self.steps):
            self.steps.append(step)
        return Value(number, width, is_color)

    def seen_straight_on(self, node: Node) -> None:
        """Keep that a node depends on the view."""
        self.doubts[f"{called(node)}, which depends on the view"] = STRAIGHT_ON

    def color(self, kind: str, *inputs: Value, settings: tuple = ()) -> Value:
        return self.add(kind, *inputs, settings=settings, width=3, is_color=True)

    def vector(self, kind: str, *inputs: Value, settings: tuple = ()) -> Value:
        return self.add(kind, *inputs, settings=settings, width=3)

    def number(self, value: Value) -> Value:
        """A value as a number: the luminance of a colour, the mean of a vector."""
        if value.width == 1:
            return value
        weights = luminance()[:3] if value.is_color else (1 / 3,) * 3
        return self.add("weighted", value, settings=weights)

    def three(self, value: Value, is_color: bool) -> Value:
        """A value as a colour or a vector."""
        return replace(self.add("grey", value) if value.width == 1 else value, width=3, is_color=is_color)

    def input(self, node: Node, identifier: str) -> Value:
        return self.read(input_of(node, identifier))

    def graph(self, value: Value) -> tuple[Graph, dict[int, tuple[Node, bool]]]:
        """The steps that a value needs, and the images among them, by the numbers in that graph."""
        if isinstance(value.given, tuple):
            value = self.add("in range", value, settings=(-np.inf, np.inf), width=value.width)
        graph, order = pruned(self.steps, value.given)
        return graph, {k: self.images[number] for k, number in enumerate(order) if number in self.images}

    def constant(self, socket: Socket) -> Value:
        given = getattr(socket, "default_value", None)
        if socket.type in ("VALUE", "INT", "BOOLEAN"):
            return Value((float(given),))
        if socket.type not in ("RGBA", "VECTOR"):
            raise UnreadableError(f"a socket of type {socket.type.title()}")
        return Value(tuple(float(number) for number in given[:3]), 3, socket.type == "RGBA")

    def arrived(self, read: Value | UnreadableError, socket: Socket) -> Value:
        if isinstance(read, UnreadableError):
            raise read
        if socket.type == "INT":
            whole = Value((0.0,)), Value((0.0,))
            return self.add("math", self.number(read), *whole, settings=("TRUNC", False))
        if socket.type == "BOOLEAN":
            limit = Value((0.0,)), Value((0.0,))
            return self.add("math", self.number(read), *limit, settings=("GREATER_THAN", False))
        return self.number(read) if socket.type == "VALUE" else self.three(read, socket.type == "RGBA")

    def read_strictly(self, socket: Socket) -> Value:
        """What feeds a socket. Raises UnreadableError if nothing of it can be read."""
        return super().read(socket)

    def read(self, socket: Socket) -> Value:
        try:
            return super().read(socket)
        except UnreadableError as error:
            if socket.type in ("RGBA", "VECTOR"):
                raise
            self.doubts.setdefault(str(error), REST)
            return self.constant(socket)

    def output(self, source: tuple[Node, str], key: tuple) -> Value | UnreadableError:
        # a failure is kept, too: many paths may lead to it
        try:
            return super().output(source, key)
        except UnreadableError as error:
            return self._instead(*source, key, error)

    def _instead(self, node: Node, output: str, key: tuple, error: UnreadableError) -> Value | UnreadableError:
        """What else feeds a node's colours, or its own colour, or for a vector its vectors; the error if there is
        nothing."""
        if node.mute or node.bl_idname in ("ShaderNodeGroup", "NodeGroupInput") or key in self._followed:
            return error
        is_vector = next(socket for socket in node.outputs if socket.identifier == output).type == "VECTOR"
        kinds = ("RGBA", "VECTOR") if is_vector else ("RGBA",)
        given = [s for s in node.inputs if s.enabled and s.type in kinds and (s.type == "RGBA" or linked(s))]
        self._followed.append(key)
        try:
            for socket in sorted(given, key=lambda socket: linked(socket) is None):
                try:
                    found = super().read(socket)
                except UnreadableError:
                    continue
                self.doubts.setdefault(str(error), REST)
                return found
        finally:
            self._followed.pop()
        return error

    def reader(self, node: Node, output: str) -> Callable[[], Value] | None:
        found = READERS.get(node.bl_idname)
        return found and partial(found, self, node, output)

    @property
    def owner(self) -> bpy.types.Object:
        """The object whose material is read. Raises UnreadableError if it is not known."""
        self._asked.append(True)
        self.layers.asks_owner = True
        if self.layers.owner is None:
            raise UnreadableError("its object")
        return self.layers.owner


#: kind of node -> function of a `GraphReading`, a node, and the identifier of its output. Filled by the modules beside.
READERS: dict[str, Callable[[GraphReading, Node, str], Value]] = {}


def reads(*kinds: str):
    """Registers the reader of some kinds of nodes, named without "ShaderNode"."""

    def register(function):
        READERS.update(dict.fromkeys((f"ShaderNode{kind}" for kind in kinds), function))
        return function

    return register


def unreadable(node: Node, how: str = "") -> UnreadableError:
    return UnreadableError(f"{called(node)} {how}".strip())
