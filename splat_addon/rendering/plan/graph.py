# SPDX-License-Identifier: GPL-3.0-or-later
"""A frame as an ordered list of passes over typed textures, to which features add parts.

Order is the list's, so nothing is scheduled, and no texture has versions: a pass that writes without reading ends the
life of what was there, which lets passes share a texture (each transparent layer has the sums of the opaque picture).
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field, replace
from typing import Any, NamedTuple

from ..device.interface import FORMATS

#: channels -> type in a shader
_TYPES = {1: "float", 2: "vec2", 4: "vec4"}


@dataclass(frozen=True, eq=False)
class Texture:
    """What passes write. name: also of the sampler that reads it. format: a name in `device.interface.FORMATS`.

    per: what it holds one value for, a name in `plan.SIZES`. is_multisampled: it has the frame's hardware samples.
    is_sum: of float16, where sums are that.
    """

    name: str
    format: str = "RGBA32F"
    per: str = "sample"
    is_multisampled: bool = False
    is_sum: bool = False

    @property
    def is_depth(self) -> bool:
        return self.format == "DEPTH32F"

    @property
    def type(self) -> str:
        """In a shader that writes it."""
        return _TYPES[FORMATS[self.format]]


_FILLS = ("writes", "updates")


class Part(NamedTuple):
    """What one feature does in a pass.

    feature: its name, and that of its GLSL file. words: what else is said to the composition of shaders.
    reads: textures that its functions read. inputs: names of samplers of what no pass writes.
    writes: attachments that it fills. updates: of one channel set, read and written anew into a second texture, which
        then takes the first one's place; outputs are called <name>_next.
    tests: the depth that the hardware tests with, and leaves as it is.
    called: textures whose sampler or output has another name in this pass.
    varyings: (interpolation, type, name). constants: (name, value). choices: (name in paths, file).
    only: the variant of the pass's programs that it is in; "" for all. reason: told beside the pass's own.

    A part that fills attachments lives while one of them is read later; one that fills none changes what others write,
    and lives while the pass does, as does the first, the pass's own.
    """

    feature: str
    words: tuple[str, ...] = ()
    reads: tuple[Texture, ...] = ()
    inputs: tuple[str, ...] = ()
    writes: tuple[Texture, ...] = ()
    updates: tuple[Texture, ...] = ()
    tests: tuple[Texture, ...] = ()
    called: tuple[tuple[Texture, str], ...] = ()
    varyings: tuple[tuple[str, str, str], ...] = ()
    constants: tuple[tuple[str, object], ...] = ()
    choices: tuple[tuple[str, str], ...] = ()
    only: str = ""
    reason: str = ""

    @property
    def fills(self) -> tuple[Texture, ...]:
        return (*self.writes, *self.updates)

    def needed(self, live: set[Texture]) -> Part:
        """Without the attachments that nobody reads; depth stays, the pass tests with it."""
        if all(t in live or t.is_depth for t in self.fills):
            return self
        kept = {name: tuple(t for t in getattr(self, name) if t in live or t.is_depth) for name in _FILLS}
        return self._replace(**kept)


@dataclass(frozen=True)
class Pass:
    """name: told to the user. reason: why the frame needs it. host: its fragment shader, which features know it by.

    run: run(tile, pass) -> the target that was drawn into. kind: "opaque", "layer", "rest", ..., for features.
    state: of its pipelines, fields of `PipelineDescription`. adds: to what is there, which it does not clear.
    once: what its result depends on, if it is made with the first tile for all: it is made again where `is_same` of
        that of the last frame is False. each: a pass that it runs itself, for each instance.
    """

    name: str
    reason: str
    host: str
    run: Callable[[Any, Pass], Any]
    parts: tuple[Part, ...]
    kind: str = "opaque"
    state: dict[str, Any] = field(default_factory=dict)
    adds: bool = False
    once: object = None
    is_same: Callable[[Any, Any], bool] | None = None
    each: Pass | None = None

    def all(self, *fields: str) -> tuple:
        """What all parts have in these fields, once each."""
        return tuple(dict.fromkeys(item for part in self.parts for name in fields for item in getattr(part, name)))

    @property
    def fills(self) -> tuple[Texture, ...]:
        return self.all(*_FILLS)

    @property
    def colors(self) -> tuple[Texture, ...]:
        """The attachments in slot order, without depth."""
        return tuple(texture for texture in self.fills if not texture.is_depth)

    @property
    def depth(self) -> Texture | None:
        """The attachment that the hardware tests with."""
        return next((t for t in (*self.fills, *self.all("tests")) if t.is_depth), None)

    @property
    def reads(self) -> tuple[str, ...]:
        """Names of all that it reads."""
        return (*(t.name for t in self.all("reads", "tests", "updates")), *self.all("inputs"))

    @property
    def writes(self) -> tuple[str, ...]:
        """Names of the attachments that it fills; a second one of what it updates."""
        return (*(t.name for t in self.all("writes")), *(f"{t.name}_next" for t in self.all("updates")))


@dataclass(frozen=True)
class Loop:
    """Passes that repeat `times`, or until one leaves nothing in `stop`, which is read back; `last` where none does."""

    name: str
    reason: str
    times: int
    body: tuple[Pass, ...]
    stop: Texture
    last: tuple[Pass, ...] = ()


Step = Pass | Loop


def each_pass(steps: Iterable[Step]) -> Iterator[Pass]:
    """All passes, those of a loop once."""
    for step in steps:
        if isinstance(step, Loop):
            yield from each_pass((*step.body, *step.last))
        else:
            yield from (*((step.each,) if step.each else ()), step)


def changed(steps: Iterable[Step], change: Callable[[Pass], Pass]) -> tuple[Step, ...]:
    """The steps with every pass changed."""

    def one(step: Step) -> Step:
        if isinstance(step, Loop):
            return replace(step, body=changed(step.body, change), last=changed(step.last, change))
        return replace(change(step), each=change(step.each)) if step.each else change(step)

    return tuple(one(step) for step in steps)


def trimmed(steps: Iterable[Step], live: Iterable[Texture], stop=None, after=()) -> tuple[tuple, set[Texture]]:
    """The steps with the parts alone that lead to `live`, and what they read that none of them wrote before.

    stop, after: of a loop's body, where it may end, and what is read then.
    """
    kept, live = [], set(live)
    for step in reversed(tuple(steps)):
        if isinstance(step, Loop):
            last, ended = trimmed(step.last, live)
            start, found = set(), None
            while found != start:
                found = start
                body, start = trimmed(step.body, ended | found | live, step.stop, live)
            kept.append(replace(step, body=body, last=last))
            live = start | live
            continue
        if stop in step.fills:
            live |= {stop, *after}
        if live.intersection(step.fills):
            pairs = [(old, old.needed(live)) for old in step.parts]
            parts = tuple(new for old, new in pairs if new.fills or not old.fills or old is step.parts[0])
            is_same = len(parts) == len(step.parts) and all(a is b for a, b in zip(parts, step.parts, strict=True))
            kept.append(step if is_same else replace(step, parts=parts))
            if not step.adds:
                live -= set(kept[-1].all("writes"))
            live |= set(kept[-1].all("reads", "updates", "tests"))
            if step.each:
                live |= set(step.each.all("reads"))
                live -= set(step.each.fills)
    return tuple(kept[::-1]), live
