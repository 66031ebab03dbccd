# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads large meshes of surfels over several pictures of a view, so that none waits long.

A picture copies an attribute or two into arrays that a thread made room for, and which that thread then checks. Until
that is done, the view shows what the mesh was before, or some of its surfels: very few, read one by one, in the first
picture, and more of them once the attributes are there.
"""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import Future
from copy import copy
from functools import partial
from time import perf_counter
from typing import NamedTuple

import bpy
import numpy as np

from ...rendering.background import in_background
from ...rendering.detail.stand_in import LEFT_OUT, STAND_IN, spread, standing_in, widened
from ...surfels import Surfels, prepared, valid_surfels
from ..geometry.attributes import SOLID
from ..geometry.offsets import Points
from ..geometry.stored_surfels import (
    REST_FIELD,
    Stored,
    count_of,
    has_loose_points_only,
    have_same_values,
    read_field,
    read_rows,
    room_for,
    stored_fields,
    stored_of,
)
from .surfel_store import Kept, SurfelStore, tell_replaced

#: Surfels that one picture may read at once, so that small meshes are there in the first one.
AT_ONCE = 1 << 18
#: Seconds after which a picture copies no further attribute.
_SECONDS = 0.05
#: Surfels of a mesh that are read one by one, to be shown at once. They take about as long as a picture may. When its
#: time is over, there are fewer, so that there is no hole.
FIRST, FEWEST = 1 << 11, 1 << 6


class SlicedStore(SurfelStore):
    """A `SurfelStore` for a view: `get` may return what was there before, a stand-in or nothing, while it reads.

    What is hidden is kept, so that it is there at once when it is shown again; what is removed is not.

    is_sliced: whether it may; otherwise pictures wait for everything.
    """

    def __init__(self, clock: Callable[[], float] = perf_counter):
        super().__init__()
        self.is_sliced = True
        self._clock = clock
        self._readings: dict[int, _Reading] = {}
        self._requested: set[int] = set()
        self._at_once, self._until = AT_ONCE, 0.0

    @property
    def left(self) -> tuple[float, int]:
        """Points that have not been read, and those of the meshes that they belong to."""
        readings = self._readings.values()
        return sum(reading.left for reading in readings), sum(reading.count for reading in readings)

    @property
    def has_news(self) -> bool:
        """Whether reading can go on."""
        return any(reading.has_news for reading in self._readings.values())

    def begin_frame(self, changed=None, are_materials_edited=False, is_sky_edited=False, are_strokes_told=True):
        super().begin_frame(changed, are_materials_edited, is_sky_edited, are_strokes_told)
        self._at_once, self._until, self._requested = AT_ONCE, self._clock() + _SECONDS, set()
        if changed is None:
            self._readings.clear()
        self._readings = {key: r for key, r in self._readings.items() if r.name not in (changed or ())}

    def forget_unused(self):
        self._readings = {key: r for key, r in self._readings.items() if key in self._requested}
        before = {key: self._kept[key] for key in self._readings if key in self._kept}
        if unseen := self._kept.keys() - self._requested:
            data = (*bpy.data.meshes, *bpy.data.pointclouds, *bpy.data.objects)
            there = {each.name_full for each in data if each.users}
            self._current -= {key for key in unseen if self._kept[key].name not in there}
        super().forget_unused()
        self._kept |= before

    def get(self, points: Points, key: int, name: str, offset: np.ndarray, is_solid: bool = False) -> Stored:
        """The result of `SurfelStore.get`, or what is known meanwhile, which may be nothing."""
        self._requested.add(key)
        count = count_of(points)
        is_at_once = count <= self._at_once or not self.is_sliced or not has_loose_points_only(points)
        if key in self._current or is_at_once:
            self._at_once -= 0 if key in self._current else count
            self._readings.pop(key, None)
            return super().get(points, key, name, offset, is_solid)
        reading, before = self._readings.get(key), [kept for kept in self._kept.values() if kept.name == name]
        if reading is None or reading.count != count:
            known = self._followed.get(name)
            reading = self._readings[key] = _Reading(points, name, offset, is_solid, before, known)
        try:
            read = reading.advance(points, self._until, self._clock)
        except Exception:
            del self._readings[key]
            raise
        if read is None:
            return Stored(reading.meanwhile, skipped=0, strayed=0)
        del self._readings[key]
        if read.followed is not None:
            self._followed[name] = read.followed
        tell_replaced(before, read.kept)
        self._kept[key] = read.kept
        self._current.add(key)
        return super().get(points, key, name, offset, is_solid)


class _Read(NamedTuple):
    kept: Kept
    followed: tuple | None


class _Reading:
    """One mesh that is being read. before: what is kept of meshes of its name. meanwhile: the set to show."""

    def __init__(
        self,
        points: Points,
        name: str,
        offset: np.ndarray,
        is_solid: bool,
        before: list[Kept],
        followed: tuple | None,
    ):
        self.name, self.count, self._before, self._followed = name, count_of(points), before, followed
        self._origin, self._is_solid = offset, is_solid or bool(points.get(SOLID))
        self._fields = stored_fields(points, name)
        self._rooms: dict[str, Future] = {}
        self._arrays: dict[str, np.ndarray] = {}
        self._made: Future | None = None
        self.meanwhile: Surfels | None = before[0].surfels if before else None

    def __del__(self):
        for future in (*getattr(self, "_rooms", {}).values(), getattr(self, "_made", None)):
            if future is not None:
                future.cancel()

    @property
    def left(self) -> float:
        """Points of which no attribute has been read: the mean over its attributes, and half for checking them."""
        return self.count * (1 - 0.5 * len(self._arrays) / len(self._fields))

    @property
    def has_news(self) -> bool:
        if self._made is not None:
            return self._made.done()
        if not self._rooms:
            return True
        return any(room.done() for field, room in self._rooms.items() if field not in self._arrays)

    def advance(self, points: Points, until: float, clock: Callable[[], float]) -> _Read | None:
        """Go on until that time; the result when it is complete. Raises ValueError as `read_stored`."""
        if not self._rooms:
            is_late = clock() > until
            if not self._before and not (is_late and self.meanwhile):
                self.meanwhile = self._first(points, FEWEST if is_late else FIRST)
            if is_late:
                return None
            self._rooms = {f: in_background(partial(_room, of, self.count)) for f, of in self._fields.items()}
        for field, room in self._rooms.items():
            if field not in self._arrays:
                if not room.done() or clock() > until:
                    return None
                self._arrays[field] = read_field(points, self._fields[field], self.name, room.result())
        if self._made is None:
            if not self._before:
                rows = spread(self.count, STAND_IN)
                more = {field: values[rows] for field, values in self._arrays.items()}
                self.meanwhile = _few(more, self.count, self._origin, self._is_solid)
            # copies, because an object that the thread frees would free its textures there
            known = {} if self._followed is None else {self.name: _copied(self._followed)}
            before = [copy(kept.surfels) for kept in self._before]
            self._made = in_background(
                partial(_made, self._arrays, self._origin, self._is_solid, known, self.name, before)
            )
        if not self._made.done():
            return None
        stored, same, followed = self._made.result()
        kept = Kept(self.name, stored.surfels, 0, 0) if same is None else self._before[same]
        return _Read(kept._replace(skipped=stored.skipped, strayed=stored.strayed), followed)

    def _first(self, points: Points, wanted: int) -> Surfels | None:
        """The set to show before the attributes have been read."""
        rows, seen = spread(self.count, wanted), self._fields.keys() - {REST_FIELD, *LEFT_OUT}
        arrays = {field: read_rows(points, self._fields[field], self.name, rows) for field in seen}
        return _few(arrays, self.count, self._origin, self._is_solid)


def _room(layout, count: int) -> np.ndarray:
    """An array whose memory is there, so that copying into it takes no longer than that."""
    values = room_for(layout, count)
    values.fill(0)
    return values


def _few(arrays: dict[str, np.ndarray], count: int, origin: np.ndarray, is_solid: bool) -> Surfels | None:
    """The stand-in of `count` surfels, made of some that have not been checked, if any of them are usable."""
    known = {field: values for field, values in arrays.items() if field != REST_FIELD}
    surfels, _, _ = stored_of(known, is_solid, {}, "", origin)
    wide = widened(surfels.arrays(), count / max(len(surfels), 1))
    return standing_in(valid_surfels(origin, is_solid, **wide)[0]) if len(surfels) else None


def _copied(followed: tuple) -> tuple:
    read, rest, stored = followed
    return copy(read), rest, stored._replace(surfels=copy(stored.surfels))


def _made(arrays, origin: np.ndarray, is_solid: bool, known: dict, name: str, before: list[Surfels]):
    """The job: what is stored, the number of the set before that has the same values, and what `known` has of it
    now."""
    stored: Stored = stored_of(arrays, is_solid, known, name, origin)
    same = next((n for n, surfels in enumerate(before) if have_same_values(surfels, stored.surfels)), None)
    if same is None:
        prepared((stored.surfels,))
    return stored, same, known.get(name)
