# SPDX-License-Identifier: GPL-3.0-or-later
"""Converts file columns to the arrays of `Surfels` and back, including the two colour encodings that files use."""

from __future__ import annotations

import numpy as np

#: White in a file of integer colours: 255, unless a value needs more.
_WHITES = (255, 65535)

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

    Integers are sRGB display values, as every program writes them; floats are taken as scene-linear. White is 255 in
    integers of any type, or what the largest value needs, up to the type's limit.
    """
    names = next((group for group in _CHANNELS if has(columns, group)), None)
    if names is None:
        return None
    channels = [columns[name] for name in names]
    alphas = [columns[name] for name in _ALPHAS if name in columns][:1]
    values = [_fraction(column, channels + alphas) for column in channels]
    values = [v if column.dtype.kind == "f" else srgb_to_linear(v) for v, column in zip(values, channels, strict=True)]
    alpha = [_fraction(column, channels + alphas) for column in alphas] or [np.ones(len(values[0]))]
    with np.errstate(over="ignore"):
        return np.column_stack(values + alpha).astype(np.float32)


def linear_to_srgb(linear: np.ndarray) -> np.ndarray:
    """IEC 61966-2-1 for values of any size and sign, float64."""
    size = np.abs(np.asarray(linear, np.float64))
    return np.copysign(np.where(size <= 0.0031308, 12.92 * size, 1.055 * size ** (1 / 2.4) - 0.055), linear)


def srgb_to_linear(encoded: np.ndarray) -> np.ndarray:
    """The inverse of `linear_to_srgb`."""
    size = np.abs(np.asarray(encoded, np.float64))
    return np.copysign(np.where(size <= 0.04045, size / 12.92, ((size + 0.055) / 1.055) ** 2.4), encoded)


def _fraction(column: np.ndarray, colors: list[np.ndarray]) -> np.ndarray:
    """A column of `colors`, integers as fractions of white, which is the same for all columns of their type."""
    if column.dtype.kind == "f":
        return column.astype(np.float64)
    largest = max(_not_negative(other).max(initial=0) for other in colors if other.dtype == column.dtype)
    values = _not_negative(column)
    limit = np.iinfo(values.dtype).max
    return values / np.float64(min(next((white for white in _WHITES if largest <= white), limit), limit))


def _not_negative(column: np.ndarray) -> np.ndarray:
    """Integers, negative ones as 0, but signed bytes as the unsigned ones that programs mean by them."""
    return column.view(np.uint8) if column.dtype == np.int8 else np.maximum(column, 0)
