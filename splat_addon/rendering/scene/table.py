# SPDX-License-Identifier: GPL-3.0-or-later
"""The instances of a scene as arrays, so that thousands of them are looked at together.

Instances are of one *kind* if they differ only in where they are, what they are called, which lights light them and
where they are split. What does not depend on that is decided once for each kind.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field, fields
from functools import cached_property
from types import FunctionType
from typing import TYPE_CHECKING, NamedTuple, TypeVar

import numpy as np

from ...surfels import Surfels

Found = TypeVar("Found")

if TYPE_CHECKING:
    from .camera import Camera
    from .placed import Placed

#: A matrix whose shortest axis is below this share of its longest leaves no direction for a normal.
FLATTEST = 1e-12

#: (8, 3) for each corner of a box, whether it is at the high end of each axis.
CORNERS = np.array([[k & 1, k >> 1 & 1, k >> 2 & 1] for k in range(8)], bool)

#: Views of a table that are kept: of the camera, of lights, and of the faces of a panorama.
_VIEWS = 16

#: Instances whose boxes are compared with those of others at once.
_AT_ONCE = 256

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


class FromEye(NamedTuple):
    """What a camera of some place sees of n instances, whichever window it looks through.

    model_views: (n, 4, 4) float64, positions (without origin) to view space. normal_matrices: (n, 3, 3) their inverse
    transposes up to a positive factor; NaN for a flattened instance. orientations: (n,) -1 for mirrored ones. corners:
    (n, 8, 3) of boxes around them.
    """

    model_views: np.ndarray
    normal_matrices: np.ndarray
    orientations: np.ndarray
    corners: np.ndarray

    def taken(self, rows: np.ndarray) -> FromEye:
        *others, corners = self
        return FromEye(*(array[rows] for array in others), corner_by_corner(corners, rows))


def corner_by_corner(corners: np.ndarray, rows: np.ndarray | None = None) -> np.ndarray:
    """(n, 8, 3) the same corners, or those of some boxes, with the first corner of all of them first in memory: over
    eight numbers that lie apart, numpy's minima and maxima take a hundredth of the time. rows: numbers, or (n,) bool.
    """
    each = corners.transpose(1, 0, 2)
    if rows is not None:
        each = np.take(each, np.flatnonzero(rows) if rows.dtype == bool else rows, axis=1)
    return np.ascontiguousarray(each).transpose(1, 0, 2)


def corners_times(corners: np.ndarray, matrix: np.ndarray) -> np.ndarray:
    """(n, 8, k) the product of each of (n, 8, 3) corners with a (3, k) matrix, laid out as by `corner_by_corner`."""
    each = np.ascontiguousarray(corners.transpose(1, 0, 2))
    return (each.reshape(-1, 3) @ matrix).reshape(8, len(corners), matrix.shape[1]).transpose(1, 0, 2)


@dataclass(frozen=True, eq=False)
class InstanceTable:
    """Instances that have anything to show.

    placed: of length n. numbers: (n,) their rows in the table of the whole scene. kind_of: (n,) rows of `every_kind`.
    shape_of: (n,) rows of `shapes`. matrices: (n, 4, 4) float64, object to world. light_sets: (n,). splits: (n, 2)
    `split_distance` and `split_length`, NaN for none. slots: (n, 2) the number of the first material slot, and how many
    more there are; 0 for holdouts. origins, low, high: (s, 3) of each shape, the last two relative to the first.
    sizes: (s, 3) of each shape: how many surfels or corners it has, and how far these extend at most, without large
    surfels in the last column; 0 for polygons. known: what was found of every kind, and of every shape.
    """

    placed: Sequence[Placed]
    numbers: np.ndarray
    kind_of: np.ndarray
    every_kind: tuple[Placed, ...]
    shape_of: np.ndarray
    shapes: tuple
    matrices: np.ndarray
    light_sets: np.ndarray
    splits: np.ndarray
    slots: np.ndarray
    origins: np.ndarray
    low: np.ndarray
    high: np.ndarray
    sizes: np.ndarray
    known: dict = field(default_factory=dict)

    def __len__(self) -> int:
        return len(self.numbers)

    def taken(self, rows: np.ndarray) -> InstanceTable:
        """Some of the instances. rows: (m,) numbers or (n,) bool."""
        if rows.dtype == bool:
            if rows.all():
                return self
            rows = np.flatnonzero(rows)
        placed, each = self.placed, (getattr(self, name)[rows] for name in _OF_INSTANCES)
        own = dict(zip(_OF_INSTANCES, each, strict=True))
        shared = {f.name: getattr(self, f.name) for f in fields(self) if f.name not in (*own, "placed")}
        made = InstanceTable(placed=_Taken(placed, rows), **own, **shared)
        # what was found of them is not found again
        made.__dict__.update({name: self.__dict__[name][rows] for name in _FOUND if name in self.__dict__})
        if "world_corners" in self.__dict__:
            made.__dict__["world_corners"] = corner_by_corner(self.world_corners, rows)
        return made

    @cached_property
    def kinds(self) -> Kinds:
        """Those that are there, in the order of their first instances."""
        found, first, counts = np.unique(self.kind_of, return_index=True, return_counts=True)
        order = np.argsort(first)
        return Kinds(Kind(self.every_kind[found[k]], int(counts[k])) for k in order.tolist())

    def of_kinds(self, which: Callable[[Placed], bool]) -> np.ndarray:
        """(n,) bool: whether the instances are of a kind for which this holds."""
        if depends_on_nothing_else(which):
            if which.__code__ not in self.known:
                self.known[which.__code__] = np.array([bool(which(one)) for one in self.every_kind], bool)
            return self.known[which.__code__][self.kind_of]
        chosen = np.zeros(len(self.every_kind), bool)
        for kind in self._present:
            chosen[kind] = which(self.every_kind[kind])
        return chosen[self.kind_of]

    @cached_property
    def _present(self) -> list[int]:
        return np.flatnonzero(np.bincount(self.kind_of)).tolist()

    @cached_property
    def counts(self) -> np.ndarray:
        """(n,) int: surfels, or corners of polygons."""
        return self.sizes[self.shape_of, 0].astype(np.int64)

    @cached_property
    def triangles(self) -> np.ndarray:
        """(n,) int: triangles that are drawn of each, one for a surfel."""
        if "corners" not in self.known:
            self.known["corners"] = np.array([1 if isinstance(shape, Surfels) else 3 for shape in self.shapes], int)
        return self.counts // self.known["corners"][self.shape_of]

    @cached_property
    def radii(self) -> np.ndarray:
        """(n,) how far anything may extend beyond the shape's positions, in world units."""
        return self.sizes[self.shape_of, 1] * self.stretches[:, 0]

    @cached_property
    def grains(self) -> np.ndarray:
        """(n,) the same without large surfels, which count as the samples that they replace."""
        return self.sizes[self.shape_of, 2] * self.stretches[:, 0]

    @cached_property
    def stretches(self) -> np.ndarray:
        """(n, 3) as `Placed.stretches`."""
        return np.linalg.svd(self.matrices[:, :3, :3], compute_uv=False)

    @cached_property
    def are_flattened(self) -> np.ndarray:
        """(n,) bool: whether their matrices leave no direction for a normal."""
        return ~(self.stretches[:, 2] > FLATTEST * self.stretches[:, 0])

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

    @cached_property
    def local_corners(self) -> np.ndarray:
        """(n, 8, 3) corners of boxes around them, in the space of each, relative to its origin."""
        return np.where(CORNERS, self.high[:, None], self.low[:, None])[self.shape_of]

    @cached_property
    def world_corners(self) -> np.ndarray:
        """(n, 8, 3) float64 corners of boxes around them, in world space."""
        corners = self.local_corners + self.origins[self.shape_of][:, None]
        return corner_by_corner(corners @ self.matrices[:, :3, :3].transpose(0, 2, 1) + self.matrices[:, None, :3, 3])

    @cached_property
    def _seen(self) -> dict[bytes, FromEye]:
        return {}

    def from_eye(self, camera: Camera) -> FromEye:
        """What cameras at this place see; kept for the last few of them."""
        key = camera.matrix_world.tobytes()
        if key not in self._seen:
            while len(self._seen) >= _VIEWS:
                del self._seen[next(iter(self._seen))]
            self._seen[key] = self._from_eye(camera)
        return self._seen[key]

    def _from_eye(self, camera: Camera) -> FromEye:
        """The camera is subtracted from the origin first, so that both may be far from the world origin."""
        rotation, linear = camera.matrix_world[:3, :3].T, self.matrices[:, :3, :3]
        origin = (linear @ self.origins[self.shape_of][..., None])[..., 0]
        away = self.matrices[:, :3, 3] - camera.matrix_world[:3, 3] + origin
        matrices = np.tile(np.eye(4), (len(self), 1, 1))
        matrices[:, :3, :3] = rotation @ linear
        matrices[:, :3, 3] = (rotation @ away[..., None])[..., 0]
        inverse = np.full((len(self), 3, 3), np.nan)
        inverse[~self.are_flattened] = np.linalg.inv(matrices[~self.are_flattened, :3, :3])
        normal_matrices = inverse.transpose(0, 2, 1)
        normal_matrices = normal_matrices / np.abs(normal_matrices).max(axis=(1, 2), initial=0.0)[:, None, None]
        corners = self.local_corners @ matrices[:, :3, :3].transpose(0, 2, 1) + matrices[:, None, :3, 3]
        orientations = np.sign(np.linalg.det(np.nan_to_num(normal_matrices)))
        return FromEye(matrices, normal_matrices, orientations, corner_by_corner(corners))

    @cached_property
    def overlaps(self) -> np.ndarray:
        """(n,) for polygons whose box touches that of surfels, the largest grain of these surfels, in world units; 0
        for others."""
        found = np.zeros(len(self))
        are_surfels = self.of_kinds(lambda placed: isinstance(placed.shape, Surfels))
        splats, polygons = np.flatnonzero(are_surfels), np.flatnonzero(~are_surfels)
        low, high = self.world_corners.min(axis=1), self.world_corners.max(axis=1)
        # from left to right, so that few of them may touch
        polygons = polygons[np.argsort(low[polygons, 0], kind="stable")]
        for start in range(0, len(polygons) if len(splats) else 0, _AT_ONCE):
            own = polygons[start : start + _AT_ONCE]
            others = splats[_touch(low[splats], high[splats], low[own].min(axis=0), high[own].max(axis=0))]
            are_touching = _touch(low[others], high[others], low[own][:, None], high[own][:, None])
            found[own] = np.where(are_touching, self.grains[others], 0.0).max(axis=1, initial=0.0)
        return found


def _touch(low: np.ndarray, high: np.ndarray, other_low: np.ndarray, other_high: np.ndarray) -> np.ndarray:
    """Whether boxes touch others."""
    return ((low <= other_high) & (other_low <= high)).all(axis=-1)


#: Fields with one value for each instance, besides `placed`; and what is found of each when it is asked for.
_OF_INSTANCES = ("numbers", "kind_of", "shape_of", "matrices", "light_sets", "splits", "slots")
_FOUND = ("counts", "stretches", "radii", "grains", "are_flattened")


class _Taken(Sequence):
    """Some of the instances, which are only looked up when they are asked for."""

    def __init__(self, placed: Sequence[Placed], rows: np.ndarray):
        self._placed, self._rows = placed, rows

    def __len__(self) -> int:
        return len(self._rows)

    def __getitem__(self, at: int) -> Placed:
        return self._placed[self._rows[at]]


def make_table(placed: Iterable[Placed]) -> InstanceTable:
    """The table of instances, of which those are left out that have nothing to show."""
    every = tuple(placed)
    first, of = _alike(one if one.copied_from is None else one.copied_from for one in every)
    some = [every[row] for row in first.tolist()]
    are_there = np.array([len(one.shape) > 0 for one in some], bool)
    numbers = np.flatnonzero(are_there[of])
    slots, of = _slots(every, some, of)[numbers], (np.cumsum(are_there) - 1)[of[numbers]]
    some = [one for one in some if len(one.shape)]
    placed = tuple(every[number] for number in numbers.tolist())
    kinds, kind_of = _numbered(map(_kind_key(), some))
    shapes, shape_of = _numbered(id(one.shape) for one in some)
    every_shape = tuple(some[row].shape for row in shapes)
    bounds = [shape.local_bounds for shape in every_shape]
    nothing = float("nan")
    splits = [(one.split_distance or nothing, one.split_length or nothing) for one in some]
    return InstanceTable(
        placed=placed,
        numbers=np.arange(len(placed)),
        kind_of=kind_of[of],
        every_kind=tuple(some[row] for row in kinds),
        shape_of=shape_of[of],
        shapes=every_shape,
        matrices=np.array([one.matrix_world for one in placed], np.float64).reshape(-1, 4, 4),
        light_sets=np.array([one.light_set for one in some], int)[of],
        splits=np.array(splits, np.float64).reshape(-1, 2)[of],
        slots=slots,
        origins=np.array([shape.origin for shape in every_shape], np.float64).reshape(-1, 3),
        low=np.array([low for low, _ in bounds]).reshape(-1, 3),
        high=np.array([high for _, high in bounds]).reshape(-1, 3),
        sizes=np.array([_sizes(shape) for shape in every_shape], np.float64).reshape(-1, 3),
    )


def with_others(table: InstanceTable, rows: np.ndarray, made: list[Placed], is_kept: np.ndarray) -> InstanceTable:
    """A table with more instances, each with the number of one that is there already, and without some of those. rows:
    (m,) of these. is_kept: (n,) bool."""
    if not made:
        return table.taken(is_kept)
    more, kept = make_table(made), table.taken(is_kept)
    numbers = np.concatenate([kept.numbers, table.numbers[rows]])
    order = np.argsort(numbers, kind="stable")
    own = {
        "placed": [*kept.placed, *more.placed],
        "numbers": numbers,
        "kind_of": np.concatenate([kept.kind_of, more.kind_of + len(table.every_kind)]),
        "shape_of": np.concatenate([kept.shape_of, more.shape_of + len(table.shapes)]),
        "slots": np.concatenate([kept.slots, table.slots[rows]]),
        **{n: np.concatenate([getattr(kept, n), getattr(more, n)]) for n in ("matrices", "light_sets", "splits")},
    }
    own = {n: [v[k] for k in order.tolist()] if n == "placed" else v[order] for n, v in own.items()}
    shared = {n: np.concatenate([getattr(table, n), getattr(more, n)]) for n in ("origins", "low", "high", "sizes")}
    every = {"every_kind": table.every_kind + more.every_kind, "shapes": table.shapes + more.shapes}
    return InstanceTable(**own, **shared, **every)


def _sizes(shape) -> tuple[float, float, float]:
    if isinstance(shape, Surfels):
        return len(shape), shape.largest, shape.largest_grain
    return len(shape), 0.0, 0.0


def _kind_key() -> Callable[[Placed], tuple]:
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


def _numbered(keys: Iterable) -> tuple[list[int], np.ndarray]:
    """The place of the first of each key, and (n,) the number of each."""
    numbers, first, of = {}, [], []
    for place, key in enumerate(keys):
        number = numbers.setdefault(key, len(first))
        if number == len(first):
            first.append(place)
        of.append(number)
    return first, np.array(of, np.int64)


def _alike(of: Iterable) -> tuple[np.ndarray, np.ndarray]:
    """`_numbered` of which object each is, for thousands that are few different ones."""
    _, first, number = np.unique(np.array([id(one) for one in of], np.int64), return_index=True, return_inverse=True)
    order = np.argsort(first)
    return first[order], np.argsort(order)[number]


def _slots(every: tuple[Placed, ...], some: list[Placed], of: np.ndarray) -> np.ndarray:
    """(n, 2) as in `InstanceTable`; 0 means nothing. An instance that is there twice has the same numbers.

    some, of: one of those that differ in their places only, and (n,) which of these each is like.
    """
    first, number = _alike(every)
    counts = np.array([len(one.materials) for one in some], int)[of[first]]
    starts = 1 + np.cumsum(counts) - counts
    own = np.stack([starts, counts - 1], axis=1)[number]
    own[np.array([one.is_holdout for one in some], bool)[of]] = 0
    return own
