# SPDX-License-Identifier: GPL-3.0-or-later
"""Cuts on the device: the indices of the splats that a view draws, uploaded when the view changes."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from ..device import Device
from ..device.interface import Texture

#: Format of the texture of indices; float32 is exact up to 2^24.
NUMBERS_PER_ROW = 4096


class Cut(NamedTuple):
    """count: splats that are drawn. clipped: number of them, at the beginning, that end at clip lines.

    numbers: texture of their indices; None: the first `count` in storage order.
    """

    count: int
    clipped: int
    numbers: Texture | None


#: Number of cuts kept that the previous frame did not use: of panorama faces, and of shadow maps that samples share.
_SPARE = 12


class Cuts:
    """The cuts of the last frames. uploads: number of uploads."""

    def __init__(self, device: Device):
        self._device = device
        self._kept: dict[object, tuple[int, Cut]] = {}
        self._frame = 0
        self.uploads = 0

    def begin_frame(self) -> None:
        """Free the cuts that the previous frame did not use, except the most recent ones."""
        unused = [key for key, (frame, _) in self._kept.items() if frame != self._frame]
        for key in sorted(unused, key=lambda key: self._kept[key][0])[:-_SPARE]:
            del self._kept[key]
        self._frame += 1

    def get(self, key: object, numbers: Callable[[], np.ndarray | None], every: int, clipped: int) -> Cut:
        """The cut of a view and an object, identified by the key.

        numbers: storage indices of what it draws; None: the first `every`. clipped: number of clipped surfels, which
            are stored first.
        """
        known = self._kept.get(key)
        cut = known[1] if known else self._made(numbers(), every, clipped)
        self._kept[key] = self._frame, cut
        return cut

    def _made(self, numbers: np.ndarray | None, every: int, clipped: int) -> Cut:
        if numbers is None:
            return Cut(every, clipped, None)
        if clipped:
            is_clipped = numbers < clipped
            numbers, clipped = np.concatenate([numbers[is_clipped], numbers[~is_clipped]]), int(is_clipped.sum())
        rows = max(-(-len(numbers) // NUMBERS_PER_ROW), 1)
        texels = np.zeros((rows, NUMBERS_PER_ROW, 1), np.float32)
        texels.reshape(-1)[: len(numbers)] = numbers
        self.uploads += 1
        return Cut(len(numbers), clipped, self._device.texture((NUMBERS_PER_ROW, rows), "R32F", texels))

    def clear(self) -> None:
        self._kept.clear()
