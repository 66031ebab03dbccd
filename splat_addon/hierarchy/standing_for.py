# SPDX-License-Identifier: GPL-3.0-or-later
"""What merged surfels have of numbers that surfels have beside their fields: means, and what most of an area has."""

from __future__ import annotations

import numpy as np

from .building import Hierarchy
from .refitting import by_level


def rounded_means(hierarchy: Hierarchy, areas: np.ndarray, values: np.ndarray) -> np.ndarray:
    """(N + M,) uint8 means of (N,) uint8 over the surfels that each of N surfels and M merged ones stands for. areas:
    (N,) float64, above 0."""
    return np.rint(_totals(hierarchy, areas * values) / _totals(hierarchy, areas)).astype(np.uint8)


def most_common(hierarchy: Hierarchy, areas: np.ndarray, values: np.ndarray) -> np.ndarray:
    """As `rounded_means`, what most of the area has; of several the lowest."""
    made, most = np.zeros((2, len(values) + len(hierarchy)))
    for value in np.unique(values):
        area = _totals(hierarchy, np.where(values == value, areas, 0))
        is_more = area > most
        made[is_more], most[is_more] = value, area[is_more]
    return made.astype(np.uint8)


def _totals(hierarchy: Hierarchy, amounts: np.ndarray) -> np.ndarray:
    """(N + M,) float64 sums of (N,) amounts over the surfels that each surfel and merged one stands for."""
    entries, counts = by_level(hierarchy)
    totals = np.zeros(len(amounts) + len(hierarchy))
    totals[: len(amounts)] = amounts
    level = totals[entries[0]]
    for numbers, own in zip(entries[1:], counts, strict=True):
        level = np.add.reduceat(level, np.cumsum(own) - own)
        totals[numbers] = level
    return totals
