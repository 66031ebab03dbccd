# SPDX-License-Identifier: GPL-3.0-or-later
"""A frame as an ordered list of passes over typed textures, to which features add parts.

Passes run in list order, without scheduling, and textures have no versions: a pass that writes without reading discards
the previous contents, so passes can share a texture (each transparent layer reuses the sums of the opaque picture).
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field, fields
from functools import cached_property, lru_cache
from typing import Any, NamedTuple

from ..device.interface import FORMATS, PipelineDescription
from .hosts import Host, Kind

#: channels -> GLSL type
_TYPES = {1: "float", 2: "vec2", 4: "vec4"}


def of_samples(plan, pixels: tuple[int, int]) -> tuple[int, int]:
    """A texture size: one value per sample."""
    return pixels[0] * plan.samples, pixels[1] * plan.samples


def of_pixels(plan, pixels: tuple[int, int]) -> tuple[int, int]:
    """A texture size: one value per pixel."""
    return pixels


@dataclass(frozen=True, eq=False)
class Texture:
    """A texture that passes write. name: also the name of the sampler that reads it. format: a name in
    `device.interface.FORMATS`.

    per: function of the plan and a tile's size in pixels, including the margin, that returns width and height.
    is_multisampled: has the frame's hardware samples. is_sum: is float16 if the settings choose float16 sums.
    """

    name: str
    format: str = "RGBA32F"
    per: Callable[[Any, tuple[int, int]], tuple[int, int]] = of_samples
    is_multisampled: bool = False
    is_sum: bool = False

    @property
    def is_depth(self) -> bool:
        return self.format == "DEPTH32F"

    @property
    def type(self) -> str:
        """Its GLSL type in shaders that write it."""
        return _TYPES[FORMATS[self.format]]


class Part(NamedTuple):
    """What one feature does in a pass.

    feature: its name, and that of its GLSL file. words: further words for the composition of shaders.
    reads: textures that its functions read. inputs: names of samplers of textures that no pass writes.
    writes: attachments that it fills. updates: textures that it reads and rewrites into a second texture, which then
        replaces the first; the outputs are called <name>_next.
    tests: the depth texture that the hardware tests against without writing.
    called: textures whose sampler or output has another name in this pass.
    varyings: (interpolation, type, name). constants: (name, value). choices: (name in paths, file).
    only: the program variant that it belongs to; "" for all. reason: shown beside the pass's own.

    A part that fills attachments is kept if one of them is read later. A part that fills none changes what others write
    and is kept as long as the pass, and so is the first part, the pass's own.
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

    def without(self, dead: set[Texture]) -> Part:
        """The part without some of its attachments."""
        if dead.isdisjoint(self.fills):
            return self
        writes, updates = (tuple(t for t in filled if t not in dead) for filled in (self.writes, self.updates))
        return self._replace(writes=writes, updates=updates)


class Pause(NamedTuple):
    """A moment at which drawing may be interrupted for as long as other pictures of its renderer wait. target: what was
    drawn into, if anything."""

    target: Any = None


def fill(tile, p: Pass):
    """Run a pass that draws over what it writes, where anything is seen. Elsewhere the contents are undefined."""
    return tile.fill(p, tile.seen_part(p))


def fill_all(tile, p: Pass):
    """Run a pass that draws over everything that it writes."""
    return tile.fill(p)


class Wiring:
    """What the parts of a pass read and fill together.

    fills: the attachments; colors: in slot order, without depth. depth: the one used for the hardware's depth test.
    updates: as of `Part`. samplers: the textures that are sampled and that passes write, by name. most_read: the names
    of all textures that are sampled, of the variant that has most. programs: what `programs.describe` made of them.
    """

    def __init__(self, parts: tuple[Part, ...]):
        self._parts = parts
        self.fills = tuple(dict.fromkeys([t for part in parts for t in part.fills]))
        self.colors = tuple(texture for texture in self.fills if not texture.is_depth)
        self.depth = next((t for t in (*self.fills, *self.all("tests")) if t.is_depth), None)
        self.updates = self.all("updates")
        called = dict(self.all("called"))
        self.samplers = {called.get(texture, texture.name): texture for texture in self.all("reads", "updates")}
        self.most_read = max((self._read_by(part.only) for part in parts), key=len, default=())
        self.programs: dict[tuple, PipelineDescription] = {}

    def all(self, *fields: str) -> tuple:
        """The union of these fields over all parts."""
        return tuple(dict.fromkeys(item for part in self._parts for name in fields for item in getattr(part, name)))

    def _read_by(self, variant: str) -> tuple[str, ...]:
        own = [part for part in self._parts if part.only in ("", variant)]
        textures = [texture.name for part in own for texture in (*part.reads, *part.updates)]
        return tuple(dict.fromkeys([name for part in own for name in part.inputs] + textures))


#: Passes whose wiring is kept: about twenty make a picture, but an animated setting may change their constants.
_WIRINGS = 1024


@lru_cache(_WIRINGS)
def _wiring(parts: tuple[Part, ...]) -> Wiring:
    return Wiring(parts)


@dataclass(frozen=True)
class Pass:
    """name: shown to the user. reason: why the frame needs it. host: its fragment shader, by which features identify
    it, as by kind; None for a pass that has none, and so no parts of other features.

    run: run(tile, pass) -> the target that was drawn into, or a generator that yields `Pause` and returns it.
    state: of its pipelines, fields of `PipelineDescription`. adds: draws onto existing contents without clearing.
    once: once(tile, pass), for a pass that runs once for all tiles, gives a value that its result depends on; as long
        as values are equal, following samples and frames share the result. each: a pass that it runs itself for each
        instance.
    """

    name: str
    reason: str
    host: Host | None
    run: Callable[[Any, Pass], Any]
    parts: tuple[Part, ...]
    kind: Kind = Kind.OPAQUE
    state: Mapping[str, Any] = field(default_factory=dict)
    adds: bool = False
    once: Callable[[Any, Pass], object] | None = None
    each: Pass | None = None

    def with_values(self, **values) -> Pass:
        """A pass with other values of some fields."""
        made = object.__new__(Pass)
        made.__dict__.update({name: self.__dict__[name] for name in _FIELDS} | values)
        return made

    @cached_property
    def wiring(self) -> Wiring:
        """What its parts read and fill; found once for all passes with equal parts."""
        return _wiring(self.parts)

    def all(self, *fields: str) -> tuple:
        """The union of these fields over all parts."""
        return self.wiring.all(*fields)

    @cached_property
    def fills(self) -> tuple[Texture, ...]:
        return tuple(dict.fromkeys([t for part in self.parts for t in part.fills]))

    @property
    def colors(self) -> tuple[Texture, ...]:
        return self.wiring.colors

    @property
    def depth(self) -> Texture | None:
        return self.wiring.depth

    @property
    def reads(self) -> tuple[str, ...]:
        """Names of all textures that it reads."""
        return (*(t.name for t in self.all("reads", "tests", "updates")), *self.all("inputs"))

    @property
    def writes(self) -> tuple[str, ...]:
        """Names of the attachments that it fills; a texture that it updates counts as `<name>_next`."""
        return (*(t.name for t in self.all("writes")), *(f"{t.name}_next" for t in self.all("updates")))


_FIELDS = tuple(f.name for f in fields(Pass))


class Loop(NamedTuple):
    """Passes that repeat `times`, or until one leaves `stop`, which is read back, empty; `last` runs if none does."""

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
    """The steps with a function applied to every pass."""

    def one(step: Step) -> Step:
        if isinstance(step, Loop):
            return step._replace(body=changed(step.body, change), last=changed(step.last, change))
        return change(step).with_values(each=change(step.each)) if step.each else change(step)

    return tuple(one(step) for step in steps)


def trimmed(steps: Iterable[Step], live: Iterable[Texture], stop=None, after=()) -> tuple[tuple, set[Texture]]:
    """The steps reduced to the parts that contribute to `live`, and what they read that none of them wrote before.

    stop, after: for a loop's body, the texture that may end it, and what is read afterwards.
    """
    kept, live = [], set(live)
    for step in reversed(tuple(steps)):
        if isinstance(step, Loop):
            last, ended = trimmed(step.last, live)
            start, found = set(), None
            while found != start:
                found = start
                body, start = trimmed(step.body, ended | found | live, step.stop, live)
            kept.append(step._replace(body=body, last=last))
            live = start | live
            continue
        filled = step.fills
        if stop in filled:
            live |= {stop, *after}
        if not live.isdisjoint(filled):
            step = _without(step, {t for t in filled if t not in live and not t.is_depth})
            kept.append(step)
            live = _live_before(step, live)
    return tuple(kept[::-1]), live


def _without(p: Pass, dead: set[Texture]) -> Pass:
    """The pass without attachments that nobody reads, and without parts that only filled those."""
    if not dead:
        return p
    pairs = [(part, part.without(dead)) for part in p.parts]
    return p.with_values(parts=tuple(new for old, new in pairs if new.fills or not old.fills or old is p.parts[0]))


def _live_before(p: Pass, live: set[Texture]) -> set[Texture]:
    """The textures needed before a pass, given those needed after it."""
    if not p.adds:
        live = live.difference(*[part.writes for part in p.parts])
    live = live.union(*[part.reads + part.updates + part.tests for part in p.parts])
    if p.each:
        # what it reads of the pass that runs it was not there before
        live = live.union(p.each.all("reads")).difference(p.each.fills, p.fills if not p.adds else ())
    return live
