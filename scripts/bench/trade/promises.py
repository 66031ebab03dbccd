# SPDX-License-Identifier: GPL-3.0-or-later
"""How well a target error and a time budget are kept, in scenes from which nothing was learned before.

Each scene is measured as the first frame of a render is: a few choices, and single other settings, beside exact
pictures of eight. Then the choice for each target is drawn. Its error is that beside exact pictures of 64, its time the
median of the turns, in processor seconds, which other load lengthens least. *Of target* is either divided by the target
where one was promised; *of expected* by what was expected. Targets are multiples of the closest and the fastest that
was measured. *Speed* is the time of the fastest choice in the same turns, divided by that when the scene was measured:
how much slower the machine has become. Each is drawn once before it is timed, as frames of an animation follow another.
"""

from __future__ import annotations

import math
import statistics
from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import partial
from operator import attrgetter
from time import process_time

from bench.trade.cases import CASES, View
from measuring.report import Table
from measuring.timing import in_pairs, processor
from splat_addon.reference import scenes
from splat_addon.rendering import Light, Renderer, Settings
from splat_addon.trade import TIMED_TURNS, ExactPictures, Survey, Target
from splat_addon.trade.measuring import row_of

#: Multiples of the least error, and of the least time, of a scene that was measured.
ERRORS, TIMES = (1.2, 2.0, 4.0), (1.5, 3.0, 8.0)

#: Scenes of the page; `--scenes` takes others.
SCENES = "text", "torus", "sub-pixel sphere", "armadillo", "checker at 60", "transparent spheres"

_SUN = Light("sun", direction=(0.4, 0.3, -1.0), energy=3.0, casts_shadow=True)
_FLAT = Settings(shading="flat", outputs=("color",))
_LIT = Settings(outputs=("color",), ambient_occlusion=float("inf"))


def units(renderer: Renderer, options, report) -> dict[str, Callable[[], list[dict]]]:
    names = options.scenes or SCENES[: 1 if options.quick else None]
    return {name: partial(_measure, name, renderer, options) for name in names}


def _measure(name: str, renderer: Renderer, options) -> list[dict]:
    return [
        {"scene": shot, **row}
        for shot, scene, camera, settings in _shots(name, View(options.size, options.models))
        for row in _promises(renderer, scene, camera, settings, min(options.turns, TIMED_TURNS))
    ]


def _shots(name: str, view: View) -> Iterator[tuple]:
    """(name, scene, camera, settings): a scene flat, and lit by a sun whose shadows it has."""
    if name == "transparent spheres":
        yield name, *scenes.transparent_spheres(view.over(2000), size=view.picture), _LIT
        return
    scene, camera = CASES[name].build(view)
    yield name, scene, camera, _FLAT
    yield f"{name}, lit", replace(scene, lights=(_SUN,), world=(0.3, 0.35, 0.4)), camera, _LIT


def _promises(renderer: Renderer, scene, camera, settings: Settings, turns: int) -> Iterator[dict]:
    """A row for each target that could be promised: what was reached, divided by the target and by what was
    expected."""
    survey = Survey(renderer, scene, camera, settings, turns=turns, clock=process_time)
    truth = ExactPictures.drawn(renderer, scene, camera, settings, 32)
    closest, fastest = (min(survey.rows, key=attrgetter(of)) for of in ("flip", "seconds"))
    targets = [Target(flip=closest.flip * factor) for factor in ERRORS]
    targets += [Target(seconds=fastest.seconds * factor) for factor in TIMES]
    for target in targets:
        promise = survey.promise(target)
        if not promise.is_kept:
            continue
        job, unit = (
            partial(renderer.render, scene, camera, choice.of(settings), is_repeatable=True)
            for choice in (promise.choice, fastest.choice)
        )
        ((_, drawn),) = in_pairs({promise.choice: job}, unit, turns, math.inf, processor)
        took = drawn.own().median
        speed = statistics.median(beside for _, beside in drawn.values) / fastest.seconds
        flip = row_of(promise.choice, drawn.result, truth, [took]).flip
        is_error = target.seconds is None
        yield {
            "target": f"FLIP {target.flip:.4f}" if is_error else f"{target.seconds:.2g} s",
            "chosen": promise.choice.name,
            "of": "error" if is_error else "time",
            "of_target": round(flip / target.flip if is_error else took / target.seconds, 3),
            "of_expected_error": round(flip / promise.flip, 3),
            "of_expected_time": round(took / promise.seconds, 3),
            "speed": round(speed, 3),
        }


#: Line of the summary -> (kind of target, what was reached of it).
_SUMMED = {
    "*Target Error*": ("error", lambda row: row["of_target"]),
    "*Time Budget*": ("time", lambda row: row["of_target"]),
    "the same, at the speed that was measured": ("time", lambda row: row["of_target"] / row["speed"]),
}


def made(rows: list[dict]) -> dict[str, Table]:
    lines = []
    for what, (kind, reached) in _SUMMED.items():
        ratios = [reached(row) for row in rows if row["of"] == kind]
        if ratios:
            within = (f"{sum(ratio <= limit for ratio in ratios) / len(ratios):.0%}" for limit in (1.15, 1.3))
            lines.append([what, str(len(ratios)), *within, f"{max(ratios):.2f}"])
    if rows:
        speeds = [row["speed"] for row in rows]
        lines.append(["how much slower the machine became", str(len(speeds)), "", "", f"{max(speeds):.2f}"])
    columns = ["", "promises", "kept within 15 %", "within 30 %", "worst, of the target"]
    return {"promises": Table("Promises of scenes that nothing was learned from:", columns, lines)}
