# SPDX-License-Identifier: GPL-3.0-or-later
"""What the samples of a picture have in common that see the same instances from the same place: their cameras differ by
less than a pixel, so that the same calls draw them, with other values in the uniform blocks of the view and frame."""

from __future__ import annotations

from collections.abc import Callable, Hashable
from functools import partial
from typing import TYPE_CHECKING, NamedTuple, TypeVar

import numpy as np

from ..device.interface import Target
from ..device.interface import Texture as DeviceTexture
from .graph import Pass
from .uniforms import Block

if TYPE_CHECKING:
    from ..upload.resources import Resources

Made = TypeVar("Made")


class Calls(NamedTuple):
    """What a pass called on the device, and the target that it returned. number: of the pass in its picture. lasting:
    the calls whose effect is still there for the next sample, unless something else was drawn between the two."""

    number: int
    p: Pass
    calls: list[Callable[[], None]]
    lasting: list[Callable[[], None]]
    target: Target


class Repeats:
    """records: whether the calls of passes are kept for the next sample, which needs textures that stay, and results
    that nothing reads while passes run.

    passes: the calls of all passes in order, once a sample is complete. found: what was found of the view. blocks: the
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
        self._textures: dict[Hashable, DeviceTexture] = {}
        self._shared: dict[Hashable, object] = {}

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

    def shares(self, key: Hashable, value: object) -> None:
        """Note that passes use a texture that was drawn once, and what it was made from."""
        self._shared[key] = value

    def begin(self) -> None:
        """Keep what is called from now on."""
        self._now = ([], []) if self.records else None

    def end(self, number: int, p: Pass, target: Target) -> None:
        """A pass is complete."""
        if self._now is not None:
            self._recorded.append(Calls(number, p, *self._now, target))
            self._now = None

    def complete(self) -> None:
        """A sample is complete."""
        if self.records:
            self.passes = tuple(self._recorded)

    def give_up(self) -> None:
        """Keep no calls: what a pass draws depends on what it has drawn."""
        self.records = False
        self.restart()

    def hold(self, resources: Resources) -> bool:
        """Whether the calls of a sample draw the next: all that they draw into or read is still there."""
        return (
            bool(self.passes)
            and all(resources.textures.get(key) is texture for key, texture in self._textures.items())
            and all(resources.made_from.get(key) == value for key, value in self._shared.items())
        )
