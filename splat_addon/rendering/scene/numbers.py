# SPDX-License-Identifier: GPL-3.0-or-later
"""Limits of the numbers that a scene may have: within them, float64 can square what it computes with, and pictures are
finite."""

from __future__ import annotations

import numpy as np

#: Lengths and coordinates in world units, and factors by which matrices lengthen.
MIN_LENGTH, MAX_LENGTH = 1e-38, 1e38

#: A matrix whose shortest axis is below this share of its longest leaves no direction for a normal.
FLATTEST = 1e-12

#: Radiance and colours, per channel: more would overflow float32 after lighting.
MAX_RADIANCE = 1e30

#: Factors of reflectance, and other numbers whose square must fit into float32.
MAX_FACTOR = 1e15

#: Indices of objects and materials.
MAX_INDEX = (1 << 31) - 1


def check_range(what: str, value, least: float, most: float, is_whole: bool = False) -> None:
    """Raise ValueError with a sentence unless all numbers of a value lie between these. what: the sentence's
    subject."""
    if type(value) in (int, float) and least <= value <= most and (not is_whole or value % 1 == 0):
        return
    numbers = np.asarray(value, np.float64)
    if not ((numbers >= least) & (numbers <= most)).all() or (is_whole and (numbers % 1).any()):
        shown = numbers.tolist() if numbers.ndim < 2 else "an array with others"
        raise ValueError(f"{what} must be {'a whole number, ' * is_whole}{least:g} to {most:g}, not {shown}.")


def check_lengths(what: str, value) -> None:
    """The same for coordinates, which may be negative."""
    check_range(what, value, -MAX_LENGTH, MAX_LENGTH)


def check_radiance(what: str, value) -> None:
    """The same for three channels, or rows of them. Negative light darkens."""
    check_range(what, value, -MAX_RADIANCE, MAX_RADIANCE)
    if np.shape(value)[-1:] != (3,):
        raise ValueError(f"{what} must be 3 numbers, not {value!r}.")
