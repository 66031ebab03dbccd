# SPDX-License-Identifier: GPL-3.0-or-later
"""Converts file columns to the arrays of `Surfels` and back, including the two colour encodings that files use."""

from __future__ import annotations

import numpy as np

#: 8 and 16 bit colours are display values; numpy type code -> the value of white.
_WHITES = {"u1": 255, "u2": 65535}

POSITION = ("x", "y", "z")
NORMAL = ("nx", "ny", "nz")
ROTATION = ("rot_0", "rot_1", "rot_2", "rot_3")
#: Channel names of a colour, without and with alpha.
_CHANNELS = (("red", "green", "blue"), ("r", "g", "b"), ("diffuse_red", "diffuse_green", "diffuse_blue"))
_ALPHAS = ("alpha", "a")


def has(columns: dict[str, np.ndarray], *groups: tuple[str, ...]) -> bool:
    """Whether every column of every group exists."""
    return all(name in columns for group in groups for name in group)


def matrix(columns: dict[str, np.ndarray], names: tuple[str, ...], dtype=np.float32) -> np.ndarray:
    """(N, len(names)); values out of the range of `dtype` become infinite, so that later checks reject them."""
    with np.errstate(over="ignore", invalid="ignore"):
        return np.stack([columns[name].astype(dtype) for name in names], axis=1)


def as_columns(names: tuple[str, ...], values: np.ndarray) -> dict[str, np.ndarray]:
    """(N, len(names)) as columns."""
    return dict(zip(names, values.T, strict=True))


def display_color(columns: dict[str, np.ndarray]) -> np.ndarray | None:
    """(N, 4) float32 scene-linear colours from red, green, blue and optionally alpha; None if the columns are missing.

    Integers are sRGB display values, as every program writes them; floats are taken as scene-linear.
    """
    names = next((group for group in _CHANNELS if has(columns, group)), None)
    if names is None:
        return None
    values = np.stack([_fraction(columns[name]) for name in names], axis=1)
    if columns[names[0]].dtype.kind != "f":
        values = srgb_to_linear(values)
    alpha = next((_fraction(columns[name]) for name in _ALPHAS if name in columns), np.ones(len(values)))
    with np.errstate(over="ignore"):
        return np.column_stack([values, alpha]).astype(np.float32)


def linear_to_srgb(linear: np.ndarray) -> np.ndarray:
    """IEC 61966-2-1 for values of any size and sign, float64."""
    size = np.abs(np.asarray(linear, np.float64))
    return np.copysign(np.where(size <= 0.0031308, 12.92 * size, 1.055 * size ** (1 / 2.4) - 0.055), linear)


def srgb_to_linear(encoded: np.ndarray) -> np.ndarray:
    """The inverse of `linear_to_srgb`."""
    size = np.abs(np.asarray(encoded, np.float64))
    return np.copysign(np.where(size <= 0.04045, size / 12.92, ((size + 0.055) / 1.055) ** 2.4), encoded)


def _fraction(column: np.ndarray) -> np.ndarray:
    return column / np.float64(_WHITES.get(column.dtype.str[1:], 1))
