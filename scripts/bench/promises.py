# SPDX-License-Identifier: GPL-3.0-or-later
"""How well a target error and a time budget are kept, in scenes from which nothing was learned before.

Each scene is measured as the first frame of a render is: a few choices, and single other settings, beside exact
pictures of eight. Then the choice for each target is drawn. Its error is that beside exact pictures of 64, its time the
median of the turns, in processor seconds, which other load lengthens least. *Of target* is either divided by the target
where one was promised; *of expected* by what was expected. Targets are multiples of the closest and the fastest that
was measured. *Speed* is the time of the fastest choice in the same turns, divided by that when the scene was measured:
how much slower the machine has become.
"""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from operator import attrgetter
from time import process_time

from bench.trade.cases import CASES, View
from measuring.timing import in_turn, processor
from splat_addon.reference import scenes
from splat_addon.rendering import Light, Renderer, Settings, open_device
from splat_addon.trade import ExactPictures, Survey, Target
from splat_addon.trade.measuring import row_of

DEVICES = ("standalone",)
QUICK = {"size": 48, "turns": 1, "scenes": ["torus"]}
ERRORS, TIMES = (1.2, 2.0, 4.0), (1.5, 3.0, 8.0)


def arguments(parser) -> None:
    parser.add_argument("--size", type=int, default=160, help="pixels along each side")
    parser.add_argument("--scenes", nargs="+", default=None, metavar="NAME", help="some of the trade's scenes")


def run(options, report) -> None:
    renderer = Renderer(open_device(options.device))
    report.header(renderer.device, f"{options.size} x {options.size} pixels, medians of {options.turns} turns")
    kept = {"errors": [], "times": [], "times at the speed that was measured": []}

    def lines():
        for name, scene, camera, settings in shots(options):
            for line, ratios in promises(renderer, scene, camera, settings, options.turns):
                for what, ratio in ratios.items():
                    kept[what].append(ratio)
                yield [name, *line]

    report.table(["scene", "target", "chosen", "of target", "of expected error", "of expected time", "speed"], lines())
    columns = "", "promises", "kept within 15 %", "within 30 %", "worst, of the target"
    report.table(columns, (summary(what, ratios) for what, ratios in kept.items() if ratios))


def summary(what: str, ratios: list[float]) -> list[str]:
    within = (f"{sum(ratio <= limit for ratio in ratios) / len(ratios):.0%}" for limit in (1.15, 1.3))
    return [what, str(len(ratios)), *within, f"{max(ratios):.2f}"]


def shots(options):
    """(name, scene, camera, settings): each scene flat, and lit by a sun whose shadows it has."""
    sun = Light("sun", direction=(0.4, 0.3, -1.0), energy=3.0, casts_shadow=True)
    for name in options.scenes or CASES:
        try:
            scene, camera = CASES[name].build(View(options.size, options.models))
        except FileNotFoundError:
            continue
        yield name, scene, camera, Settings(shading="flat", outputs=("color",))
        lit = replace(scene, lights=(sun,), world=(0.3, 0.35, 0.4))
        yield f"{name}, lit", lit, camera, Settings(outputs=("color",), ambient_occlusion=float("inf"))
    if not options.scenes:
        scene, camera = scenes.transparent_spheres(size=(options.size, options.size))
        yield "transparent spheres", scene, camera, Settings(outputs=("color",))


def promises(renderer, scene, camera, settings, turns: int):
    """(cells, what was reached divided by the target) of each target that could be promised."""
    survey = Survey(renderer, scene, camera, settings, turns=turns, clock=process_time)
    truth = ExactPictures.drawn(renderer, scene, camera, settings, 64)
    closest, fastest = (min(survey.rows, key=attrgetter(of)) for of in ("flip", "seconds"))
    targets = [Target(flip=closest.flip * factor) for factor in ERRORS]
    targets += [Target(seconds=fastest.seconds * factor) for factor in TIMES]
    for target in targets:
        promise = survey.promise(target)
        if not promise.is_kept:
            continue
        jobs = {
            choice: partial(renderer.render, scene, camera, choice.of(settings), is_repeatable=True)
            for choice in (promise.choice, fastest.choice)
        }
        drawn = in_turn(jobs, turns, processor)
        took, speed = drawn.spread(promise.choice).median, drawn.spread(fastest.choice).median / fastest.seconds
        flip = row_of(promise.choice, drawn.results[promise.choice], truth, [took]).flip
        if target.seconds is None:
            aim, ratios = f"FLIP {target.flip:.4f}", {"errors": flip / target.flip}
        else:
            of_target = took / target.seconds
            aim = f"{target.seconds:.2g} s"
            ratios = {"times": of_target, "times at the speed that was measured": of_target / speed}
        numbers = next(iter(ratios.values())), flip / promise.flip, took / promise.seconds, speed
        yield [aim, promise.choice.name, *(f"{number:.2f}" for number in numbers)], ratios
