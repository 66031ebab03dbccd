# SPDX-License-Identifier: GPL-3.0-or-later
"""Cuts on the device: the indices of the splats that a view draws, uploaded when the view changes."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from ..device import Device
from ..device.interface import Texture
from .parts import places_in_parts

#: Format of the texture of indices; float32 is exact up to 2^24.
NUMBERS_PER_ROW = 4096


class Cut(NamedTuple):
    """Of one part of the storage. count: splats that are drawn. clipped: number of them, at the beginning, that end at
    clip lines.

    numbers: texture of their indices in the part; None: its first `count`.
    """

    count: int
    clipped: int
    numbers: Texture | None


#: Number of cuts and lists of blocks kept that the previous frame did not use: of panorama faces, and of shadow maps
#: that samples share.
_SPARE = 24


class Cuts:
    """The cuts of the last frames, and the blocks that views were found to draw. uploads: number of uploads."""

    def __init__(self, device: Device):
        self._device = device
        self._kept: dict[object, tuple[int, Any]] = {}
        self._frame = 0
        self.uploads = 0

    def begin_frame(self) -> None:
        """Free the cuts that the previous frame did not use, except the most recent ones."""
        unused = [key for key, (frame, _) in self._kept.items() if frame != self._frame]
        for key in sorted(unused, key=lambda key: self._kept[key][0])[:-_SPARE]:
            del self._kept[key]
        self._frame += 1

    def get(
        self, key: object, numbers: Callable[[], np.ndarray | None], every: int, clipped: tuple[slice, ...]
    ) -> tuple[Cut, ...]:
        """The cut of some blocks of an object, identified by the key, in the parts of its storage.

        numbers: storage indices of what it draws; None: the first `every`. clipped: of `clipped_places`.
        """
        return self.kept(key, lambda: self._made(numbers(), every, clipped))

    def kept(self, key: object, make: Callable[[], Any]) -> Any:
        """What was made for this key, such as the blocks of a view and an object; made if it is not there."""
        known = self._kept.get(key)
        value = known[1] if known else make()
        self._kept[key] = self._frame, value
        return value

    def _made(self, numbers: np.ndarray | None, every: int, clipped: tuple[slice, ...]) -> tuple[Cut, ...]:
        if numbers is None:
            return whole_set(every, clipped[0].stop)
        is_clipped = np.logical_or.reduce([(numbers >= places.start) & (numbers < places.stop) for places in clipped])
        count = int(is_clipped.sum())
        if count:
            numbers = np.concatenate([numbers[is_clipped], numbers[~is_clipped]])
        parts = list(places_in_parts(int(numbers.max(initial=-1)) + 1))
        if len(parts) == 1:
            return (self._part(numbers, count),)
        cuts = []
        for places in parts:
            is_own = (numbers >= places.start) & (numbers < places.stop)
            cuts.append(self._part(numbers[is_own] - places.start, int(is_own[:count].sum())))
        return tuple(cuts)

    def _part(self, numbers: np.ndarray, clipped: int) -> Cut:
        """The cut of one part. clipped: how many of the numbers, the first, are of clipped ones."""
        return Cut(len(numbers), clipped, self.texture(numbers))

    def texture(self, numbers: np.ndarray) -> Texture:
        """A texture of indices."""
        rows = max(-(-len(numbers) // NUMBERS_PER_ROW), 1)
        texels = np.zeros((rows, NUMBERS_PER_ROW, 1), np.float32)
        texels.reshape(-1)[: len(numbers)] = numbers
        self.uploads += 1
        return self._device.texture((NUMBERS_PER_ROW, rows), "R32F", texels)

    def clear(self) -> None:
        self._kept.clear()


def whole_set(count: int, clipped: int) -> tuple[Cut, ...]:
    """Every one of `count` surfels, in the parts of their storage, where the first `clipped` are clipped."""
    parts = places_in_parts(count)
    return tuple(Cut(p.stop - p.start, min(max(clipped - p.start, 0), p.stop - p.start), None) for p in parts)
