# SPDX-License-Identifier: GPL-3.0-or-later
"""The Checker, Gradient, White Noise, Magic and Brick textures."""

from __future__ import annotations

import numpy as np

from ..colors import stacked
from .hashes import random
from .noise import in_dimensions


def checker(vector, first, second, scale) -> np.ndarray:
    """(4, n): the colour, and 1 where it is the first."""
    # away from whole numbers, at which rounding would decide
    cells = np.floor((vector * scale + np.float32(1e-6)) * np.float32(0.999999))
    x, y, z = (cells.astype(np.int64) & 1).astype(bool)
    is_first = (x == y) == z
    return _with_factor(np.where(is_first, first, second), is_first)


def _with_factor(color, factor) -> np.ndarray:
    return np.stack(np.broadcast_arrays(*color, factor)).astype(np.float32)


def gradient(vector, kind: str) -> np.ndarray:
    """(n,) the Gradient Texture."""
    x, y, _ = vector
    if kind in ("SPHERICAL", "QUADRATIC_SPHERE"):
        inside = np.maximum(np.float32(0.999999) - np.sqrt((vector * vector).sum(axis=0)), 0)
        return np.clip(inside if kind == "SPHERICAL" else inside * inside, 0, 1)
    eased = np.clip(x, 0, 1)
    return np.clip(
        {
            "LINEAR": lambda: x,
            "QUADRATIC": lambda: np.maximum(x, 0) ** 2,
            "EASING": lambda: eased * eased * (3 - 2 * eased),
            "DIAGONAL": lambda: (x + y) * np.float32(0.5),
            "RADIAL": lambda: np.arctan2(y, x) / np.float32(2 * np.pi) + np.float32(0.5),
        }[kind](),
        0,
        1,
    )


def white_noise(vector, w, dimensions: str) -> np.ndarray:
    """(4, n): the colour, and the number."""
    places = in_dimensions(vector, w, dimensions)
    return np.stack([*random_color(places), random(*places)])


def random_color(places: list[np.ndarray]) -> list[np.ndarray]:
    """Three random numbers of a place."""
    if len(places) < 4:
        return [random(*places), random(*places, np.float32([1])), random(*places, np.float32([2]))]
    x, y, z, w = places
    return [random(x, y, z, w), random(z, x, w, y), random(w, z, y, x)]


#: What the Magic Texture does in turn: which of x, y, z it sets, with which signs it adds them, and the function.
_TURNS = (
    (1, (1, -1, 1), lambda a: -np.cos(a)),
    (0, (1, -1, -1), np.cos),
    (2, (-1, -1, -1), np.sin),
    (0, (-1, 1, -1), lambda a: -np.cos(a)),
    (1, (-1, 1, 1), lambda a: -np.sin(a)),
    (1, (-1, 1, 1), lambda a: -np.cos(a)),
    (0, (1, 1, 1), np.cos),
    (2, (1, 1, -1), np.sin),
    (0, (-1, -1, 1), lambda a: -np.cos(a)),
    (1, (1, -1, 1), lambda a: -np.sin(a)),
)


def magic(vector, scale, distortion, depth: int) -> np.ndarray:
    """(3, n) the colour of the Magic Texture."""
    x, y, z = np.fmod(vector, np.float32(2 * np.pi))
    five = 5 * scale
    found = [np.sin((x + y + z) * five), np.cos((-x + y - z) * five), -np.cos((-x - y + z) * five)]
    if depth > 0:
        found = [value * distortion for value in found]
    for which, signs, function in _TURNS[:depth]:
        found[which] = function(sum(s * value for s, value in zip(signs, found, strict=True))) * distortion
    whole = np.where(distortion != 0, 2 * distortion, 1)
    return np.float32(0.5) - stacked(*found) / whole


def brick(
    vector, first, second, mortar, scale, mortar_size, smooth, bias, width, height, offset, every, squash, squash_every
) -> np.ndarray:
    """(4, n): the colour, and the share of mortar. offset and squash are those of one row in `every` and
    `squash_every`."""
    x, y, _ = vector * scale
    row = np.floor(y / height)
    shift = np.zeros(1, np.float32)
    if every and squash_every:
        width = width * np.where(np.mod(row, squash_every) != 0, 1, np.float32(squash))
        shift = np.where(np.mod(row, every) != 0, 0, width * np.float32(offset))
    x = x + shift
    number = np.floor(x / width)
    x, y = x - width * number, y - height * row
    tint = np.clip(_of_brick(row, number) + bias, 0, 1)
    distance = np.minimum(np.minimum(x, y), np.minimum(width - x, height - y))
    place = np.clip((1 - distance / mortar_size) / np.where(smooth == 0, 1, smooth), 0, 1)
    eased = np.where(smooth == 0, 1, place * place * (3 - 2 * place))
    share = np.where(distance >= mortar_size, 0, eased)
    color = first + tint * (second - first)
    return _with_factor(color + share * (mortar - color), share)


def _of_brick(row, number) -> np.ndarray:
    """(n,) a random number of a brick, 0 to 1."""
    with np.errstate(over="ignore"):
        n = (row.astype(np.int64) << 16) + (number.astype(np.int64) & 0xFFFF)
        n = ((n + 1013) & 0x7FFFFFFF).astype(np.uint32)
        n = (n >> np.uint32(13)) ^ n
        n = (n * (n * n * np.uint32(60493) + np.uint32(19990303)) + np.uint32(1376312589)) & np.uint32(0x7FFFFFFF)
    return np.float32(0.5) * (n.astype(np.float32) / np.float32(1073741824))


FUNCTIONS = {
    "checker": checker,
    "gradient": gradient,
    "white noise": white_noise,
    "magic": magic,
    "brick": brick,
}
