# SPDX-License-Identifier: GPL-3.0-or-later
"""The instances of a scene as arrays, so that thousands of them are looked at together.

Of each there is a row of numbers and its matrix; the rest is found when something needs it, of those instances alone.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from functools import cached_property

import numpy as np

from ...surfels import Surfels
from .boxes import box_of
from .camera import Camera
from .from_eye import FromEye
from .kinds import Kind, Kinds
from .numbers import FLATTEST
from .placed import Placed
from .placements import Placements, joined, placements
from .prototypes import Prototypes

#: Instances that are looked at together where more would need much memory.
AT_ONCE = 1 << 13

#: Instances whose boxes are compared with those of others at once.
_TOUCHING_AT_ONCE = 256


class InstanceTable:
    """n instances that have anything to show.

    every: those of the scene, and others. rows: (n,) which of them these are. numbers: (n,) their rows in the table of
    the whole scene. of: (n,) their rows in `prototypes`. All are int32.
    """

    def __init__(
        self, every: Placements, rows: np.ndarray, numbers: np.ndarray, of: np.ndarray, prototypes: Prototypes,
        slots: Slots,
    ):  # fmt: skip
        self.every, self.rows, self.numbers, self.of, self.prototypes = every, rows, numbers, of, prototypes
        self._slots = slots

    def __len__(self) -> int:
        return len(self.rows)

    def taken(self, rows: np.ndarray) -> InstanceTable:
        """Some of the instances. rows: (m,) numbers or (n,) bool."""
        if rows.dtype == bool:
            if rows.all():
                return self
            rows = np.flatnonzero(rows)
        own = self.rows[rows]
        numbers = own if self.numbers is self.rows else self.numbers[rows]
        made = InstanceTable(self.every, own, numbers, self.of[rows], self.prototypes, self._slots)
        # what was found of them is not found again
        made.__dict__.update({name: self.__dict__[name][rows] for name in _FOUND if name in self.__dict__})
        return made

    @property
    def placed(self) -> Sequence[Placed]:
        """The instances, which are only made when they are asked for."""
        return _Taken(self.every, self.rows)

    @property
    def every_kind(self) -> tuple[Placed, ...]:
        return self.prototypes.every_kind

    @property
    def shapes(self) -> tuple:
        return self.prototypes.shapes

    @property
    def kind_of(self) -> np.ndarray:
        """(n,) rows of `every_kind`."""
        return self.prototypes.kinds[self.of]

    @property
    def shape_of(self) -> np.ndarray:
        """(n,) rows of `shapes`."""
        return self.prototypes.shape_of[self.of]

    @property
    def light_sets(self) -> np.ndarray:
        """(n,) as of `Placed`."""
        return self.prototypes.light_sets[self.of]

    @property
    def splits(self) -> np.ndarray:
        """(n, 2) `split_distance` and `split_length`, NaN for none."""
        return self.prototypes.splits[self.of]

    @property
    def slots(self) -> np.ndarray:
        """(n, 2) the number of the first material slot, and how many more there are; 0 for holdouts."""
        more = self.prototypes.materials[self.of] - 1
        return np.stack([self._slots.first[self.numbers], more], axis=1) * ~self.prototypes.are_holdouts[self.of, None]

    @property
    def matrices(self) -> np.ndarray:
        """(n, 3, 4) float64, object to world; a new array."""
        return self.every.matrices[self.rows].astype(np.float64)

    @property
    def told(self) -> tuple[np.ndarray, ...]:
        """Arrays that are equal for instances of the same kinds at the same places."""
        return self.every.matrices[self.rows], self.splits, self.slots, self.kind_of

    @property
    def columns(self) -> np.ndarray:
        """(4, 3, n) float64, the images of the three axes and of the origin; a new array."""
        return np.ascontiguousarray(self.every.matrices[self.rows].transpose(2, 1, 0), np.float64)

    @cached_property
    def kinds(self) -> Kinds:
        """Those that are there, in the order of their first instances."""
        kind_of = self.kind_of
        counts, ordered = np.bincount(kind_of), kind_of[self.first_of_kinds].tolist()
        return Kinds(Kind(self.every_kind[kind], int(counts[kind])) for kind in ordered)

    @property
    def first_of_kinds(self) -> np.ndarray:
        """(k,) the rows of the first instance of each kind, in increasing order."""
        kind_of, first = self.kind_of, np.full(len(self.every_kind), len(self))
        first[kind_of[::-1]] = np.arange(len(self))[::-1]
        return np.sort(first[first < len(self)])

    def of_kinds(self, which: Callable[[Placed], bool]) -> np.ndarray:
        """(n,) bool: whether the instances are of a kind for which this holds."""
        return self.prototypes.holds(which, lambda: self._present)[self.of]

    @cached_property
    def _present(self) -> list[int]:
        return np.flatnonzero(np.bincount(self.kind_of)).tolist()

    @property
    def counts(self) -> np.ndarray:
        """(n,) int: surfels, or corners of polygons."""
        return self.prototypes.sizes[:, 0].astype(np.int64)[self.shape_of]

    @property
    def triangles(self) -> np.ndarray:
        """(n,) int: triangles that are drawn of each, one for a surfel."""
        return self.prototypes.triangles[self.shape_of]

    @property
    def radii(self) -> np.ndarray:
        """(n,) how far anything may extend beyond the shape's positions, in world units."""
        return self.prototypes.sizes[self.shape_of, 1] * self.stretches

    @property
    def grains(self) -> np.ndarray:
        """(n,) the same without large surfels, which count as the samples that they replace."""
        return self.prototypes.sizes[self.shape_of, 2] * self.stretches

    @cached_property
    def stretches(self) -> np.ndarray:
        """(n,) float64, the largest factor by which the matrix of each lengthens."""
        return self._singular_values[0]

    @cached_property
    def are_flattened(self) -> np.ndarray:
        """(n,) bool: whether their matrices leave no direction for a normal."""
        return self._singular_values[1]

    @property
    def _singular_values(self) -> tuple[np.ndarray, np.ndarray]:
        largest, are_flat = np.empty(len(self)), np.empty(len(self), bool)
        for start in range(0, len(self), AT_ONCE):
            some = slice(start, start + AT_ONCE)
            linear = self.every.matrices[self.rows[some], :, :3].astype(np.float64)
            found = np.linalg.svd(linear, compute_uv=False)
            largest[some], are_flat[some] = found[:, 0], ~(found[:, 2] > FLATTEST * found[:, 0])
        self.__dict__.update(stretches=largest, are_flattened=are_flat)
        return largest, are_flat

    @cached_property
    def firm(self) -> InstanceTable:
        """Those that are not flattened."""
        return self.taken(~self.are_flattened)

    @cached_property
    def seen(self) -> InstanceTable:
        """Those that pictures show."""
        return self.taken(self.of_kinds(lambda placed: placed.is_seen))

    @cached_property
    def casting(self) -> InstanceTable:
        """Those that cast shadows and are not flattened."""
        return self.firm.taken(self.firm.of_kinds(lambda placed: placed.casts_shadow))

    @cached_property
    def reaching(self) -> np.ndarray:
        """(k,) rows of pieces of far-reaching triangles."""
        return np.flatnonzero(self.of_kinds(lambda placed: placed.reaches))

    def along(self, axes: np.ndarray, of_shapes: np.ndarray) -> np.ndarray:
        """(3, 3, n) vectors of the shapes, each in three parts, in another space. axes: (3, 3, n) images of the axes in
        that. of_shapes: (s, 3)."""
        return axes * np.take(of_shapes.T, self.shape_of, axis=1)[:, None]

    @property
    def world_corners(self) -> np.ndarray:
        """(n, 8, 3) float64 corners of boxes around them, in world space; a new array."""
        columns, shapes = self.columns, self.prototypes
        axes = columns[:3]
        low = columns[3] + self.along(axes, shapes.low + shapes.origins).sum(axis=0)
        return box_of(low, self.along(axes, shapes.high - shapes.low))

    def parts(self) -> Iterator[InstanceTable]:
        """The instances in runs of which each can be looked at together; at least one."""
        if len(self) <= AT_ONCE:
            yield self
            return
        for start in range(0, len(self), AT_ONCE):
            yield self.taken(np.arange(start, min(start + AT_ONCE, len(self))))

    def from_eye(self, camera: Camera) -> FromEye:
        """What a camera at this place sees."""
        return FromEye(self, camera)

    @cached_property
    def overlaps(self) -> np.ndarray:
        """(n,) for polygons whose box touches that of surfels, the largest grain of these surfels, in world units; 0
        for others."""
        are_surfels = self.of_kinds(lambda placed: isinstance(placed.shape, Surfels))
        splats, polygons = np.flatnonzero(are_surfels), np.flatnonzero(~are_surfels)
        if not (len(splats) and len(polygons)):
            return np.broadcast_to(0.0, len(self))
        found, corners = np.zeros(len(self)), self.world_corners
        low, high, grains = corners.min(axis=1), corners.max(axis=1), self.grains
        # from left to right, so that few of them may touch
        polygons = polygons[np.argsort(low[polygons, 0], kind="stable")]
        for start in range(0, len(polygons), _TOUCHING_AT_ONCE):
            own = polygons[start : start + _TOUCHING_AT_ONCE]
            others = splats[_touch(low[splats], high[splats], low[own].min(axis=0), high[own].max(axis=0))]
            are_touching = _touch(low[others], high[others], low[own][:, None], high[own][:, None])
            found[own] = np.where(are_touching, grains[others], 0.0).max(axis=1, initial=0.0)
        return found


def _touch(low: np.ndarray, high: np.ndarray, other_low: np.ndarray, other_high: np.ndarray) -> np.ndarray:
    """Whether boxes touch others."""
    return ((low <= other_high) & (other_low <= high)).all(axis=-1)


#: What is found of each when it is asked for.
_FOUND = ("stretches", "are_flattened")


class _Taken(Sequence):
    """Some of the instances, which are only looked up when they are asked for."""

    def __init__(self, every: Sequence[Placed], rows: np.ndarray):
        self._every, self._rows = every, rows

    def __len__(self) -> int:
        return len(self._rows)

    def __getitem__(self, at: int) -> Placed:
        return self._every[self._rows[at]]


class Slots:
    """The numbers of material slots of all instances of a scene."""

    def __init__(self, every: Placements, rows: np.ndarray):
        self._every, self._rows = every, rows

    @cached_property
    def first(self) -> np.ndarray:
        """(n,) int32 the number of the first slot of each; 0 means nothing. An instance that is there twice has the
        same ones."""
        every = self._every
        counts = np.array([len(one.materials) for one in every.prototypes], np.int32)[every.of]
        first = every.first_ones
        counts[first != np.arange(len(first))] = 0
        starts = 1 + np.cumsum(counts, dtype=np.int32) - counts
        return starts[first][self._rows]


def make_table(*parts: Placements) -> InstanceTable:
    """The table of instances, of which those are left out that have nothing to show."""
    every = joined(*parts)
    are_shown = np.array([len(one.shape) > 0 for one in every.prototypes], bool)
    rows, of = np.arange(len(every), dtype=np.int32), every.of
    if not are_shown.all():
        rows = rows[are_shown[of]]
        of = of[rows]
    present = np.bincount(of, minlength=len(are_shown)) > 0
    if not present.all():
        of = (np.cumsum(present, dtype=np.int32) - 1)[of]
    some = [one for one, is_present in zip(every.prototypes, present.tolist(), strict=True) if is_present]
    numbers = rows if len(rows) == len(every) else np.arange(len(rows), dtype=np.int32)
    return InstanceTable(every, rows, numbers, of, Prototypes.of(some), Slots(every, rows))


def with_others(table: InstanceTable, rows: np.ndarray, made: list[Placed], is_kept: np.ndarray) -> InstanceTable:
    """A table with more instances, each with the number of one that is there already, and without some of those. rows:
    (m,) of these. is_kept: (n,) bool."""
    kept = table.taken(is_kept)
    if not made:
        return kept
    more = make_table(placements(made))
    numbers = np.concatenate([kept.numbers, table.numbers[rows]])
    order = np.argsort(numbers, kind="stable")
    every = joined(table.every, more.every)
    own = np.concatenate([kept.rows, more.rows + np.int32(len(table.every))])
    of = np.concatenate([kept.of, more.of + np.int32(len(table.prototypes.kinds))])
    prototypes = table.prototypes.with_more(more.prototypes)
    made_of = InstanceTable(every, own[order], numbers[order], of[order], prototypes, table._slots)
    if all(name in kept.__dict__ for name in _FOUND):
        found = {name: np.concatenate([getattr(kept, name), getattr(more, name)])[order] for name in _FOUND}
        made_of.__dict__.update(found)
    return made_of
