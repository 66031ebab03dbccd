# SPDX-License-Identifier: GPL-3.0-or-later
"""The lines of code in the shaders, and those that a plan's programs have, for tests that pictures have them all."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache

from splat_addon.rendering.plan.compose import VERTEX
from splat_addon.rendering.plan.composition import FOLDER
from splat_addon.rendering.plan.frame_plan import FramePlan
from splat_addon.rendering.plan.graph import Pass
from splat_addon.rendering.plan.programs import composed


def all_lines() -> set[tuple[str, str]]:
    """(file below shaders/, line) of all shaders."""
    return {
        (file.relative_to(FOLDER).as_posix(), line.strip())
        for file in FOLDER.rglob("*.glsl")
        for line in file.read_text(encoding="utf-8").splitlines()
        if is_code(line)
    }


def is_code(line: str) -> bool:
    """Whether a line is more than a comment, a bracket, or a mark for the composition."""
    return line.strip(" {}();") != "" and not line.lstrip().startswith(("//", "#"))


def of_plan(made: FramePlan) -> set[tuple[str, str]]:
    """(file below shaders/, line) of the programs that the plan's passes may use."""
    passes = [each for p in made.passes for each in (p, p.each) if each is not None and each.host]
    return {
        line for p in passes for how in _programs(made, p) for text in composed(made, p, *how, origins=True)
        for line in _lines(text)
    }  # fmt: skip


def _programs(made: FramePlan, p: Pass) -> Iterator[tuple[str, ...]]:
    """The vertex shader and the variants of a pass's programs: none, all and each, with each vertex shader."""
    variants = {part.only for part in p.parts} - {"", *made.variants}
    others = sorted(variants - VERTEX.keys())
    own = p.host.vertex
    usual = own if (FOLDER / "hosts" / f"{own}.glsl").exists() else "fullscreen.vert"
    for first in (*sorted(variants & VERTEX.keys()), ""):
        for more in ((), others, *([variant] for variant in others)):
            yield (VERTEX.get(first, usual), *filter(None, [first]), *more)


@cache
def _lines(text: str) -> frozenset[tuple[str, str]]:
    """(file, line) of a text that says where its parts are from."""
    files, found = [], set()
    for line in text.splitlines():
        mark, _, file = line.strip().rpartition(" ")
        if mark == "// >>>":
            files.append(file)
        elif mark == "// <<<":
            files.pop()
        elif files and is_code(line):
            found.add((files[-1], line.strip()))
    return frozenset(found)
