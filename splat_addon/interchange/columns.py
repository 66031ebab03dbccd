# SPDX-License-Identifier: GPL-3.0-or-later
"""Converts file columns to the arrays of `Surfels` and back, including the colour encodings that files use."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

#: White in a file of integer colours, and of floats like them: the first, unless a value needs more.
_WHITES = (255, 65535)

#: The comment of files that this extension wrote.
VERSION = "surfel_splatting 1"

POSITION = ("x", "y", "z")
NORMAL = ("nx", "ny", "nz")
ROTATION = ("rot_0", "rot_1", "rot_2", "rot_3")
#: Channel names of a colour, without and with alpha.
_CHANNELS = (("red", "green", "blue"), ("r", "g", "b"), ("diffuse_red", "diffuse_green", "diffuse_blue"))
_ALPHAS = ("alpha", "a")

#: Floats of which more than a hundredth is above this are taken as numbers from 0 to 255 or 65535; a few may be light
#: that is brighter than white.
_BRIGHTEST, _FEW = 10.0, 0.01

#: More numbers than this are decoded by a table of all that two bytes hold.
_MANY = 1 << 16

#: What float colours can mean.
FLOAT_COLORS = ("DISPLAY", "LINEAR")

#: Properties that say again what others say, so that nobody misses them.
_REDUNDANT = {name for group in (*_CHANNELS, _ALPHAS) for name in group} | {"radius"}


class Columns(dict):
    """Columns by property name, which remember those that were read."""

    def __init__(self, columns: dict[str, np.ndarray]):
        super().__init__(columns)
        self._read = set()

    def __getitem__(self, name: str) -> np.ndarray:
        self._read.add(name)
        return super().__getitem__(name)

    def passed_over(self) -> list[str]:
        """A sentence about the columns that nobody read, or nothing."""
        names = [name for name in self if name not in self._read | _REDUNDANT]
        if not names:
            return []
        shown = ", ".join(name[:40] for name in names[:8]) + (" ..." if len(names) > 8 else "")
        return [f"Passed over {len(names):,} properties that surfels do not have: {shown}"]


def has(columns: dict[str, np.ndarray], *groups: tuple[str, ...]) -> bool:
    """Whether every column of every group exists."""
    return all(name in columns for group in groups for name in group)


def matrix(columns: dict[str, np.ndarray], names: tuple[str, ...], dtype=np.float32) -> np.ndarray:
    """(N, len(names)); values out of the range of `dtype` become infinite, so that later checks reject them."""
    with np.errstate(over="ignore", invalid="ignore"):
        return np.stack([columns[name].astype(dtype) for name in names], axis=1)


def origin_for(positions: np.ndarray) -> np.ndarray:
    """(3,) float64 an origin for (N, 3) finite float64 positions: 0, or the middle of their bounds if they are more
    precise than float32, as in files of double coordinates. It is rounded to float32, as a Blender object's location.
    """
    with np.errstate(over="ignore"):
        if not len(positions) or (positions.astype(np.float32) == positions).all():
            return np.zeros(3)
        middle = (positions.min(axis=0) / 2 + positions.max(axis=0) / 2).astype(np.float32).astype(np.float64)
    return middle if np.isfinite(middle).all() else np.zeros(3)


def numbers_of(comments: tuple[str, ...], word: str) -> np.ndarray | None:
    """(3,) float64 that a comment of this extension gives after a word; None if there is none. Raises ValueError if
    they are not 3 finite numbers."""
    for comment in comments if VERSION in comments else ():
        first, *values = comment.split()[:5] or [""]
        if first == word:
            try:
                numbers = np.array([float(value) for value in values])
            except ValueError:
                numbers = np.empty(0)
            if numbers.shape != (3,) or not np.isfinite(numbers).all():
                raise ValueError(f"The PLY file's comment {comment[:80]!r} must hold 3 finite numbers; correct it.")
            return numbers
    return None


def as_columns(names: tuple[str, ...], values: np.ndarray) -> dict[str, np.ndarray]:
    """(N, len(names)) as columns."""
    return dict(zip(names, values.T, strict=True))


def display_color(columns: dict[str, np.ndarray], floats: str = "DISPLAY") -> tuple[np.ndarray | None, list[str]]:
    """(N, 4) float32 scene-linear colours from red, green, blue and optionally alpha, None if the columns are missing;
    and a sentence about what was assumed, if that is not the rule.

    Colours are sRGB display values, as every program writes them and Blender reads them. White is 255 in integers of
    any type, or what the largest value needs, up to the type's limit. In floats it is 1, or 255 or 65535 if there are
    many values above 10; but if `floats` is "LINEAR", they are scene-linear as they are.
    """
    names = next((group for group in _CHANNELS if has(columns, group)), None)
    if names is None:
        return None, []
    channels = [columns[name] for name in names]
    alphas = [columns[name] for name in _ALPHAS if name in columns][:1]
    # the alpha of integers is on the scale of the colours, that of floats often is not
    scale = [*channels, *(alpha for alpha in alphas if alpha.dtype.kind != "f")]
    values = [
        column.astype(np.float64) if _is_linear(column, floats) else _decoded(column, _white(column, scale))
        for column in channels
    ]
    alpha = fractions(alphas[0], channels) if alphas else np.ones(len(values[0]))
    with np.errstate(over="ignore"):
        return np.column_stack([*values, alpha]).astype(np.float32), _assumed(channels, scale, floats)


def _decoded(column: np.ndarray, white: float) -> np.ndarray:
    """Scene-linear values of display values. Many small integers are decoded once each."""
    if column.dtype.kind == "u" and column.dtype.itemsize <= 2 and len(column) > _MANY:
        return srgb_to_linear(np.arange(int(column.max()) + 1) / white)[column]
    return srgb_to_linear(_not_negative(column) / white)


def with_white_1(columns: dict[str, np.ndarray], sample: dict[str, np.ndarray], floats: str) -> dict[str, np.ndarray]:
    """The columns with colours and opacities as floats whose white is 1, by what stands for it in `sample`, columns of
    the same names that have the largest values. floats: as in `display_color`, which then finds them as meant."""
    names = next((group for group in _CHANNELS if has(sample, group)), ())
    channels = [sample[name] for name in names]
    alphas = [name for name in _ALPHAS if name in sample][:1]
    scale = [*channels, *(sample[name] for name in alphas if sample[name].dtype.kind != "f")]
    whites = {name: _white(sample[name], scale) for name in names if not _is_linear(sample[name], floats)}
    for name in alphas:
        whites[name] = _white(sample[name], [sample[name], *(each for each in channels if each.dtype.kind != "f")])
    return columns | {n: _not_negative(columns[n]) / white for n, white in whites.items() if n in columns}


def _is_linear(column: np.ndarray, floats: str) -> bool:
    return floats == "LINEAR" and column.dtype.kind == "f"


def alpha_of(columns: dict[str, np.ndarray]) -> np.ndarray | None:
    """(N,) float64 opacities of a column alpha; None if there is none."""
    name = next((name for name in _ALPHAS if name in columns), None)
    return None if name is None else fractions(columns[name])


def fractions(column: np.ndarray, others: Sequence[np.ndarray] = ()) -> np.ndarray:
    """(N,) float64, numbers as fractions of the largest that a file may mean. others: integers on the same scale."""
    return _not_negative(column) / _white(column, [column, *(each for each in others if each.dtype.kind != "f")])


def linear_to_srgb(linear: np.ndarray) -> np.ndarray:
    """IEC 61966-2-1 for values of any size and sign, float64."""
    size = np.abs(np.asarray(linear, np.float64))
    return np.copysign(np.where(size <= 0.0031308, 12.92 * size, 1.055 * size ** (1 / 2.4) - 0.055), linear)


def srgb_to_linear(encoded: np.ndarray) -> np.ndarray:
    """The inverse of `linear_to_srgb`; what leaves float64's range becomes infinite."""
    size = np.abs(np.asarray(encoded, np.float64))
    with np.errstate(over="ignore"):
        return np.copysign(np.where(size <= 0.04045, size / 12.92, ((size + 0.055) / 1.055) ** 2.4), encoded)


def _white(column: np.ndarray, columns: list[np.ndarray]) -> np.float64:
    """What stands for 1 in a column, which is the same for all of its type."""
    values = [_not_negative(other) for other in columns if other.dtype == column.dtype]
    if column.dtype.kind == "f":
        finite = np.concatenate([other[np.isfinite(other)] for other in values])
        if np.count_nonzero(finite > _BRIGHTEST) <= _FEW * len(finite):
            return np.float64(1)
        small, large = _WHITES
        return np.float64(large if np.count_nonzero(finite > small) > _FEW * len(finite) else small)
    largest, limit = max(other.max(initial=0) for other in values), np.iinfo(values[0].dtype).max
    return np.float64(min(next((white for white in _WHITES if largest <= white), limit), limit))


def _assumed(channels: list[np.ndarray], scale: list[np.ndarray], floats: str) -> list[str]:
    """What was assumed of colours that are not bytes."""
    count, white, bits = len(channels[0]), _white(channels[0], scale), 8 * channels[0].dtype.itemsize
    if not count or bits == 8:
        return []
    if channels[0].dtype.kind == "f":
        meaning = "scene-linear" if floats == "LINEAR" else f"display values (sRGB), where white is {white:g}"
        return [f"Took the float colours of {count:,} points as {meaning}"]
    return [f"Took {white:g} as white in the {bits}-bit colours of {count:,} points"]


def _not_negative(column: np.ndarray) -> np.ndarray:
    """Floats as float64. Integers, negative ones as 0, but signed bytes as the unsigned ones that programs mean."""
    if column.dtype.kind == "f":
        return column.astype(np.float64)
    return column.view(np.uint8) if column.dtype == np.int8 else np.maximum(column, 0)
