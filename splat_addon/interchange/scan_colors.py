# SPDX-License-Identifier: GPL-3.0-or-later
"""What scanners measure, as colours: numbers along a ramp, and the classes of the LAS standard.

All colours are in linear Rec. 709.
"""

from __future__ import annotations

import numpy as np

#: Shares of the values below and above the range that a ramp covers if none is given, so that a few extreme ones do not
#: leave it to themselves.
_OUTSIDE = 0.02

#: The colour of points whose value is unknown.
UNKNOWN = (0.2, 0.2, 0.2)


def _linear(*codes: str) -> np.ndarray:
    """(n, 3) float32 linear colours of hexadecimal sRGB codes."""
    display = np.array([[int(code[k : k + 2], 16) / 255 for k in (0, 2, 4)] for code in codes])
    return np.where(display <= 0.04045, display / 12.92, ((display + 0.055) / 1.055) ** 2.4).astype(np.float32)


#: The ramp where none is given, from the lowest value to the highest: its lightness rises evenly.
RAMP = _linear("1a1f4d", "1f5a8c", "2a9088", "7cc05a", "f7e45c")
GREYS = _linear("303030", "626262", "949494", "c6c6c6", "f8f8f8")

#: The colours of classes 0 to 18 of LAS 1.4 (ASPRS), which names none: those of what the classes stand for.
#: Never classified, unclassified, ground, low, medium and high vegetation, building, low noise, key point, water, rail,
#: road, overlap, wire guard, conductor, tower, connector, bridge deck, high noise.
CLASSES = _linear(
    *("9a9a9a", "b8b8b8", "a5713f", "b5d46a", "6fb84a", "2f8038", "d9604c", "ff00ff", "8f8f6a", "3f7fd0"),
    *("8a5aa8", "5c5c66", "c0a878", "f0d040", "f5a623", "405fa8", "c86fc0", "d0c8b8", "ff55aa"),
)


def on_ramp(values: np.ndarray, ramp: np.ndarray, low: float | None = None, high: float | None = None) -> np.ndarray:
    """(N, 3) float32 colours of (N,) values along a ramp of (n, 3) colours at even steps; beyond its ends they stay.

    low, high: the values at its ends; by default all but the lowest and highest 2 % lie between them. Where all values
    are the same, they lie in its middle. Values that are no numbers are `UNKNOWN`.
    """
    numbers = np.asarray(values, np.float64)
    is_known = np.isfinite(numbers)
    if not is_known.any():
        return np.tile(np.float32(UNKNOWN), (len(numbers), 1))
    if low is None or high is None:
        low, high = (end if given is None else given for end, given in zip(ends_of(numbers), (low, high), strict=True))
    with np.errstate(invalid="ignore"):
        share = np.clip((numbers - low) / (high - low), 0, 1) if high != low else np.full(len(numbers), 0.5)
    steps = np.linspace(0, 1, len(ramp))
    colors = np.stack([np.interp(share, steps, channel) for channel in np.asarray(ramp).T], axis=1)
    colors[~is_known] = UNKNOWN
    return colors.astype(np.float32)


def ends_of(values: np.ndarray) -> tuple[float, float]:
    """The range of numbers that a ramp covers if none is given: all but the lowest and highest 2 %; 0 to 1 of none."""
    known = values[np.isfinite(values)]
    return tuple(np.quantile(known, (_OUTSIDE, 1 - _OUTSIDE)).tolist()) if len(known) else (0.0, 1.0)


def of_classes(values: np.ndarray) -> np.ndarray:
    """(N, 3) float32 colours of (N,) numbers of classes; `UNKNOWN` beyond those that the standard names."""
    numbers = np.asarray(values)
    table = np.concatenate([CLASSES, np.float32([UNKNOWN])])
    is_named = (numbers >= 0) & (numbers < len(CLASSES))
    return table[np.where(is_named, numbers, len(CLASSES)).astype(np.int64)]
