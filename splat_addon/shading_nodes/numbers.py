# SPDX-License-Identifier: GPL-3.0-or-later
"""The Math, Clamp and Map Range nodes. Divisions by 0 and roots of negative numbers are 0, as in shaders."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

_ONE = np.float32(1)


def rows_at(place: np.ndarray, last: int) -> np.ndarray:
    """(n,) int32 the whole rows of a table at places in it, 0 to `last`; 0 for what is no number."""
    return np.clip(np.nan_to_num(place), 0, last).astype(np.int32)


def octaves(detail: np.ndarray) -> np.ndarray:
    """The Detail of a procedural texture, 0 to 15; 0 for what is no number."""
    return np.clip(np.nan_to_num(detail), 0, 15)


def divided(a, b) -> np.ndarray:
    """a / b; 0 where b is 0."""
    return np.where(b != 0, a / np.where(b != 0, b, _ONE), 0)


def power(a, b) -> np.ndarray:
    """a to the power of b; 0 for a negative number with an exponent that is not whole."""
    return np.where((a < 0) & (b != np.trunc(b)), 0, np.power(a, b, dtype=np.float32))


def modulo(a, b) -> np.ndarray:
    """The remainder with the sign of a."""
    return np.where(b != 0, np.fmod(a, np.where(b != 0, b, _ONE)), 0)


def wrapped(a, high, low) -> np.ndarray:
    """a wrapped into the range from `low` to `high`."""
    size = high - low
    return np.where(size != 0, a - size * np.floor(divided(a - low, size)), low)


def snapped(a, b) -> np.ndarray:
    return np.floor(divided(a, b)) * b


def _logarithm(a, b):
    usable = (a > 0) & (b > 0)
    return np.where(usable, divided(np.log(np.where(usable, a, _ONE)), np.log(np.where(usable, b, _ONE))), 0)


def _inverse_root(a):
    return np.where(a > 0, 1 / np.sqrt(np.where(a > 0, a, _ONE)), 0)


def _compare(a, b, c):
    return (a == b) | (np.abs(a - b) <= np.maximum(c, np.finfo(np.float32).eps))


def _smooth_minimum(a, b, c):
    overlap = np.maximum(divided(c - np.abs(a - b), c), 0)
    return np.minimum(a, b) - np.where(c != 0, overlap**3 * c * np.float32(1 / 6), 0)


def _ping_pong(a, b):
    turn = divided(a - b, 2 * b)
    return np.where(b != 0, np.abs((turn - np.floor(turn)) * b * 2 - b), 0)


def _floored_modulo(a, b):
    return np.where(b != 0, a - np.floor(divided(a, b)) * b, 0)


#: operation of a Math node -> its number of inputs, and its function
OPERATIONS: dict[str, tuple[int, Callable]] = {
    "ADD": (2, np.add),
    "SUBTRACT": (2, np.subtract),
    "MULTIPLY": (2, np.multiply),
    "DIVIDE": (2, divided),
    "MULTIPLY_ADD": (3, lambda a, b, c: a * b + c),
    "POWER": (2, power),
    "LOGARITHM": (2, _logarithm),
    "SQRT": (1, lambda a: np.sqrt(np.maximum(a, 0))),
    "INVERSE_SQRT": (1, _inverse_root),
    "ABSOLUTE": (1, np.abs),
    "EXPONENT": (1, np.exp),
    "MINIMUM": (2, np.minimum),
    "MAXIMUM": (2, np.maximum),
    "LESS_THAN": (2, np.less),
    "GREATER_THAN": (2, np.greater),
    "SIGN": (1, np.sign),
    "COMPARE": (3, _compare),
    "SMOOTH_MIN": (3, _smooth_minimum),
    "SMOOTH_MAX": (3, lambda a, b, c: -_smooth_minimum(-a, -b, c)),
    "ROUND": (1, lambda a: np.floor(a + np.float32(0.5))),
    "FLOOR": (1, np.floor),
    "CEIL": (1, np.ceil),
    "TRUNC": (1, np.trunc),
    "FRACT": (1, lambda a: a - np.floor(a)),
    "MODULO": (2, modulo),
    "FLOORED_MODULO": (2, _floored_modulo),
    "WRAP": (3, wrapped),
    "SNAP": (2, snapped),
    "PINGPONG": (2, _ping_pong),
    "SINE": (1, np.sin),
    "COSINE": (1, np.cos),
    "TANGENT": (1, np.tan),
    "ARCSINE": (1, lambda a: np.arcsin(np.clip(a, -1, 1))),
    "ARCCOSINE": (1, lambda a: np.arccos(np.clip(a, -1, 1))),
    "ARCTANGENT": (1, np.arctan),
    "ARCTAN2": (2, np.arctan2),
    "SINH": (1, np.sinh),
    "COSH": (1, np.cosh),
    "TANH": (1, np.tanh),
    "RADIANS": (1, np.radians),
    "DEGREES": (1, np.degrees),
}


def math(a, b, c, operation: str, clamps: bool) -> np.ndarray:
    """The Math node."""
    count, function = OPERATIONS[operation]
    result = np.asarray(function(*(a, b, c)[:count]), np.float32)
    return np.clip(result, 0, 1) if clamps else result


def clamped(value, low, high, swaps: bool) -> np.ndarray:
    """The Clamp node. swaps: whether the greater limit is the upper one, whichever it is."""
    if swaps:
        low, high = np.minimum(low, high), np.maximum(low, high)
    return np.minimum(np.maximum(value, low), high)


def _smooth(x):
    x = np.clip(x, 0, 1)
    return x * x * (3 - 2 * x)


def _smoother(x):
    x = np.clip(x, 0, 1)
    return x * x * x * (x * (x * 6 - 15) + 10)


def map_range(value, from_low, from_high, to_low, to_high, steps, how: str, clamps: bool) -> np.ndarray:
    """Map Range, of numbers or vectors."""
    place = divided(value - from_low, from_high - from_low)
    if how == "STEPPED":
        place = np.where(steps > 0, divided(np.floor(place * (steps + 1)), steps), 0)
    elif how == "SMOOTHSTEP":
        place = _smooth(place)
    elif how == "SMOOTHERSTEP":
        place = _smoother(place)
    result = to_low + place * (to_high - to_low)
    if np.ndim(value) == 1:
        result = np.where(from_low == from_high, 0, result)
    return clamped(result, to_low, to_high, True) if clamps and how in ("LINEAR", "STEPPED") else result


FUNCTIONS = {"math": math, "divided": divided, "clamp": clamped, "map range": map_range}
