# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs the steps of a plan for one tile of the picture; it knows no pass or texture by name."""

from __future__ import annotations

from collections.abc import Callable, Generator
from typing import TYPE_CHECKING

from ..device.interface import Target
from .graph import Loop, Pass, Pause, Step

if TYPE_CHECKING:
    from .repeats import Repeats
    from .tile import TileContext


def run_pass(tile: TileContext, p: Pass) -> Target | Generator[Pause, None, Target]:
    """What `Pass.run` returns."""
    return p.run(tile, p)


class Execution:
    """One frame's steps, tile by tile. told: called before each pass with its name. done: called after it, with its
    target."""

    def __init__(self, told: Callable[[Pass, int], None], done: Callable[[Pass, Target], None]):
        self._is_shared_done, self._told, self._done = False, told, done
        self.turns = 0

    def run(self, steps: tuple[Step, ...], tile: TileContext) -> Generator[Pause, None, Target | None]:
        """Run all steps, with pauses between and in them; returns the target of the last pass. turns: maximum number of
        iterations of loops in any tile."""
        self._number, target = 0, None
        tile.repeats.restart()
        for step in steps:
            # none after the last, which completes what is seen
            yield Pause(target)
            target = yield from self._repeat(step, tile) if isinstance(step, Loop) else self._pass(step, tile)
        self._is_shared_done = True
        tile.repeats.complete()
        return target

    def again(self, repeats: Repeats) -> Generator[Pause, None, Target]:
        """Make the calls of the sample before again; returns as `run`."""
        target = None
        for number, p, calls, into in repeats.passes:
            yield Pause(target)
            self._told(p, number)
            for call in calls:
                call()
            target = into
            self._done(p, target)
        return target

    def _pass(self, p: Pass, tile: TileContext) -> Generator[Pause, None, Target | None]:
        self._number += 1
        if p.once is None:
            return (yield from self._drawn(p, tile))
        if not self._is_shared_done:
            key, made_from = tile.key(p.fills[0]), tile.resources.made_from
            value = tile.shared.kept(("once", p.name, tile.resources.arrivals), lambda: p.once(tile, p))
            # none while it is drawn over, which may be given up
            if made_from.pop(key, None) != value:
                yield from self._drawn(p, tile)
            made_from[key] = value
        return None

    def _drawn(self, p: Pass, tile: TileContext) -> Generator[Pause, None, Target | None]:
        self._told(p, self._number - 1)
        if p.once is None:
            tile.repeats.begin()
        target = run_pass(tile, p)
        if isinstance(target, Generator):
            target = yield from target
        tile.repeats.end(self._number - 1, p, target)
        for texture in p.wiring.updates:
            tile.swap(texture)
        self._done(p, target)
        return target

    def _repeat(self, loop: Loop, tile: TileContext) -> Generator[Pause, None, None]:
        first = self._number
        for turn in range(loop.times):
            for p in loop.body:
                target = yield from self._pass(p, tile)
                yield Pause(target)
                if loop.stop in p.fills and not target.read(p.colors.index(loop.stop)).any():
                    self._number = first + len(loop.body) * loop.times + len(loop.last)
                    return
            self.turns = max(self.turns, turn + 1)
        for p in loop.last:
            yield from self._pass(p, tile)
        self.turns = max(self.turns, loop.times + bool(loop.last))
