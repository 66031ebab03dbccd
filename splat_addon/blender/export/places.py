# SPDX-License-Identifier: GPL-3.0-or-later
"""The places of many thousand entries as arrays, in the order of the entries."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from ..mesh_sampling_settings import Form
from .styles import OF_MATERIALS, ObjectStyle
from .traits import Traits


class Manner(NamedTuple):
    """What is the same at many places of a mesh. traits: of its instances. form: how it is rendered, see `form_of`.
    detail: of its object. style: what replaces that of its materials."""

    traits: Traits
    form: Form
    detail: float
    style: ObjectStyle = OF_MATERIALS


@dataclass(frozen=True, eq=False)
class Places:
    """n places of a mesh. of: (n,) which manner each is in. matrices: (n, 4, 4) float32."""

    manners: tuple[Manner, ...]
    of: np.ndarray
    matrices: np.ndarray

    def __len__(self) -> int:
        return len(self.of)

    def where(self, which: Callable[[Form], bool]) -> Places:
        """The places in some forms."""
        chosen = np.array([which(manner.form) for manner in self.manners], bool)
        if chosen.all():
            return self
        rows, numbers = chosen[self.of], np.cumsum(chosen) - 1
        manners = tuple(manner for manner, is_chosen in zip(self.manners, chosen.tolist(), strict=True) if is_chosen)
        return Places(manners, numbers[self.of[rows]], self.matrices[rows])

    def with_manners(self, change: Callable[[Manner], Manner]) -> Places:
        """The same places in other manners."""
        return replace(self, manners=tuple(map(change, self.manners)))


def in_order(rows: Sequence[Sequence[int]]) -> tuple[np.ndarray, np.ndarray]:
    """(n,) the rows of several kinds in increasing order, and (n,) which kind each is of."""
    every = np.concatenate([np.zeros(0, int), *(np.array(each, int) for each in rows)])
    of = np.repeat(np.arange(len(rows)), [len(each) for each in rows])
    order = np.argsort(every, kind="stable")
    return every[order], of[order]


def parts_at(of: np.ndarray, counts: Sequence[int]) -> tuple[np.ndarray, np.ndarray]:
    """(m,) which of n places, and (m,) which part, if what is there is in several parts, those of one kind after those
    of the one before. of: (n,) the kinds. counts: how many parts each kind has."""
    counts = np.array(counts, int)
    of_each = counts[of]
    rows = np.repeat(np.arange(len(of)), of_each)
    within = np.arange(len(rows)) - np.repeat(np.cumsum(of_each) - of_each, of_each)
    return rows, (np.cumsum(counts) - counts)[of][rows] + within
