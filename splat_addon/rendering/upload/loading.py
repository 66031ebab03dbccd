# SPDX-License-Identifier: GPL-3.0-or-later
"""Brings large sets of surfels to the device in slices: the arrays are made in the background, and each picture writes
a few rows of their textures, so that none waits long."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import Future
from dataclasses import dataclass
from functools import partial
from time import perf_counter
from typing import NamedTuple
from weakref import WeakSet, ref

import numpy as np

from ...hierarchy import Hierarchy
from ...surfels import Surfels
from ..background import in_background
from ..device import Device
from ..device.interface import Pipeline, PipelineDescription, Texture

#: Surfels that one picture may prepare at once, so that small sets are there in the first one.
AT_ONCE = 1 << 17
#: Bytes of texels that one picture may write, and of each slice.
MOST_BYTES = 1 << 25
SLICE_BYTES = 1 << 22
#: Seconds after which a picture writes no further slice.
_SECONDS = 0.05


class NotYet(Exception):
    """Some surfels are still on their way to the device. surfels: which."""

    def __init__(self, surfels: Iterable[Surfels]):
        super().__init__("Surfels are on their way to the device.")
        self.surfels = set(surfels)


class Packed(NamedTuple):
    """One kind of data of a set. texels: (h, w, channels) float32 and the format of each texture. value: what is kept,
    made of the textures."""

    texels: tuple[tuple[np.ndarray, str], ...]
    value: Callable[[list[Texture]], object]


class Made(NamedTuple):
    """What a job returns. levels, order: of the set, as `stored_order` has them."""

    levels: Hierarchy | None
    order: np.ndarray
    packed: Packed


class Arrived(NamedTuple):
    """A kind of data that is on the device. made_from: as it was requested."""

    owner: Surfels
    kind: str
    made_from: tuple
    made: Made
    textures: list[Texture]


class Withdrawn(Exception):
    """Nobody waits for a job any more."""


class JobShare:
    """What a job has done, told by its thread. It refers to nothing, because the thread may be the last to free it."""

    def __init__(self):
        self.share, self.is_withdrawn = 0.0, False

    def __call__(self, share: float) -> None:
        if self.is_withdrawn:
            raise Withdrawn
        self.share = share


@dataclass(eq=False)
class _Task:
    made_from: tuple
    count: int
    future: Future
    done: JobShare
    textures: list[Texture]
    slices: Iterator[int] | None = None
    written: int = 0

    @property
    def left(self) -> float:
        """The part of its surfels that have not arrived; half of the way is making what is then written."""
        if not self.written:
            return self.count * (1 - self.done.share / 2)
        total = sum(texels.nbytes for texels, _ in self.future.result().packed.texels)
        return self.count * (1 - self.written / total) / 2

    def withdraw(self) -> None:
        """End the job, at its next step if it has begun."""
        self.done.is_withdrawn = True
        self.future.cancel()


class Loading:
    """What is on its way to a device.

    run: starts a job in the background. bytes_written: by the last picture. is_in_background: whether large sets are
    made there; otherwise pictures wait for them. exempt: sets that are made at once in any case. compiles_in_slices:
    whether a picture pauses where compiling programs has taken its time. pauses: whether it is to pause now; who goes
    on with it sets this to False.
    """

    def __init__(self, device: Device, run=in_background, clock: Callable[[], float] = perf_counter):
        self._device, self._run, self._clock = device, run, clock
        self._tasks: dict[tuple[ref, str], _Task] = {}
        self._at_once, self._total = AT_ONCE, 0
        self.exempt: WeakSet[Surfels] = WeakSet()
        self.bytes_written = 0
        self.is_in_background = self.compiles_in_slices = True
        self._programs: set[PipelineDescription] = set()
        self._compiled_until, self.pauses = 0.0, False

    def __del__(self):
        self.clear()

    def admits(self, surfels: Surfels) -> bool:
        """Whether a set is prepared at once; it then counts to this picture's share."""
        if surfels in self.exempt or not self.is_in_background:
            return True
        if len(surfels) > self._at_once or self.is_loading(surfels):
            return False
        self._at_once -= len(surfels)
        return True

    def program(self, description: PipelineDescription) -> Pipeline:
        """The device's pipeline. If it is new and the time of this picture is over, the picture is to pause."""
        program = self._device.pipeline(description)
        if self.compiles_in_slices and description not in self._programs:
            self._programs.add(description)
            self.pauses |= self._clock() > self._compiled_until
        return program

    def request(self, owner: Surfels, kind: str, made_from: tuple, job: Callable[[JobShare], Made]) -> None:
        """Start a job, which must not refer to the owner itself: the thread would free it, and its textures. It calls
        its argument with what it has done, as a share."""
        key = ref(owner), kind
        if key not in self._tasks:
            self._total += len(owner)
            done = JobShare()
            self._tasks[key] = _Task(made_from, len(owner), self._run(partial(job, done)), done, [])

    def is_loading(self, surfels: Surfels) -> bool:
        return any(owner() is surfels for owner, _ in self._tasks)

    @property
    def left(self) -> tuple[float, int]:
        """Surfels that have not arrived and that somebody still has, and all that were requested since nothing was on
        its way."""
        return sum(task.left for (owner, _), task in self._tasks.items() if owner() is not None), self._total

    @property
    def has_news(self) -> bool:
        """Whether the next picture has something to write."""
        return any(task.future.done() and not task.future.cancelled() for task in self._tasks.values())

    def advance(self) -> Iterator[Arrived]:
        """Write this picture's share, in the order of the requests; yields what is complete."""
        until, self.bytes_written, self._at_once = self._clock() + _SECONDS, 0, AT_ONCE
        self._compiled_until = until
        try:
            for key, task in list(self._tasks.items()):
                owner = key[0]()
                if owner is None:
                    task.withdraw()
                    del self._tasks[key]
                elif task.future.done() and not task.future.cancelled():
                    if not self._write(task, until):
                        return
                    del self._tasks[key]
                    yield Arrived(owner, key[1], task.made_from, task.future.result(), task.textures)
        finally:
            self._total = self._total if self._tasks else 0
            self._device.restore()

    def _write(self, task: _Task, until: float) -> bool:
        """Write slices of a task; whether it is complete."""
        task.slices = task.slices or self._slices(task)
        try:
            while self.bytes_written + SLICE_BYTES <= MOST_BYTES and self._clock() < until:
                if (written := next(task.slices, None)) is None:
                    return True
                self.bytes_written += written
                task.written += written
        except Exception:
            # the next picture tries again, and fails again unless the reason is gone
            task.slices = None
            raise
        return False

    def _slices(self, task: _Task) -> Iterator[int]:
        """Write the textures of a task; yields the bytes of each slice."""
        task.textures, task.written = [], 0
        for texels, format in task.future.result().packed.texels:
            height, width = texels.shape[:2]
            texture = self._device.texture((width, height), format)
            rows = max(SLICE_BYTES // texels[:1].nbytes, 1)
            for first in range(0, height, rows):
                part = texels[first : first + rows]
                self._device.write(texture, first, part)
                yield part.nbytes
            task.textures.append(texture)

    def clear(self) -> None:
        for task in self._tasks.values():
            task.withdraw()
        self._tasks.clear()
        self._total = 0
