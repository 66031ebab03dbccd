# SPDX-License-Identifier: GPL-3.0-or-later
"""What the samples of a picture have in common that see the same instances from the same place: their cameras differ by
less than a pixel, so that the same calls draw them, with other values in the uniform blocks of the view and frame."""

from __future__ import annotations

from collections.abc import Callable, Hashable
from functools import partial
from typing import NamedTuple, TypeVar

import numpy as np

from ..device.interface import Target
from .graph import Pass
from .uniforms import Block

Made = TypeVar("Made")


class Calls(NamedTuple):
    """What a pass called on the device, and the target that it returned. number: of the pass in its picture."""

    number: int
    p: Pass
    calls: list[Callable[[], None]]
    target: Target


class Repeats:
    """records: whether the calls of passes are kept for the next sample, which needs results that nothing reads while
    passes run.

    passes: the calls of all passes in order, once a sample is complete. They draw the next one if nothing else was
        drawn with the same resources since. found: what was found of the view. blocks: the
        arrays of uniform blocks that change from sample to sample, in place; by how far the picture is moved up.
    """

    def __init__(self, records: bool = False):
        self.records = records
        self.passes: tuple[Calls, ...] = ()
        self.blocks: dict[tuple[float, Block], np.ndarray] = {}
        self._found: dict[Hashable, object] = {}
        self.restart()

    def restart(self) -> None:
        """Forget the calls of all passes."""
        self.passes, self._recorded, self._now = (), [], None

    def found(self, key: Hashable, make: Callable[[], Made]) -> Made:
        """What was made for a key."""
        if key not in self._found:
            self._found[key] = make()
        return self._found[key]

    def call(self, call: Callable, *arguments, lasts: bool = False) -> None:
        """Call something on the device. lasts: its effect is still there for the next sample."""
        call(*arguments)
        if self._now is not None and not lasts:
            self._now.append(partial(call, *arguments))

    def begin(self) -> None:
        """Keep what is called from now on."""
        self._now = [] if self.records else None

    def end(self, number: int, p: Pass, target: Target) -> None:
        """A pass is complete."""
        if self._now is not None:
            self._recorded.append(Calls(number, p, self._now, target))
            self._now = None

    def complete(self) -> None:
        """A sample is complete."""
        if self.records:
            self.passes = tuple(self._recorded)

    def give_up(self) -> None:
        """Keep no calls: what a pass draws depends on what it has drawn."""
        self.records = False
        self.restart()
