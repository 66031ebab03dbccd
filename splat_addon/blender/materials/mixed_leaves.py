# SPDX-License-Identifier: GPL-3.0-or-later
"""What a single shader supplies to a tree of mixed and added shaders, whether its values are steps of a graph or
sockets of new nodes. Transmitted light adds up, and colours are weighted by their shader's coverage."""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol, TypeVar

import bpy

from .surface_shaders import CLEAR, SHADERS

Value = TypeVar("Value")


class Terms(Protocol[Value]):
    """A shader's values. black, white, grey: constants; the last is what a shader without a colour socket looks
    like."""

    node: bpy.types.Node
    black: Value
    white: Value
    grey: Value

    def read(self, name: str) -> Value:
        """An input of the shader."""

    def product(self, a: Value, b: Value) -> Value:
        """The product of two colours."""

    def rest(self, share: Value) -> Value:
        """1 minus a share."""


def _color(terms: Terms[Value]) -> Value:
    if terms.node.type in CLEAR or terms.node.type == "EMISSION":
        return terms.black
    name = next((name for name in ("Color", "Base Color") if name in terms.node.inputs), None)
    return _covering(terms, terms.grey if name is None else terms.read(name))


def _emission(terms: Terms[Value]) -> Value:
    names = SHADERS.get(terms.node.bl_idname, {}).get("emission")
    if names is None:
        return terms.black
    return _covering(terms, terms.product(*map(terms.read, names)))


def _let_through(terms: Terms[Value]) -> Value:
    if terms.node.type == "BSDF_PRINCIPLED":
        return terms.rest(terms.read("Alpha"))
    return terms.white if terms.node.type in CLEAR else terms.black


def _covering(terms: Terms[Value], value: Value) -> Value:
    """What covers by its alpha; only Principled has one."""
    return terms.product(value, terms.read("Alpha")) if terms.node.type == "BSDF_PRINCIPLED" else value


#: channel -> what a leaf shader supplies; for the opacity, what it transmits
LEAVES: dict[str, Callable] = {"color": _color, "opacity": _let_through, "emission": _emission}
