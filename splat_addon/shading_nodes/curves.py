# SPDX-License-Identifier: GPL-3.0-or-later
"""Curves and ramps as tables that are looked up."""

from __future__ import annotations

import numpy as np

from .numbers import rows_at


def looked_up(place: np.ndarray, table: np.ndarray, extends: bool = False) -> np.ndarray:
    """(n,) values of a (k,) table over 0 to 1, interpolated. extends: whether its ends go on as straight lines."""
    last = len(table) - 1
    at = np.clip(place, 0, 1) * np.float32(last)
    low = rows_at(at, last - 1)
    first = table.take(low)
    result = first + (at - low) * (table.take(low + 1) - first)
    if extends:
        beyond = place - np.clip(place, 0, 1)
        slope = np.where(beyond < 0, table[1] - table[0], table[-1] - table[-2]) * np.float32(last)
        result = result + beyond * slope
    return result


def ramp(factor: np.ndarray, table: np.ndarray, is_stepped: bool) -> np.ndarray:
    """(3, n) colours of a ramp's (k, 3) table."""
    if is_stepped:
        at = np.clip(factor, 0, 1) * np.float32(len(table) - 1)
        return table.take(rows_at(at, len(table) - 1), axis=0).T
    return np.stack([looked_up(factor, column) for column in table.T])


def ramp_alpha(factor: np.ndarray, table: np.ndarray, is_stepped: bool) -> np.ndarray:
    """(n,) alphas of a ramp's (k, 1) table."""
    return ramp(factor, table, is_stepped)[0]


def curved(factor, values, table: np.ndarray, low: float, high: float, extends: bool) -> np.ndarray:
    """RGB Curves, Vector Curves and Float Curve: a (k, 3) or (k, 1) table over `low` to `high`, for each component."""
    place = (values - np.float32(low)) / np.float32(high - low)
    if values.ndim == 1:
        found = looked_up(place, table[:, 0], extends)
    else:
        found = np.stack([looked_up(row, column, extends) for row, column in zip(place, table.T, strict=True)])
    return values + factor * (found - values)


FUNCTIONS = {"ramp": ramp, "ramp alpha": ramp_alpha, "curves": curved}
