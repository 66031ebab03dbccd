# SPDX-License-Identifier: GPL-3.0-or-later
"""The vector nodes: Vector Math, Mapping, Vector Rotate, Normal and transforms."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from . import numbers
from .colors import stacked
from .numbers import divided


def dot(a, b) -> np.ndarray:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a, b) -> np.ndarray:
    return stacked(a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def length(a) -> np.ndarray:
    return np.sqrt(dot(a, a))


def unit(a) -> np.ndarray:
    """The vector with the length 1; 0 stays."""
    return divided(a, length(a))


def _reflected(a, b):
    normal = unit(b)
    return a - 2 * normal * dot(a, normal)


def _refracted(a, b, ratio):
    normal = unit(b)
    along = dot(normal, a)
    rest = 1 - ratio * ratio * (1 - along * along)
    return np.where(rest < 0, 0, ratio * a - (ratio * along + np.sqrt(np.maximum(rest, 0))) * normal)


#: Operations of the Math node that act on each component.
_BY_COMPONENT = (
    *("ADD", "SUBTRACT", "MULTIPLY", "DIVIDE", "MULTIPLY_ADD", "ABSOLUTE", "POWER", "SIGN", "MINIMUM", "MAXIMUM"),
    *("FLOOR", "CEIL", "MODULO", "WRAP", "SNAP", "SINE", "COSINE", "TANGENT"),
)

#: operation of a Vector Math node -> its number of vectors, and its function. The scale comes as a fourth input.
OPERATIONS: dict[str, tuple[int, Callable]] = {
    **{name: numbers.OPERATIONS[name] for name in _BY_COMPONENT},
    "FRACTION": numbers.OPERATIONS["FRACT"],
    "CROSS_PRODUCT": (2, cross),
    "PROJECT": (2, lambda a, b: b * divided(dot(a, b), dot(b, b))),
    "REFLECT": (2, _reflected),
    "FACEFORWARD": (3, lambda a, b, c: np.where(dot(c, b) < 0, a, -a)),
    "DOT_PRODUCT": (2, dot),
    "DISTANCE": (2, lambda a, b: length(a - b)),
    "LENGTH": (1, length),
    "NORMALIZE": (1, unit),
    "ROUND": (1, np.round),
}

#: Operations that use the number Scale beside their vectors.
SCALED: dict[str, Callable] = {"SCALE": lambda a, b, scale: a * scale, "REFRACT": _refracted}

#: Operations whose result is a number.
NUMBERS = ("DOT_PRODUCT", "DISTANCE", "LENGTH")


def vector_math(a, b, c, scale, operation: str) -> np.ndarray:
    """The Vector Math node."""
    if operation in SCALED:
        return np.asarray(SCALED[operation](a, b, scale), np.float32)
    count, function = OPERATIONS[operation]
    return np.asarray(function(*(a, b, c)[:count]), np.float32)


def turned(vector, angles, is_inverse: bool = False) -> np.ndarray:
    """A vector turned by Euler angles about x, then y, then z; is_inverse: turned back."""
    for axis in (2, 1, 0) if is_inverse else (0, 1, 2):
        angle = -angles[axis] if is_inverse else angles[axis]
        cosine, sine = np.cos(angle), np.sin(angle)
        first, second = vector[(axis + 1) % 3], vector[(axis + 2) % 3]
        rows = [None] * 3
        rows[axis] = vector[axis]
        rows[(axis + 1) % 3] = cosine * first - sine * second
        rows[(axis + 2) % 3] = sine * first + cosine * second
        vector = stacked(*rows)
    return vector


def mapped(vector, location, rotation, scale, kind: str) -> np.ndarray:
    """The Mapping node."""
    if kind == "TEXTURE":
        return divided(turned(vector - location, rotation, True), scale)
    if kind == "NORMAL":
        return unit(turned(divided(vector, scale), rotation))
    moved = turned(vector * scale, rotation)
    return moved + location if kind == "POINT" else moved


def _about(vector, axis, angle) -> np.ndarray:
    """Rodrigues' rotation about an axis; an axis without length turns nothing."""
    size = length(axis)
    axis = unit(axis)
    cosine, sine = np.cos(angle), np.sin(angle)
    result = vector * cosine + cross(axis, vector) * sine + axis * dot(axis, vector) * (1 - cosine)
    return np.where(size != 0, result, vector)


def rotated(vector, center, axis, angle, rotation, kind: str, is_inverse: bool) -> np.ndarray:
    """The Vector Rotate node."""
    offset = vector - center
    if kind == "EULER_XYZ":
        return turned(offset, rotation, is_inverse) + center
    if kind != "AXIS_ANGLE":
        axis = np.eye(3, dtype=np.float32)["XYZ".index(kind[0])][:, None]
    return _about(offset, axis, -angle if is_inverse else angle) + center


def transformed(vector, matrix: np.ndarray) -> np.ndarray:
    """A vector transformed by a (3, 4) float32 matrix."""
    return stacked(*(dot(row[:3], vector) + row[3] for row in matrix))


def bumped(heights, places, normal, strength, distance) -> np.ndarray:
    """The (3, n) unit normal that a height bends, as in Mikkelsen, "Bump Mapping Unparametrized Surfaces on the GPU",
    2010.

    heights: (n,) at the samples and at their neighbours in the two directions of the grid, and likewise (3, n) places.
    """
    right, up = (place - places[0] for place in places[1:])
    across = cross(up, normal), cross(normal, right)
    area = dot(right, across[0])
    slope = (heights[1] - heights[0]) * across[0] + (heights[2] - heights[0]) * across[1]
    bent = unit(np.abs(area) * normal - distance * np.sign(area) * slope)
    strength = np.maximum(strength, 0)
    return np.where(area == 0, normal, unit(strength * bent + (1 - strength) * normal))


def halved(vector) -> np.ndarray:
    """A unit vector as the colour of a normal map."""
    return vector / 2 + np.float32(0.5)


FUNCTIONS = {
    "halved": halved,
    "vector math": vector_math,
    "mapping": mapped,
    "rotated": rotated,
    "transformed": transformed,
    "unit": unit,
    "dot": dot,
}
