# SPDX-License-Identifier: GPL-3.0-or-later
"""The programs of a plan's passes: composed texts and their declarations."""

from __future__ import annotations

import re
from collections.abc import Iterable
from functools import cache

from ..device.interface import PipelineDescription
from ..features import CONSTANTS, ORDER, VALUES
from .composition import DEFAULTS, compose
from .frame_plan import FramePlan
from .graph import Part, Pass
from .uniforms import DRAW, INSTANCE, VIEW, Block

#: Tells fragments whose they are, where one draw call has many instances and fragments need the values of theirs.
_NUMBER = ("flat", "float", "instance_number")


#: The vertex shader of a pass that draws over everything.
FULLSCREEN = "fullscreen.vert"


def describe(plan: FramePlan, p: Pass, vertex: str = FULLSCREEN, *variants: str) -> PipelineDescription:
    """The pipeline of a pass with the parts of these variants; found once for equal passes."""
    of_plan = plan.variants, plan.choices, plan.linear_depth, plan.multisamples
    key = p.name, p.host, p.kind, *p.state.items(), of_plan, vertex, variants
    known = p.wiring.programs
    if key not in known:
        known[key] = _described(plan, p, vertex, *variants)
    return known[key]


def _described(plan: FramePlan, p: Pass, vertex: str, *variants: str) -> PipelineDescription:
    parts = _taken(plan, p, variants)
    texts = composed(plan, p, vertex, *variants)
    called = {texture: name for part in parts for texture, name in part.called}
    updated = {texture for part in parts for texture in part.updates}
    drawn = [texture for part in parts for texture in part.fills if not texture.is_depth]
    sampled = [(called.get(t, t.name), t) for part in parts for t in (*part.reads, *part.updates)]
    varyings = tuple(dict.fromkeys([varying for part in parts for varying in part.varyings] + _told(texts)))
    if vertex == FULLSCREEN and varyings:
        # no vertices tell fragments anything: these find it out
        texts = texts[0], "".join(f"{kind} {name};\n" for _, kind, name in varyings) + texts[1]
        varyings = ()
    return PipelineDescription(
        name="_".join((p.name, *variants)),
        vertex=texts[0],
        fragment=texts[1],
        blocks=blocks_in(*texts),
        samplers=tuple(dict.fromkeys([name for part in parts for name in part.inputs] + [name for name, _ in sampled])),
        multisampled=tuple(dict.fromkeys(name for name, t in sampled if plan.multisamples_of(t))),
        varyings=varyings,
        outputs=tuple((t.type, f"{t.name}_next" if t in updated else called.get(t, t.name)) for t in drawn),
        defines=tuple({**constants_in(*texts), **{n: str(v) for part in parts for n, v in part.constants}}.items()),
        **p.state,
    )


def composed(plan: FramePlan, p: Pass, vertex: str, *variants: str, origins=False) -> tuple[str, str]:
    """The texts of a pass's vertex and fragment shader. origins: as for `compose`."""
    parts = _taken(plan, p, variants)
    words = dict.fromkeys([part.feature for part in parts] + [word for part in parts for word in part.words])
    depth_format = {"depth_format": "linear" if plan.linear_depth else "hardware"}
    names = DEFAULTS | dict(plan.choices) | depth_format | {name: file for part in parts for name, file in part.choices}
    ordered, chosen = _ordered((*words, p.kind)), tuple(names.items())
    texts = tuple(compose(host, ordered, chosen, origins) for host in (vertex, p.host))
    if names["instances"] == "table" and re.search(r"\binstance\.", texts[1]):
        chosen = tuple((names | {"instances": "told_table"}).items())
        texts = tuple(compose(host, ordered, chosen, origins) for host in (vertex, p.host))
    return texts


def _told(texts: tuple[str, str]) -> list[tuple[str, str, str]]:
    return [_NUMBER] if _NUMBER[2] in texts[1] else []


def _taken(plan: FramePlan, p: Pass, variants: Iterable[str]) -> list[Part]:
    taken = {"", *plan.variants, *variants}
    return [part for part in p.parts if part.only in taken]


def _ordered(words: Iterable[str]) -> tuple[str, ...]:
    """Features in the order in which they act, then the other words."""
    return tuple(sorted(words, key=lambda word: (ORDER.get(word, len(ORDER)), word)))


@cache
def blocks_in(*texts: str) -> tuple[Block, ...]:
    """The blocks that a program's texts use. Raises ValueError for a value that no feature provides."""
    text = "".join(texts)
    names = set(re.findall(r"\bframe\.(\w+)", text))
    if missing := names - set(VALUES):
        raise ValueError(f"A shader reads frame.{min(missing)}, which no feature provides.")
    used = [block for block in (VIEW, DRAW, INSTANCE) if re.search(rf"\b{block[1]}\.", text)]
    if f"struct {INSTANCE[0]} " in text:
        # of many instances, it is a table
        used.remove(INSTANCE)
    fields = tuple((kind, name) for name, (kind, _) in VALUES.items() if name in names)
    return (*used, *((("Frame", "frame", fields),) if fields else ()))


@cache
def constants_in(*texts: str) -> dict[str, str]:
    """The constants that a program's texts use."""
    words = set(re.findall(r"\b[A-Z][A-Z0-9_]+\b", "".join(texts)))
    return {name: str(value) for name, value in CONSTANTS.items() if name in words}
