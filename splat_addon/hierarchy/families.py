# SPDX-License-Identifier: GPL-3.0-or-later
"""Families of surfels that merge, gathered by size: numpy computes sums and extremes of c children of m parents along
an axis of its own, in arrays of (columns, c, m), several times faster than over runs of different lengths.

Most families of samples of a grid have the same few sizes. Families of rare sizes share a group: there the first child
fills the places of missing ones. Least and largest values stay what they are; in sums a filler has no area.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from .runs import Runs

#: Larger families are filled up to a power of two.
_LARGE = 64
#: Children in a group from which another group is worth its calls.
_WORTH = 1 << 12


@dataclass(frozen=True, eq=False)
class Families:
    """m families with places for c children. parents: (m,) their numbers. children: (c, m) positions of the children
    in the runs. counted: (c, m) float32, 0 where a place is filled; None if none is.
    """

    parents: np.ndarray
    children: np.ndarray
    counted: np.ndarray | None


def families(runs: Runs, most: int) -> Iterator[Families]:
    """All families of some runs by size. most: of children at a time, except in larger families."""
    for size, parents in _groups(runs.counts):
        places = np.arange(size)[:, None]
        step = max(most // size, 1)
        for start in range(0, len(parents), step):
            some = parents[start : start + step]
            is_child = places < runs.counts[some]
            children = runs.starts[some] + np.where(is_child, places, 0)
            yield Families(some, children, None if is_child.all() else is_child.astype(np.float32))


def _groups(counts: np.ndarray) -> Iterator[tuple[int, np.ndarray]]:
    """Places for children, and the families that share a group with as many."""
    doublings = np.ceil(np.log2(np.maximum(counts / _LARGE, 1))).astype(np.uint8)
    kinds = np.minimum(counts, _LARGE).astype(np.uint8) + doublings
    order, ends = np.argsort(kinds, kind="stable"), np.cumsum(np.bincount(kinds))
    present = np.unique(kinds).tolist()
    start, least = 0, None
    for kind, following in zip(present, [*present[1:], None], strict=True):
        size, end = _places(kind), int(ends[kind])
        least = least or size
        is_worth = (end - start) * size >= _WORTH
        if following is None or is_worth or _places(following) > 2 * least:
            yield size, order[start:end]
            start, least = end, None


def _places(kind: int) -> int:
    return kind if kind <= _LARGE else _LARGE << (kind - _LARGE)


def for_children(columns: np.ndarray) -> np.ndarray:
    """(..., 1, m) values of m parents, as they combine with those of their children."""
    return columns[..., None, :]


def total(columns: np.ndarray) -> np.ndarray:
    """(..., m) sums of (..., c, m) over the children; pairwise where there are so many that rounding errors add up."""
    while columns.shape[-2] > _LARGE:
        half = columns.shape[-2] // 2
        columns = columns[..., :half, :] + columns[..., half:, :]
    return columns.sum(axis=-2)


def largest(values: np.ndarray) -> np.ndarray:
    """(..., m) the largest of (..., c, m) of each family."""
    return values.max(axis=-2)


def dot(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """(n,) products of (3, n) vectors, or (c, m) of (3, c, m), of which one may be (3, 1, m)."""
    return np.einsum("k...,k...->...", a, b)
