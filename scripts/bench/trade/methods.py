# SPDX-License-Identifier: GPL-3.0-or-later
"""Methods, samples and formats in each scene, beside the picture of float64 rays."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import partial
from statistics import geometric_mean

import numpy as np

from bench.trade.cases import CASES, View
from bench.trade.choices import FORMATTED, METHODS_ALONE, OF_PAGE, PICTURED, YARDSTICK, choices, columns, label, of_case
from bench.trade.plots import SHOWN, by_scene, pictured, plot_differences, plot_frontier
from measuring.drawing import holes
from measuring.report import Table
from measuring.timing import both, in_pairs, noise
from splat_addon.reference import render_exact
from splat_addon.reference.filters import PIXEL_FILTERS
from splat_addon.reference.kept import remembered
from splat_addon.reference.metrics import mean_flip, psnr
from splat_addon.rendering import PRESETS, Renderer, Settings
from splat_addon.rendering.methods import METHODS

#: What stands for a coarser truth in the column of methods: how far it is off tells how far the truth has converged.
_COARSER = "truth of fewer rays"

#: Lines of the page's table of samples.
_SAMPLES = "checker", "torus"


def units(renderer: Renderer, options, report) -> dict[str, Callable[[], list[dict]]]:
    names = options.scenes or [c.name for c in CASES.values() if c.is_promised or not options.quick]
    names = names[: 1 if options.quick and not options.scenes else None]
    return {name: partial(measure, CASES[name], renderer, options, report) for name in names}


def measure(case, renderer: Renderer, options, report) -> list[dict]:
    """The rows of one scene. Other poses than the promised take the least turns."""
    scene, camera = case.build(View(options.size, options.models))
    exact = truth(case, scene, camera, options)
    chosen = of_case(case, options.choices, renderer.device.multisample_counts)

    def draw(settings):
        return renderer.render(scene, camera, replace(settings, shading=case.shading))

    jobs = {settings: partial(draw, settings) for settings in chosen}
    seconds = options.seconds if case.is_promised else 0.0
    steps = partial(report.steps, doing=case.name)
    drawn = dict(in_pairs(jobs, jobs[YARDSTICK], options.turns, seconds, both, steps))
    rows = [_coarser(case, scene, camera, options, exact)]
    for settings, pairs in drawn.items():
        rows.append({"scene": case.name, **columns(settings), **accuracy(pairs.result, exact)})
        whole = drawn.get(replace(settings, storage="float32", sum_format="float32"))
        to_float32 = psnr(pairs.result.color, whole.result.color) if whole else math.inf
        rows[-1]["to_float32"] = "" if math.isinf(to_float32) else round(to_float32, 1)
        stats = pairs.result.stats
        rows[-1] |= {"splats": stats["splats_drawn"], "bytes": stats["texture_bytes"], **times(pairs, renderer.device)}
    return rows


def truth(case, scene, camera, options) -> dict:
    """Filter -> the frame of float64 rays."""
    lit = replace(YARDSTICK, shading=case.shading)
    rays = partial(remembered(render_exact), scene, camera, lit, samples=options.samples)
    return {name: rays(pixel_filter=name) for name in PIXEL_FILTERS}


def _coarser(case, scene, camera, options, exact: dict) -> dict:
    """The row of a truth of 5 / 8 of the rays along each side of a pixel, without times."""
    fewer = max(options.samples * 5 // 8, 1)
    coarse, row = truth(case, scene, camera, _with(options, samples=fewer)), {"scene": case.name}
    row |= {**columns(YARDSTICK), "method": _COARSER, "samples": f"{fewer} x {fewer}"}
    for name, frame in exact.items():
        row[f"psnr_{name}"] = round(psnr(coarse[name].color, frame.color), 2)
        row[f"flip_{name}"] = round(mean_flip(coarse[name].color, frame.color), 4)
    return row


def _with(options, **values):
    return type(options)(**{**vars(options), **values})


def times(pairs, device) -> dict:
    """Columns of a row. On a software device ratios are of processor time, which other load lengthens least, else of
    that on the clock."""
    clock = (lambda value: value[1]) if "llvmpipe" in device.renderer else (lambda value: value[0])
    ratios, on_clock = pairs.ratios(clock), pairs.own(lambda value: 1e3 * value[0])
    own = pairs.own(clock)
    unit_least = min(clock(unit) for _, unit in pairs.values)
    return {
        "ratio": round(float(np.median(ratios)), 3), "ratio_noise": round(noise(ratios), 3),
        "ratio_min": round(min(ratios), 3), "ratio_max": round(max(ratios), 3),
        "ratio_of_least": round(own.least / unit_least, 3), "turns": len(ratios),
        "ms": round(on_clock.median, 1), "ms_min": round(on_clock.least, 1), "ms_max": round(on_clock.most, 1),
    }  # fmt: skip


def accuracy(frame, exact: dict) -> dict:
    """Columns of a row: PSNR in sRGB and mean FLIP under each filter, holes, and non-finite pixels."""
    row = {}
    for name, beside in exact.items():
        row[f"psnr_{name}"] = round(psnr(frame.color, beside.color), 2)
        row[f"flip_{name}"] = round(mean_flip(frame.color, beside.color), 4)
    not_finite = int(np.count_nonzero(~np.isfinite(frame.color).all(axis=2)))
    return {**row, "holes": holes(frame, exact["box"]), "non_finite": not_finite}


def made(rows: list[dict]) -> dict[str, Table | str]:
    """The tables of the pages, and what they say in a line."""
    found = dict(_of_filters(rows))
    found["other poses"] = _poses(rows)
    found["methods"] = _methods(rows)
    found["time of the Mip Filter"] = _mip(rows)
    found["samples"] = _samples(rows)
    found["formats"] = _formats(rows)
    found["layers"] = _layers(rows)
    for preset in PRESETS.values():
        found[f"time of {preset.label}"] = f"{_mean(_rows_of(_promised(rows), _as_choice(preset))):.1f}"
    return found


def _promised(rows: list[dict]) -> list[dict]:
    return [row for row in rows if CASES[row["scene"]].is_promised]


def _rows_of(rows: list[dict], settings: Settings) -> list[dict]:
    wanted = columns(settings).items()
    return [row for row in rows if wanted <= row.items()]


def _mean(rows: list[dict]) -> float:
    return geometric_mean(row["ratio"] for row in rows) if rows else math.nan


def _as_choice(preset) -> Settings:
    return replace(preset.of(YARDSTICK), detail_tolerance=0.0)


def _of_filters(rows: list[dict]) -> Iterator[tuple[str, Table]]:
    """A table for each pixel filter: a line for each choice that all promised scenes have."""
    mine = _promised(rows)
    for name in PIXEL_FILTERS:
        about = f"PSNR in dB / mean FLIP under the {name} pixel filter; times are in that of {label(YARDSTICK)}:"
        columns = [f"{name.title()} pixel", *by_scene(mine), "time"]
        yield f"{name} pixel", Table(about, columns, list(summary(mine, name)))


def summary(rows: list[dict], name: str) -> Iterator[list[str]]:
    """One line per choice: the geometric mean of its times over the scenes with their noise, and their range."""
    scenes, chosen = by_scene(rows), choices("page", (4,))
    for settings in chosen:
        mine = _rows_of(rows, settings)
        if not mine or len(mine) < len(scenes):
            continue
        ratios = [row["ratio"] for row in mine]
        # of independent scenes
        spread = math.sqrt(sum((row["ratio_noise"] / row["ratio"]) ** 2 for row in mine)) / len(mine) * _mean(mine)
        time = f"{_mean(mine):.2f} ± {spread:.2f} ({min(ratios):.1f} to {max(ratios):.1f})"
        yield [_named(settings), *(_cell(row, name) for row in mine), time]
    coarse = [row for row in rows if row["method"] == _COARSER]
    if coarse:
        yield [_coarse_name(coarse[0]), *(_cell(row, name) for row in coarse), ""]


def _coarse_name(row: dict) -> str:
    return f"the truth, of {row['samples']} rays"


def _cell(row: dict, name: str) -> str:
    return f"{row[f'psnr_{name}']:.1f} / {row[f'flip_{name}']:.3f}"


def _named(settings: Settings) -> str:
    """Its label, bold with the preset whose choice it is."""
    presets = {_as_choice(preset): preset.label for preset in PRESETS.values()}
    return f"**{label(settings)}** ({presets[settings]})" if settings in presets else label(settings)


def _poses(rows: list[dict]) -> Table:
    """The other scenes under the Gaussian."""
    scenes = by_scene([row for row in rows if not CASES[row["scene"]].is_promised])
    scenes = {name: mine for name, mine in scenes.items() if all(_rows_of(mine, each) for each in METHODS_ALONE)}
    lines = [
        [label(settings), *(_cell(row, "gaussian") for mine in scenes.values() for row in _rows_of(mine, settings))]
        for settings in METHODS_ALONE
    ]
    return Table("Other poses, PSNR in dB / mean FLIP under the Gaussian:", ["method, samples", *scenes], lines)


def _of_scenes(rows: list[dict], names) -> dict[str, list[dict]]:
    return {name: mine for name, mine in by_scene(rows).items() if name in names}


def _methods(rows: list[dict]) -> Table:
    """dB under the Gaussian, holes and time of each method alone, in three scenes."""
    scenes = _of_scenes(rows, ("checker", "torus", "coarse sphere"))
    lines = [
        [
            METHODS[settings.method].label,
            *(
                f"{row['psnr_gaussian']:.1f} dB, {row['holes']}, {row['ratio']:.2f}"
                for mine in scenes.values()
                for row in _rows_of(mine, settings)
            ),
        ]
        for settings in METHODS_ALONE
        if settings.supersampling == 1
    ]
    return Table("PSNR under the Gaussian, holes, time relative to Quads:", ["method", *scenes], lines)


_BESIDE_MIP = "raycast", "homogeneous", "homogeneous_printed"


def _mip(rows: list[dict]) -> Table:
    """The time of the Mip Filter as a multiple of that of the papers' methods."""

    def ratio(mine: list[dict], other: str) -> float:
        return _mean(_rows_of(mine, replace(YARDSTICK, method="mip"))) / _mean(
            _rows_of(mine, replace(YARDSTICK, method=other))
        )

    scenes = by_scene(_promised(rows))
    lines = [[scene, *(f"{ratio(mine, other):.2f}" for other in _BESIDE_MIP)] for scene, mine in scenes.items()]
    lines += [["all", *(f"{ratio(_promised(rows), other):.2f}" for other in _BESIDE_MIP)]] if len(scenes) > 1 else []
    about = "Time of the Mip Filter as a multiple of other methods' with one sample:"
    return Table(about, ["scene", *(METHODS[other].label for other in _BESIDE_MIP)], lines)


def _samples(rows: list[dict]) -> Table:
    """Samples, hardware samples and thresholds of Quads: dB to a box, and time."""
    scenes = _of_scenes(rows, _SAMPLES)
    chosen = [s for s in FORMATTED if s.method == "quad" and s.storage == s.sum_format == "float32"]
    lines = []
    for settings in chosen:
        mine = [row for each in scenes.values() for row in _rows_of(each, settings)]
        if mine:
            cells = (cell for row in mine for cell in (f"{row['psnr_box']:.1f}", _timed(row)))
            lines.append([label(settings).removeprefix("Quads, "), *cells])
    heads = (head for name in scenes for head in (f"{name}, dB to a box", "time"))
    return Table("Quads, dB to a box and time:", ["samples", *heads], lines)


def _timed(row: dict) -> str:
    return f"{row['ratio']:.2f} ± {row['ratio_noise']:.2f}"


def _formats(rows: list[dict]) -> Table:
    """dB from the same choice without 16-bit formats."""
    mine = {name: of for name, of in by_scene(rows).items() if any(row.get("to_float32") for row in of)}
    chosen = [s for s in FORMATTED if (s.storage, s.sum_format) != ("float32", "float32")]
    lines = []
    for settings in chosen:
        found = [row for each in mine.values() for row in _rows_of(each, settings)]
        if found:
            lines.append([label(settings), *(f"{row['to_float32']}, {_timed(row)}" for row in found)])
    return Table("PSNR to float32 in dB, and time:", ["formats", *mine], lines)


def _layers(rows: list[dict]) -> Table:
    """Layers of transparent surfaces: dB under the filter of the method, and time."""
    filters = {"quad": "box", "mip": "gaussian"}
    mine = [row for row in rows if row["scene"] == "transparent spheres" and row["method"] in filters]
    kinds = {(row["layers"], row["blends_rest"]) for row in mine}
    chosen = {name: "2 x 2" if name == "quad" else "1 x 1" for name in filters}
    lines = []
    for layers, blends in sorted(kinds, key=lambda kind: (kind[0], kind[1])):
        line = [f"{layers}, the rest {'blended' if blends else 'lost'}"]
        for method, samples in chosen.items():
            wanted = {"method": method, "samples": samples, "layers": layers, "blends_rest": blends}
            row = next((row for row in mine if wanted.items() <= row.items()), None)
            line += [f"{row[f'psnr_{filters[method]}']:.1f}", _timed(row)] if row else ["", ""]
        lines.append(line)
    columns = ["layers", "Quads, 2 x 2, dB to a box", "time", "Mip Filter, dB to a Gaussian", "time"]
    return Table("Transparent spheres by layers:", columns, lines)


def plots(renderer: Renderer, options, rows: list[dict], report) -> None:
    shown = [columns(settings).items() for settings in OF_PAGE]
    timed = [row for row in rows if "ratio" in row and any(each <= row.items() for each in shown)]
    report.plot("frontier", plot_frontier(_promised(timed) or timed))
    shown = {}
    for name in (name for name in SHOWN if any(row["scene"] == name for row in rows)):
        case = CASES[name]
        scene, camera = case.build(View(options.size, options.models))
        exact = truth(case, scene, camera, options)["gaussian"].color
        wanted = [settings for settings in OF_PAGE if settings in PICTURED]
        drawn = {s: renderer.render(scene, camera, replace(s, shading=case.shading)).color for s in wanted}
        shown[name] = pictured(drawn, exact)
    if shown:
        report.plot("differences", plot_differences(shown))
