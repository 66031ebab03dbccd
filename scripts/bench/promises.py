# SPDX-License-Identifier: GPL-3.0-or-later
"""How well a target error and a time budget are kept, in scenes from which nothing was learned before.

Each scene is measured as the first frame of a render is: a few choices beside exact pictures of eight. Then the choice
for each target is drawn. Its error is that beside exact pictures of 64, its time the median of the turns, in processor
seconds, which other load lengthens least. *Of target* is either divided by the target where one was promised; *of
expected* by what was expected. Targets are multiples of the closest and the fastest that was measured.
"""

from __future__ import annotations

import statistics
from dataclasses import replace
from time import process_time

from bench.trade.cases import CASES, View
from splat_addon.reference import scenes
from splat_addon.rendering import Light, Renderer, Settings, open_device
from splat_addon.trade import ExactPictures, Target, chosen, measure, quick_choices
from splat_addon.trade.measuring import row_of

DEVICES = ("standalone",)
QUICK = {"size": 48, "turns": 1, "scenes": ["torus"]}
ERRORS, TIMES = (1.2, 2.0, 4.0), (1.5, 3.0, 8.0)
LEARNT = 8


def arguments(parser) -> None:
    parser.add_argument("--size", type=int, default=160, help="pixels along each side")
    parser.add_argument("--scenes", nargs="+", default=None, metavar="NAME", help="some of the trade's scenes")


def run(options, report) -> None:
    renderer = Renderer(open_device(options.device))
    report.header(renderer.device, f"{options.size} x {options.size} pixels, medians of {options.turns} turns")
    kept = []

    def lines():
        for name, scene, camera, settings in shots(options):
            for line, ratio in promises(renderer, scene, camera, settings, options.turns):
                kept.append(ratio)
                yield [name, *line]

    report.table(["scene", "target", "chosen", "of target", "of expected error", "of expected time"], lines())
    within = {limit: sum(ratio <= limit for ratio in kept) / len(kept) for limit in (1.15, 1.3)}
    report.say(
        f"{len(kept)} promises: {within[1.15]:.0%} within 15 %, {within[1.3]:.0%} within 30 % of the target; the worst "
        f"is at {max(kept):.2f} times its target."
    )


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
    few = ExactPictures.drawn(renderer, scene, camera, settings, LEARNT)
    rows = list(measure(renderer, scene, camera, settings, quick_choices(), few, turns, clock=process_time))
    truth = ExactPictures.drawn(renderer, scene, camera, settings, 64)
    closest, fastest = min(row.flip for row in rows), min(row.seconds for row in rows)
    targets = [Target(flip=closest * factor) for factor in ERRORS] + [Target(seconds=fastest * f) for f in TIMES]
    for target in targets:
        promise = chosen(rows, target)
        if not promise.is_kept:
            continue
        wanted, times = promise.choice.of(settings), []
        for _ in range(turns + 1):
            started = process_time()
            frame = renderer.render(scene, camera, wanted, is_repeatable=True)
            times.append(process_time() - started)
        took, flip = statistics.median(times[1:]), row_of(promise.choice, frame, truth, times).flip
        ratio = flip / target.flip if target.seconds is None else took / target.seconds
        aim = f"FLIP {target.flip:.4f}" if target.seconds is None else f"{target.seconds:.2g} s"
        of_expected = f"{flip / promise.flip:.2f}", f"{took / promise.seconds:.2f}"
        yield [aim, promise.choice.name, f"{ratio:.2f}", *of_expected], ratio
