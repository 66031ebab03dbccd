# SPDX-License-Identifier: GPL-3.0-or-later
"""What the samples of a picture have in common that see the same instances from the same place: their cameras differ by
less than a pixel, so that the same calls draw them, with other values in the uniform blocks of the view and frame."""

from __future__ import annotations

from collections.abc import Callable, Hashable
from functools import partial
from typing import NamedTuple, TypeVar

import numpy as np

from ..device.interface import Target
from ..device.interface import Texture as DeviceTexture
from .graph import Pass
from .uniforms import Block

Made = TypeVar("Made")


class Calls(NamedTuple):
    """What a pass called on the device, and the target that it returned. lasting: the calls whose effect is still there
    for the next sample, unless something else was drawn between the two."""

    calls: list[Callable[[], None]]
    lasting: list[Callable[[], None]]
    target: Target


class Repeats:
    """records: whether the calls of passes are kept for the next sample, which needs textures that stay, and results
    that nothing reads while passes run.

    found: what was found of the view. blocks: the arrays of uniform blocks that change from sample to sample, in
        place; by their key, and as they are found of a tile.
    """

    def __init__(self, records: bool = False):
        self.records = records
        self.blocks: dict[tuple[float, Block], np.ndarray] = {}
        self._found: dict[Hashable, object] = {}
        self._calls: dict[int, tuple[Pass, Calls]] = {}
        self._textures: dict[Hashable, DeviceTexture] = {}
        self._now: tuple[list[Callable[[], None]], list[Callable[[], None]]] | None = None

    def found(self, key: Hashable, make: Callable[[], Made]) -> Made:
        """What was made for a key."""
        if key not in self._found:
            self._found[key] = make()
        return self._found[key]

    def call(self, call: Callable, *arguments, lasts: bool = False) -> None:
        """Call something on the device. lasts: before all other calls of the pass, and as `Calls.lasting`."""
        call(*arguments)
        if self._now is not None:
            self._now[lasts].append(partial(call, *arguments))

    def uses(self, key: Hashable, texture: DeviceTexture) -> DeviceTexture:
        """Note that a pass uses a texture."""
        if self._now is not None:
            self._textures[key] = texture
        return texture

    def begin(self) -> None:
        """Keep what is called from now on."""
        self._now = ([], []) if self.records else None

    def end(self, p: Pass, target: Target) -> None:
        """A pass is complete."""
        if self._now is not None:
            self._calls[id(p)] = p, Calls(*self._now, target)
            self._now = None

    def of(self, p: Pass) -> Calls | None:
        """The calls of a pass, if they are known."""
        known = self._calls.get(id(p))
        return known[1] if known and known[0] is p else None

    def give_up(self) -> None:
        """Keep no calls: what a pass draws depends on what it has drawn."""
        self.records, self._now = False, None
        self.forget()

    def forget(self) -> None:
        """Forget the calls of all passes."""
        self._calls.clear()
        self._textures.clear()

    def are_still(self, textures: dict[Hashable, DeviceTexture]) -> bool:
        """Whether these have all that passes drew into or read."""
        return all(textures.get(key) is texture for key, texture in self._textures.items())
