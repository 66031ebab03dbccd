# SPDX-License-Identifier: GPL-3.0-or-later
"""Nodes that apply a function to a number or a colour: Math, Invert Color, Color Ramp, Map Range and Clamp.

Each is read by a function of the node and of `read`, which returns the `Product` of a socket farther up the tree.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from . import ramps
from .texture_images import UnreadableError


def _safe(function: Callable) -> Callable:
    """The product with non-finite values set to 0, as in shaders."""

    @np.errstate(divide="ignore", invalid="ignore", over="ignore")
    def safe(a, b):
        return np.nan_to_num(function(a, b), nan=0.0, posinf=0.0, neginf=0.0)

    return safe


_divided = _safe(np.divide)

_OPERATIONS = {
    "ADD": np.add,
    "SUBTRACT": np.subtract,
    "MULTIPLY": np.multiply,
    "DIVIDE": _divided,
    "POWER": _safe(np.power),
    "MINIMUM": np.minimum,
    "MAXIMUM": np.maximum,
    "LESS_THAN": np.less,
    "GREATER_THAN": np.greater,
}


def _math(node, read):
    operation = _OPERATIONS.get(node.operation)
    if operation is None:
        raise UnreadableError(f"a Math node that does {node.operation.replace('_', ' ').title()}")
    a, b = read(node.inputs[0]), read(node.inputs[1])
    if node.operation == "MULTIPLY" and not node.use_clamp:
        return a * b
    if a.sources and b.sources:
        raise UnreadableError(f"a Math node over two sources that does {node.operation.replace('_', ' ').title()}")
    top = (lambda x: np.clip(x, 0, 1)) if node.use_clamp else (lambda x: x)
    if a.sources:
        return a.mapped(lambda x: top(operation(x, b.value[0]) * 1.0), "Math")
    return b.mapped(lambda x: top(operation(a.value[0], x) * 1.0), "Math")


def _invert(node, read):
    factor = read(node.inputs[0])
    if factor.sources:
        raise UnreadableError("an Invert Color node with a linked factor")
    share = factor.value[0]
    return read(node.inputs[1]).mapped(lambda x: x + share * (1 - 2 * x), "Invert Color")


def _ramp(component: slice, count: int) -> Callable:
    """A reader of some components of a ramp's colour: of `count`."""

    def read_ramp(node, read):
        table = ramps.table(node.color_ramp)[:, component]
        is_smooth = node.color_ramp.interpolation != "CONSTANT"

        def looked_up(numbers: np.ndarray) -> np.ndarray:
            place = np.clip(numbers[..., 0], 0, 1) * (len(table) - 1)
            low = place.astype(np.int32)
            if not is_smooth:
                return table[low]
            share = (place - low)[..., None]
            return table[low] * (1 - share) + table[np.minimum(low + 1, len(table) - 1)] * share

        return read(node.inputs[0]).mapped(looked_up, "Color Ramp", count)

    return read_ramp


def _map_range(node, read):
    if node.data_type != "FLOAT" or node.interpolation_type not in _EASED:
        how = node.interpolation_type if node.data_type == "FLOAT" else node.data_type
        raise UnreadableError(f"a Map Range node that is {how.replace('_', ' ').title()}")
    value, *limits = (read(node.inputs[name]) for name in ("Value", "From Min", "From Max", "To Min", "To Max"))
    if any(limit.sources for limit in limits):
        raise UnreadableError("a Map Range node with a linked range")
    low, high, first, last = (limit.value[0] for limit in limits)
    eased = _EASED[node.interpolation_type]
    top = (lambda x: np.clip(x, *sorted((first, last)))) if node.clamp else (lambda x: x)
    return value.mapped(lambda x: top(first + (last - first) * eased(_divided(x - low, high - low))), "Map Range")


#: interpolation of a Map Range node -> function of the place in the range
_EASED = {
    "LINEAR": lambda x: x,
    "SMOOTHSTEP": lambda x: (3 - 2 * np.clip(x, 0, 1)) * np.clip(x, 0, 1) ** 2,
}


def _clamp(node, read):
    value, *limits = (read(node.inputs[name]) for name in ("Value", "Min", "Max"))
    if any(limit.sources for limit in limits):
        raise UnreadableError("a Clamp node with linked limits")
    low, high = (limit.value[0] for limit in limits)
    if node.clamp_type == "RANGE":
        low, high = sorted((low, high))
    return value.mapped(lambda x: np.minimum(np.maximum(x, low), high), "Clamp")


#: (node, output) -> its reader
READERS: dict[tuple[str, str], Callable] = {
    ("ShaderNodeMath", "Value"): _math,
    ("ShaderNodeInvert", "Color"): _invert,
    ("ShaderNodeValToRGB", "Color"): _ramp(slice(0, 3), 3),
    ("ShaderNodeValToRGB", "Alpha"): _ramp(slice(3, 4), 1),
    ("ShaderNodeMapRange", "Result"): _map_range,
    ("ShaderNodeClamp", "Result"): _clamp,
}
