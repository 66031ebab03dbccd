# SPDX-License-Identifier: GPL-3.0-or-later
"""The Mix node: of colours with all blend modes, of numbers and of vectors."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from .colors import from_hsv, to_hsv


def _between(blend: Callable) -> Callable:
    """A blend that goes by the factor from the first colour to a function of both."""
    return lambda a, b, t: a + t * (blend(a, b) - a)


def _screen(a, b, t):
    return 1 - (1 - t + t * (1 - b)) * (1 - a)


def _overlay(a, b, t):
    return np.where(a < 0.5, a * (1 - t + 2 * t * b), 1 - (1 - t + 2 * t * (1 - b)) * (1 - a))


def _divide(a, b, t):
    return np.where(b != 0, (1 - t) * a + t * a / np.where(b != 0, b, 1), a)


def _dodge(a, b, t):
    rest = 1 - t * b
    lit = np.where(rest <= 0, 1, np.minimum(a / np.where(rest <= 0, 1, rest), 1))
    return np.where(a != 0, lit, a)


def _burn(a, b, t):
    rest = 1 - t + t * b
    return np.where(rest <= 0, 0, np.clip(1 - (1 - a) / np.where(rest <= 0, 1, rest), 0, 1))


def _soft_light(a, b, t):
    return (1 - t) * a + t * ((1 - a) * b * a + a * (1 - (1 - b) * (1 - a)))


def _hue(a, b, t):
    other = to_hsv(b)
    own = to_hsv(a)
    turned = from_hsv(np.stack(np.broadcast_arrays(other[0], own[1], own[2])))
    return np.where(other[1] != 0, a + t * (turned - a), a)


def _saturation(a, b, t):
    hue, saturation, value = to_hsv(a)
    mixed = (1 - t) * saturation + t * to_hsv(b)[1]
    return np.where(saturation != 0, from_hsv(np.stack(np.broadcast_arrays(hue, mixed, value))), a)


def _value(a, b, t):
    hue, saturation, value = to_hsv(a)
    return from_hsv(np.stack(np.broadcast_arrays(hue, saturation, (1 - t) * value + t * to_hsv(b)[2])))


def _color(a, b, t):
    hue, saturation, _ = to_hsv(b)
    tinted = from_hsv(np.stack(np.broadcast_arrays(hue, saturation, to_hsv(a)[2])))
    return np.where(saturation != 0, a + t * (tinted - a), a)


#: blend mode -> function of two colours and the factor
BLENDS: dict[str, Callable] = {
    "MIX": _between(lambda a, b: b),
    "DARKEN": _between(np.minimum),
    "MULTIPLY": _between(np.multiply),
    "BURN": _burn,
    "LIGHTEN": _between(np.maximum),
    "SCREEN": _screen,
    "DODGE": _dodge,
    "ADD": lambda a, b, t: a + t * b,
    "OVERLAY": _overlay,
    "SOFT_LIGHT": _soft_light,
    "LINEAR_LIGHT": lambda a, b, t: a + t * (2 * b - 1),
    "DIFFERENCE": _between(lambda a, b: np.abs(a - b)),
    "EXCLUSION": lambda a, b, t: np.maximum(a + t * (b - 2 * a * b), 0),
    "SUBTRACT": lambda a, b, t: a - t * b,
    "DIVIDE": _divide,
    "HUE": _hue,
    "SATURATION": _saturation,
    "COLOR": _color,
    "VALUE": _value,
}


def mixed_colors(factor, a, b, blend: str, clamps_factor: bool, clamps_result: bool) -> np.ndarray:
    """Mix of colours."""
    a, b = np.broadcast_arrays(a, b)
    result = BLENDS[blend](a, b, np.clip(factor, 0, 1) if clamps_factor else factor)
    return np.clip(result, 0, 1) if clamps_result else result


def mixed(factor, a, b, clamps_factor: bool) -> np.ndarray:
    """Mix of numbers or vectors; the factor of vectors may be a vector."""
    factor = np.clip(factor, 0, 1) if clamps_factor else factor
    return a * (1 - factor) + b * factor


FUNCTIONS = {"mixed colors": mixed_colors, "mixed": mixed}
