# SPDX-License-Identifier: GPL-3.0-or-later
"""Instances are of one *kind* if they differ only in where they are, what they are called, which lights light them and
where they are split. What does not depend on that is decided once for each kind."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import fields
from types import FunctionType
from typing import TYPE_CHECKING, NamedTuple, TypeVar

import numpy as np

if TYPE_CHECKING:
    from .placed import Placed

Found = TypeVar("Found")

#: Fields in which instances of one kind differ, or that are compared in another way.
_APART = {"shape", "matrix_world", "light_set", "name", "index", "split_distance", "split_length"}


class Kind(NamedTuple):
    """placed: one of the instances. count: how many there are."""

    placed: Placed
    count: int


class Kinds(tuple[Kind, ...]):
    """Kinds of instances, and what was found of them."""

    def holds(self, which: Callable[[Placed], bool]) -> list[bool]:
        """Whether something holds for each of them. It is found once, if the function depends on nothing else."""
        if not depends_on_nothing_else(which):
            return [which(kind.placed) for kind in self]
        return self._kept(which.__code__, lambda: [which(kind.placed) for kind in self])

    def of(self, kind: type) -> Kinds:
        """Those that are of a class; the same object each time."""
        return self._kept(kind, lambda: Kinds(one for one in self if isinstance(one.placed, kind)))

    def find(self, fact: Callable[[Kinds], Found]) -> Found:
        """fact(self), found once."""
        return self._kept(fact, lambda: fact(self))

    def _kept(self, key, make: Callable[[], Found]) -> Found:
        known = self.__dict__.setdefault("known", {})
        if key not in known:
            known[key] = make()
        return known[key]


def depends_on_nothing_else(which: Callable) -> bool:
    """Whether the result of a function is always the same for an instance."""
    return isinstance(which, FunctionType) and which.__closure__ is None and which.__defaults__ is None


def kind_key() -> Callable[[Placed], tuple]:
    """The function that gives equal keys to instances of one kind."""
    names, by_value, by_id = {}, {}, {}

    def number(value: tuple) -> int:
        # most instances of an object have the very same tuple of materials, and comparing values takes longer
        if id(value) not in by_id:
            by_id[id(value)] = by_value.setdefault(value, len(by_value))
        return by_id[id(value)]

    def key(one: Placed) -> tuple:
        kind = type(one)
        if kind not in names:
            names[kind] = tuple(f.name for f in fields(one) if f.name not in _APART)
        values = [getattr(one, name) for name in names[kind]]
        return (kind, id(one.shape), one.is_split, *(number(v) if type(v) is tuple else v for v in values))

    return key


def numbered(keys: Iterable) -> tuple[list[int], np.ndarray]:
    """The place of the first of each key, and (n,) int32 the number of each."""
    numbers, first, of = {}, [], []
    for place, key in enumerate(keys):
        number = numbers.setdefault(key, len(first))
        if number == len(first):
            first.append(place)
        of.append(number)
    return first, np.array(of, np.int32)
