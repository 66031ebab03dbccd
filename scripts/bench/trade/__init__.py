# SPDX-License-Identifier: GPL-3.0-or-later
"""The trade of speed for accuracy: scenes x methods x settings, each compared with an exact picture.

Parts: `methods` beside float64 rays; `numbers` (tolerance of levels, shadow resolution, layers, storage, sums), each
changed alone; `densities` and reductions beside the mesh; `stability`, how much pictures flicker; `passes`, where the
time goes. PSNR is measured in sRGB; the pixel filters are the Gaussian of sigma 0.7071 pixels and the box. A ratio of
times is the median over the turns of a choice's time divided by the yardstick's in the same turn. `to_float32`: PSNR
relative to the same choice without 16-bit formats. A quick run draws one scene of each part, small.
"""

from __future__ import annotations

import math
from dataclasses import replace
from functools import partial
from statistics import geometric_mean

import numpy as np

from bench.trade import densities, numbers, stability
from bench.trade.cases import CASES, FULL, View
from bench.trade.choices import CHOICES, METHODS_ALONE, YARDSTICK, choices, columns, label
from bench.trade.plots import SHOWN, by_scene, frontier, pictured, plot_differences, plot_frontier
from environment import Problem
from measuring.drawing import draw_in_turn, holes
from splat_addon.reference import render_exact
from splat_addon.reference.filters import PIXEL_FILTERS
from splat_addon.reference.kept import remembered
from splat_addon.reference.metrics import mean_flip, psnr
from splat_addon.rendering import PRESETS, Renderer, Settings, open_device

DEVICES = ("standalone", "blender")
QUICK = {"size": FULL // 8, "turns": 2, "samples": 3, "choices": "methods"}


def arguments(parser) -> None:
    parser.add_argument("--parts", nargs="+", choices=PARTS, default=list(PARTS), help="what to measure")
    parser.add_argument("--scenes", nargs="+", choices=CASES, metavar="NAME", help=f"some of: {', '.join(CASES)}")
    parser.add_argument("--choices", choices=CHOICES, default="page", help="the settings that each is drawn with")
    parser.add_argument("--size", type=int, default=FULL, help="pixels along each side; splats keep theirs")
    parser.add_argument("--samples", type=int, default=8, help="N of the truth's N x N samples a pixel; of no choice")


def run(options, report) -> None:
    renderer = Renderer(open_device(options.device))
    truth = f"truth of {options.samples} x {options.samples} samples"
    report.header(renderer.device, f"{options.size} x {options.size} pixels, medians of {options.turns} turns, {truth}")
    for part in options.parts:
        PARTS[part](renderer, options, report)


def run_methods(renderer: Renderer, options, report) -> None:
    names = options.scenes or [c.name for c in CASES.values() if c.is_promised or not options.quick]
    names = names[: 1 if options.quick and not options.scenes else None]
    chosen = choices(options.choices, renderer.device.multisample_counts)
    rows, skipped, shown = [], {}, {}
    for name in names:
        try:
            rows += measure(CASES[name], renderer, chosen, options, report, shown)
        except FileNotFoundError as error:
            skipped[name] = str(error)
            report.say(f"**Skipped: {name}**. {error}.")
            continue
        report.csv("trade", rows)
        report.plot("frontier", plot_frontier([row for row in rows if CASES[row["scene"]].is_promised] or rows))
        if shown:
            report.plot("differences", plot_differences(shown))
    if not rows:
        raise Problem(f"Nothing was measured. {'; '.join(skipped.values())}.")
    promised = [row for row in rows if CASES[row["scene"]].is_promised]
    others = [row for row in rows if not CASES[row["scene"]].is_promised]
    for name in PIXEL_FILTERS:
        about = f"PSNR in dB / mean FLIP under the {name} pixel filter; times are in that of {label(YARDSTICK)}:"
        for some in filter(None, (promised, others)):
            report.table([f"{name.title()} pixel", *by_scene(some), "time"], summary(some, chosen, name), about)
    errors = [f"flip_{name}" for name in PIXEL_FILTERS]
    best = {error: {id(r) for mine in by_scene(rows).values() for r in frontier(mine, error)} for error in errors}
    lines = [[*row.values(), *("*" if id(row) in best[error] else "" for error in errors)] for row in rows]
    report.table([*rows[0], *errors], lines, "Every row; * is on the frontier of this FLIP and time:")


def run_numbers(renderer: Renderer, options, report) -> None:
    about = "Settings changed alone, beside Balanced with four samples; times are in that of the first row of a scene:"
    report.table(numbers.HEAD, numbers.number_lines(renderer, options), about)


def run_densities(renderer: Renderer, options, report) -> None:
    rows = []
    for row in densities.measure_densities(renderer, options, report):
        rows.append(row)
        report.csv("densities", rows)
    if not rows:
        return
    about = "Balanced (16 samples) under the Gaussian, Final under the box: FLIP, mean over the models (worst)"
    report.table(["pixels a surfel", *densities.HEAD], densities.density_lines(rows), f"{about}, by density:")
    report.table(["reduction", *densities.HEAD], densities.reduction_lines(rows), f"{about}, at 0.75 pixels a surfel:")


def run_stability(renderer: Renderer, options, report) -> None:
    about = "Flicker in code values, over 16 shifts within a pixel, and 16 pictures of a camera that turns:"
    report.table(["", *stability.heads(options)], stability.stability_lines(renderer, options), about)


def run_passes(renderer: Renderer, options, report) -> None:
    about = "Tori in the sun, one sample: milliseconds of all passes, and the share of each:"
    report.table(["preset", "ms", "passes"], numbers.pass_lines(renderer, options), about)


PARTS = {
    "densities": run_densities,
    "numbers": run_numbers,
    "stability": run_stability,
    "passes": run_passes,
    "methods": run_methods,
}


def measure(case, renderer: Renderer, chosen: list[Settings], options, report, shown: dict) -> list[dict]:
    """The rows of one scene. Other poses than the promised are drawn with the methods alone, in one turn. shown: gets
    the pictures of the scenes that are pictured."""
    if not case.is_promised:
        chosen = [settings for settings in chosen if settings in METHODS_ALONE]
    turns = options.turns if case.is_promised else 1
    scene, camera = case.build(View(options.size, options.models))
    lit = replace(YARDSTICK, shading=case.shading)
    truth = partial(remembered(render_exact), scene, camera, lit, samples=options.samples)
    exact = {name: truth(pixel_filter=name) for name in PIXEL_FILTERS}

    def draw(settings):
        return renderer.render(scene, camera, replace(settings, shading=case.shading))

    drawn = draw_in_turn(draw, chosen, turns, steps=lambda turns: report.steps(turns, case.name))
    rows = []
    for settings in chosen:
        times = {"ratio": (drawn.ratio(settings, YARDSTICK), 2), "ms": (drawn.spread(settings), 1)}
        rows.append({"scene": case.name, **columns(settings), **accuracy(drawn.results[settings], exact)})
        whole = drawn.results.get(replace(settings, storage="float32", sum_format="float32"))
        to_float32 = psnr(drawn.results[settings].color, whole.color) if whole else math.inf
        rows[-1]["to_float32"] = "" if math.isinf(to_float32) else round(to_float32, 1)
        for name, (spread, digits) in times.items():
            ends = ((name, spread.median), (f"{name}_min", spread.least), (f"{name}_max", spread.most))
            rows[-1] |= {key: round(value, digits) for key, value in ends}
    if case.name in SHOWN:
        colors = {settings: frame.color for settings, frame in drawn.results.items()}
        shown[case.name] = pictured(colors, exact["gaussian"].color)
    return rows


def accuracy(frame, exact: dict) -> dict:
    """Columns of a row: PSNR in sRGB and mean FLIP under each filter, holes, and non-finite pixels."""
    row = {}
    for name, truth in exact.items():
        row[f"psnr_{name}"] = round(psnr(frame.color, truth.color), 2)
        row[f"flip_{name}"] = round(mean_flip(frame.color, truth.color), 4)
    not_finite = int(np.count_nonzero(~np.isfinite(frame.color).all(axis=2)))
    return {**row, "holes": holes(frame, exact["box"]), "non_finite": not_finite}


def summary(rows: list[dict], chosen: list[Settings], name: str):
    """One line per choice: the geometric mean of its times over the scenes, and their range."""
    for settings in chosen:
        wanted = columns(settings).items()
        mine = [row for row in rows if wanted <= row.items()]
        if not mine:
            continue
        ratios = [row["ratio"] for row in mine]
        time = f"{geometric_mean(ratios):.1f} ({min(ratios):.1f} to {max(ratios):.1f})"
        of_all = {p.label: replace(p.of(YARDSTICK), detail_tolerance=0.0) for p in PRESETS.values()}
        preset = next((f" (**{preset}**)" for preset, values in of_all.items() if values == settings), "")
        cells = (f"{row[f'psnr_{name}']:.1f} / {row[f'flip_{name}']:.3f}" for row in mine)
        yield [label(settings) + preset, *cells, time]
