# SPDX-License-Identifier: GPL-3.0-or-later
"""What is known of the few different instances of a scene, as arrays; thousands of instances look it up."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from ...surfels import Surfels
from .kinds import depends_on_nothing_else, kind_key, numbered

if TYPE_CHECKING:
    from .placed import Placed


@dataclass(frozen=True, eq=False)
class Prototypes:
    """p instances that differ in more than their places, of k kinds and with s shapes.

    kinds: (p,) int32 rows of `every_kind`. shape_of: (p,) int32 rows of `shapes`. light_sets: (p,). splits: (p, 2)
    `split_distance` and `split_length`, NaN for none. materials: (p,) how many they have. are_holdouts: (p,) bool.
    origins, low, high: (s, 3) of each shape, the last two relative to the first. sizes: (s, 3) of each shape: how many
    surfels or corners it has, and how far these extend at most, without large surfels in the last column; 0 for
    polygons. known: what was found of every kind.
    """

    kinds: np.ndarray
    every_kind: tuple[Placed, ...]
    shape_of: np.ndarray
    shapes: tuple
    light_sets: np.ndarray
    splits: np.ndarray
    materials: np.ndarray
    are_holdouts: np.ndarray
    origins: np.ndarray
    low: np.ndarray
    high: np.ndarray
    sizes: np.ndarray
    known: dict = field(default_factory=dict)

    @classmethod
    def of(cls, placed: Sequence[Placed]) -> Prototypes:
        kinds, kind_of = numbered(map(kind_key(), placed))
        first, shape_of = numbered(id(one.shape) for one in placed)
        shapes = tuple(placed[row].shape for row in first)
        bounds = [shape.local_bounds for shape in shapes]
        nothing = float("nan")
        splits = [(one.split_distance or nothing, one.split_length or nothing) for one in placed]
        return cls(
            kinds=kind_of,
            every_kind=tuple(placed[row] for row in kinds),
            shape_of=shape_of,
            shapes=shapes,
            light_sets=np.array([one.light_set for one in placed], np.int64),
            splits=np.array(splits, np.float64).reshape(-1, 2),
            materials=np.array([len(one.materials) for one in placed], np.int64),
            are_holdouts=np.array([one.is_holdout for one in placed], bool),
            origins=np.array([shape.origin for shape in shapes], np.float64).reshape(-1, 3),
            low=np.array([low for low, _ in bounds]).reshape(-1, 3),
            high=np.array([high for _, high in bounds]).reshape(-1, 3),
            sizes=np.array([_sizes(shape) for shape in shapes], np.float64).reshape(-1, 3),
        )

    def with_more(self, others: Prototypes) -> Prototypes:
        """These, and others after them."""
        names = "light_sets", "splits", "materials", "are_holdouts", "origins", "low", "high", "sizes"
        return Prototypes(
            kinds=np.concatenate([self.kinds, others.kinds + np.int32(len(self.every_kind))]),
            every_kind=self.every_kind + others.every_kind,
            shape_of=np.concatenate([self.shape_of, others.shape_of + np.int32(len(self.shapes))]),
            shapes=self.shapes + others.shapes,
            **{name: np.concatenate([getattr(self, name), getattr(others, name)]) for name in names},
        )

    @cached_property
    def triangles(self) -> np.ndarray:
        """(s,) int: triangles that are drawn of each shape, one for a surfel."""
        of_each = np.array([1 if isinstance(shape, Surfels) else 3 for shape in self.shapes], np.int64)
        return self.sizes[:, 0].astype(np.int64) // of_each

    def holds(self, which: Callable[[Placed], bool], present: Callable[[], list[int]]) -> np.ndarray:
        """(p,) bool: whether something holds for the kind of each. It is found once, if the function depends on nothing
        else; otherwise of the kinds that are `present`."""
        if depends_on_nothing_else(which):
            if which.__code__ not in self.known:
                self.known[which.__code__] = np.array([bool(which(one)) for one in self.every_kind], bool)[self.kinds]
            return self.known[which.__code__]
        chosen = np.zeros(len(self.every_kind), bool)
        for kind in present():
            chosen[kind] = which(self.every_kind[kind])
        return chosen[self.kinds]


def _sizes(shape) -> tuple[float, float, float]:
    if isinstance(shape, Surfels):
        return len(shape), shape.largest, shape.largest_grain
    return len(shape), 0.0, 0.0
