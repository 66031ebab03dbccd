# SPDX-License-Identifier: GPL-3.0-or-later
"""Many instances as few different ones, their *prototypes*, and the matrix of each: an instance of many is an object of
Python only while something asks for it."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import fields, replace
from operator import index
from typing import TYPE_CHECKING
from weakref import WeakValueDictionary

import numpy as np

from .numbers import MAX_LENGTH

if TYPE_CHECKING:
    from .placed import Placed


class Placements(Sequence):
    """n instances. One that is asked for twice is the same object, as long as anything refers to it.

    prototypes: what differs in more than its place. are_copied: (p,) bool, those whose instances are copies of it at
    other places; of the others each is its only instance. of: (n,) int32, the prototype of each. matrices: (n, 3, 4)
    object to world, float32 if that holds every number exactly, as it does those of Blender, or float64.
    """

    def __init__(self, prototypes: Sequence[Placed], are_copied: np.ndarray, of: np.ndarray, matrices: np.ndarray):
        self.prototypes, self.are_copied, self.of, self.matrices = tuple(prototypes), are_copied, of, matrices
        self._whole: Placements | None = None
        self._first = 0
        self._made: WeakValueDictionary[int, Placed] = WeakValueDictionary()

    def __reduce__(self):
        return Placements, (self.prototypes, self.are_copied, self.of, self.matrices)

    def __len__(self) -> int:
        return len(self.of)

    def __getitem__(self, at):
        """An instance, or those of a slice without steps."""
        if isinstance(at, slice):
            return self._run(range(len(self))[at])
        row = index(at)
        number = int(self.of[row])
        if not self.are_copied[number]:
            return self.prototypes[number]
        key = self._first + row % len(self)
        made = self._made.get(key)
        if made is None:
            made = self._made[key] = _at(self.prototypes[number], self.matrices[row])
        return made

    def _run(self, rows: range) -> Placements:
        if rows == range(len(self)):
            return self
        own = slice(rows.start, rows.stop)
        part = Placements(self.prototypes, self.are_copied, self.of[own], self.matrices[own])
        part._whole, part._first, part._made = self._whole or self, self._first + rows.start, self._made
        return part

    def follows(self, other: Placements) -> bool:
        """Whether it is what comes after another part of the same instances."""
        return self._made is other._made and self._first == other._first + len(other)

    def pruned(self) -> Placements:
        """The same without prototypes that none of them has."""
        are_present = self._are_present
        if are_present.all():
            return self
        of = (np.cumsum(are_present, dtype=np.int32) - 1)[self.of]
        return Placements(self.different, self.are_copied[are_present], of, self.matrices)

    def changed(self, change: Callable[[Placed], Placed]) -> Placements:
        """The instances with what a function makes of them, which is the same at all places."""
        # a part of several kinds of instances has the prototypes of all
        each = zip(self.prototypes, self._are_present.tolist(), strict=True)
        changed = tuple(change(one) if is_present else one for one, is_present in each)
        if all(one is before for one, before in zip(changed, self.prototypes, strict=True)):
            return self
        return Placements(changed, self.are_copied, self.of, self.matrices)

    @property
    def first_ones(self) -> np.ndarray:
        """(n,) int, the first row of the same instance: its own, unless an object is there several times."""
        rows = np.arange(len(self))
        first = np.full(len(self.prototypes), len(self))
        np.minimum.at(first, self.of, rows)
        return np.where(self.are_copied[self.of], rows, first[self.of])

    @property
    def different(self) -> tuple[Placed, ...]:
        """The prototypes that any of them has."""
        return tuple(self.prototypes[row] for row in np.flatnonzero(self._are_present).tolist())

    @property
    def _are_present(self) -> np.ndarray:
        """(p,) bool, whether any of them has each prototype."""
        return np.bincount(self.of, minlength=len(self.prototypes)) > 0


def placed_at(placed: Sequence[Placed], matrices: np.ndarray, of: np.ndarray | None = None) -> Placements:
    """Copies of instances at n other places, which are checked together and not one by one.

    placed: the same object for instances that differ in their places only. of: (n,) which of them each place is for;
    None: there is one for each. matrices: (n, 4, 4) `matrix_world` of each,
    affine: the last row of each stays what it always is.
    Raises ValueError with a sentence for numbers that no instance may have.
    """
    matrices = np.asarray(matrices)
    matrices = (matrices if matrices.dtype == np.float32 else matrices.astype(np.float64)).reshape(-1, 4, 4)
    are_usable = ((matrices <= MAX_LENGTH) & (matrices >= -MAX_LENGTH)).all(axis=(1, 2))
    for row in np.flatnonzero(~are_usable)[:1]:
        replace(placed[row if of is None else of[row]], matrix_world=matrices[row])  # raises what is wrong
    prototypes, of = _different(placed) if of is None else (placed, np.asarray(of, np.int32))
    return Placements(prototypes, np.ones(len(prototypes), bool), of, _exactly(matrices))


def placements(placed: Iterable[Placed]) -> Placements:
    """The same instances; an object that is among them several times stays one."""
    if isinstance(placed, Placements):
        return placed
    prototypes, of = _different(placed)
    matrices = np.array([one.matrix_world for one in prototypes], np.float64).reshape(-1, 4, 4)
    return Placements(prototypes, np.zeros(len(prototypes), bool), of, _exactly(matrices)[of])


def joined(*parts: Placements) -> Placements:
    """The instances of several, one after the other; those that were parts of the same are that again."""
    first, *others = [part for part in parts if len(part)] or [*parts, placements(())][:1]
    for other in others:
        first = _both(first, other)
    return first


def _both(first: Placements, second: Placements) -> Placements:
    if second.follows(first):
        whole = first._whole
        return whole[first._first : second._first + len(second)]
    first, second = first.pruned(), second.pruned()
    return Placements(
        first.prototypes + second.prototypes,
        np.concatenate([first.are_copied, second.are_copied]),
        np.concatenate([first.of, second.of + np.int32(len(first.prototypes))]),
        np.concatenate([first.matrices, second.matrices]),
    )


def _different(placed: Iterable[Placed]) -> tuple[list[Placed], np.ndarray]:
    """The different objects among some, and (n,) int32 which of them each is."""
    numbers, prototypes, of = {}, [], []
    for one in placed:
        number = numbers.setdefault(id(one), len(prototypes))
        if number == len(prototypes):
            prototypes.append(one)
        of.append(number)
    return prototypes, np.array(of, np.int32)


def _exactly(matrices: np.ndarray) -> np.ndarray:
    """(n, 3, 4) the rows of (n, 4, 4) matrices that are not constant, as float32 if it holds them exactly."""
    if matrices.dtype == np.float32:
        return np.ascontiguousarray(matrices[:, :3])
    with np.errstate(over="ignore", under="ignore"):
        single = matrices[:, :3].astype(np.float32)
    return single if np.array_equal(single, matrices[:, :3]) else np.ascontiguousarray(matrices[:, :3])


def _at(prototype: Placed, matrix: np.ndarray) -> Placed:
    """A copy at a place, which was checked with others. matrix: (3, 4)."""
    world = np.eye(4)
    world[:3] = matrix
    world.flags.writeable = False
    copied = object.__new__(type(prototype))
    own = {field.name: getattr(prototype, field.name) for field in fields(prototype)}
    copied.__dict__.update(own, matrix_world=world)
    return copied
