# SPDX-License-Identifier: GPL-3.0-or-later
"""Finds out whether the pictures of `equal_pictures.py` show a missing part: `python3 prove_pictures.py`.

Every part of every pass in their plans, every file that a part or plan chooses, and every pass is removed in turn. Then
a picture must change, or the plan or the device must refuse. It prints what can be removed without effect: such a thing
needs a picture, or is not needed.
"""

import argparse
import sys
from collections import defaultdict
from contextlib import contextmanager
from pathlib import Path
from unittest.mock import patch

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT), str(Path(__file__).resolve().parent)]

import equal_pictures  # noqa: E402

from splat_addon.rendering import Renderer, open_device  # noqa: E402
from splat_addon.rendering import plan as planned  # noqa: E402
from splat_addon.rendering.plan import build, graph, programs  # noqa: E402
from splat_addon.rendering.plan.composition import DEFAULTS  # noqa: E402
from splat_addon.rendering.plan.graph import Loop, Pass  # noqa: E402

#: The number of pictures with a part that are drawn before the part counts as having no effect.
TRIES = 40


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("-k", default="", help="only things whose name has this in it")
    options = parser.parse_args()
    cases = {name: (make, edge) for name, make, edge in equal_pictures.cases()}
    having = found(cases)
    renderer, before, untold = Renderer(open_device("standalone")), {}, []
    asked = [(thing, names) for thing, names in sorted(having.items(), key=str) if options.k in str(thing)]
    for number, (thing, names) in enumerate(asked, 1):
        if not is_told(renderer, thing, names, cases, before):
            untold.append(thing)
            print(f"nothing tells of {' '.join(map(str, thing))}, in {len(names)} pictures", flush=True)
        if number % 25 == 0 or number == len(asked):
            print(f"{number - len(untold)} of {number} parts, choices and passes are told of", flush=True)
    return len(untold)


def found(cases) -> dict[tuple, list[str]]:
    """Removable thing -> the cases whose plan contains it."""
    having = defaultdict(list)
    for name, (make, _) in cases.items():
        scene, camera, settings, *_ = make()
        try:
            made = planned(scene, camera, settings)
        except (ValueError, AttributeError):  # a refusal is a picture too; panoramas have plans of their faces alone
            continue
        for thing in {thing for p in made.passes for thing in things(p)} | {("plan chooses", *c) for c in made.choices}:
            if thing[0] != "plan chooses" or DEFAULTS[thing[1]] != thing[2]:
                having[thing].append(name)
    return having


def things(p: Pass):
    """What can be removed from a pass."""
    for part in p.parts:
        yield "part", p.host, p.kind, part.feature, part.words, part.only
        for name, file in part.choices:
            if DEFAULTS[name] != file:
                yield "choice", p.host, p.kind, part.feature, name, file
    if p.host:
        yield "pass", p.name, p.kind


def without(thing: tuple, p: Pass) -> Pass:
    """The pass without a part or choice."""
    kind, host, of, *which = thing
    if (host, of) != (p.host, p.kind):
        return p
    if kind == "part":
        return p.with_values(parts=tuple(t for t in p.parts if [t.feature, t.words, t.only] != which))
    parts = (
        t._replace(choices=tuple(c for c in t.choices if [t.feature, *c] != which)) if t.choices else t for t in p.parts
    )
    return p.with_values(parts=tuple(parts))


def is_told(renderer, thing: tuple, names: list[str], cases, before: dict) -> bool:
    """Whether some picture changes without it."""
    for name in names[:: max(len(names) // TRIES, 1)]:
        if name not in before:
            before[name] = drawn(renderer, *cases[name])
        with taken_out(thing):
            after = drawn(renderer, *cases[name])
        if set(after) != set(before[name]) or any(
            not np.array_equal(values, after[array], equal_nan=values.dtype.kind == "f")
            for array, values in before[name].items()
        ):
            return True
    return False


def taken_out(thing: tuple):
    """A context in which plans are made without it."""
    if thing[0] == "plan chooses":
        return chosen_as_usual(thing[1])
    if thing[0] == "pass":
        changed = build.changed
        return patch.object(build, "changed", lambda steps, change: less(thing, changed(steps, change)))
    with_parts = build._with_parts
    return patch.object(build, "_with_parts", lambda *given: without(thing, with_parts(*given)))


@contextmanager
def chosen_as_usual(name: str):
    usual, taken = ((name, DEFAULTS[name]),), programs._taken
    chosen = patch.object(
        programs, "_taken", lambda *given: [t._replace(choices=t.choices + usual) for t in taken(*given)]
    )
    # no program of another plan
    with chosen, patch.object(graph, "_wiring", graph.Wiring):
        yield


def less(thing: tuple, steps: tuple) -> tuple:
    """The steps without one pass."""
    kept = []
    for step in steps:
        if isinstance(step, Loop):
            kept.append(step._replace(body=less(thing, step.body), last=less(thing, step.last)))
        elif thing[1:] not in [(p.name, p.kind) for p in (step, step.each) if p]:
            kept.append(step)
    return tuple(kept)


def drawn(renderer, make, edge) -> dict[str, np.ndarray]:
    """The arrays of a case, or its error."""
    limits = equal_pictures.edge_module()
    normal, limits.MAX_TARGET_EDGE = limits.MAX_TARGET_EDGE, edge or limits.MAX_TARGET_EDGE
    try:
        return {name: np.asarray(values) for name, values in equal_pictures.pictures(renderer, *make()).items()}
    except Exception as error:
        return {"error": np.array(type(error).__name__)}
    finally:
        limits.MAX_TARGET_EDGE = normal


if __name__ == "__main__":
    sys.exit(main() != 0)
