# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures at the numerical extremes, for every method: numbers and plots.

Scenes are 64 x 64 pixels with 2 x 2 samples; the reference is `render_exact` with the same samples, PSNR is measured in
sRGB, and 160 dB means equal. A method that filters cannot match that reference: for it, a level line shows that the
extreme has no effect. An empty pixel, a cross in the plots, is fully covered in the reference and not at all by the
method.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from contextlib import ExitStack
from dataclasses import dataclass, field, replace
from functools import partial
from importlib import import_module
from unittest.mock import patch

import matplotlib
import numpy as np

matplotlib.use("Agg")
from matplotlib import pyplot

from bench.numerics import sweeps
from bench.trade.plots import COLORS
from measuring.drawing import holes
from splat_addon.reference import render_exact
from splat_addon.reference.metrics import psnr
from splat_addon.rendering import Renderer, Settings, open_device
from splat_addon.rendering.methods import METHODS

DEVICES = ("standalone",)
QUICK = {"only": "layers", "shots": 1}
SAMPLES = 2
EQUAL = 160.0
DEPTH_FORMAT = import_module("splat_addon.rendering.passes.decisions")


@dataclass(frozen=True)
class Panel:
    """One plot.

    name: title of its column. x: label of the axis. shots: what is rendered, the same for every method.
    least: the bound for Quads in tests/extremes.
    against: "truth", or "itself" to compare with the first shot.
    is_log: logarithmic x axis.
    limits: constants of the plan that are changed, to show what they protect against.
    """

    name: str
    x: str
    shots: Callable[[], sweeps.Shots]
    least: float
    against: str = "truth"
    is_log: bool = True
    limits: Mapping[str, float] = field(default_factory=dict)


HARDWARE_DEPTH = {"MAX_HARDWARE_DEPTH_RATIO": math.inf, "MAX_HARDWARE_DEPTH_RADIUS": math.inf}

#: file -> its panels
FIGURES = {
    "invariance": (
        Panel("scale", "scale of the world", sweeps.scale, 60, "itself"),
        Panel("offset", "distance from the world's origin, in torus radii", sweeps.offset, 60, "itself"),
    ),
    "depth": (
        Panel("near", "near plane, something right behind it", sweeps.near, 60),
        Panel("near, hardware depth", "the same with the hardware's depth", sweeps.near, 60, limits=HARDWARE_DEPTH),
        Panel("parallel span", "parallel camera: distance of the farthest", sweeps.span, 60),
    ),
    "grazing": (
        Panel("grazing", "degrees left to edge-on", sweeps.grazing, 50),
        Panel("floor", "height of the eye above a floor", sweeps.floor, 50),
    ),
    "views": (
        Panel("field of view", "field of view, degrees", sweeps.field_of_view, 50, is_log=False),
        Panel("off axis", "window off the axis, picture widths", sweeps.off_axis, 50),
    ),
    "sizes": (
        Panel("giants", "radius of one splat, near distances", sweeps.giants, 50),
        Panel("ratio", "length of ellipses over their width", sweeps.ratio, 50),
        Panel("sub-pixel", "radius in pixels of 100,000 on a pixel", sweeps.sub_pixel, 50),
    ),
    "sums": (
        Panel("overdraw", "splats over every sample, float32 sums", sweeps.overdraw, 80),
        Panel("overdraw, float16", "the same, float16 sums", partial(sweeps.overdraw, sum_format="float16"), 0),
    ),
    "layers": (
        Panel("epsilon", "epsilon, radii", sweeps.epsilon, 40),
        Panel("gap", "gap between two sheets, radii", sweeps.gap, 50),
    ),
}


def measure(panel: Panel, renderers: dict, most: int) -> dict[str, list[dict]]:
    """method -> results for each of the first `most` values of x: PSNR, empty pixels, non-finite numbers."""
    results, firsts = {method: [] for method in METHODS}, {}
    with ExitStack() as changed:
        for name, value in panel.limits.items():
            changed.enter_context(patch.object(DEPTH_FORMAT, name, value))
        for x, scene, camera, changes in list(panel.shots())[:most]:
            settings, truth = Settings(supersampling=SAMPLES, detail_tolerance=0.0, **changes), None
            if panel.against == "truth":
                truth = render_exact(scene, camera, replace(settings, supersampling=1), samples=SAMPLES)
            for method in METHODS:
                frame = renderers[method].render(scene, camera, replace(settings, method=method))
                known = truth or firsts.setdefault(method, frame)
                not_finite = sum(np.count_nonzero(~np.isfinite(a)) for a in (frame.color, frame.depth, frame.normal))
                decibels = min(psnr(frame.color, known.color), EQUAL)
                found = {"x": x, "dB": decibels, "empty": holes(frame, known), "NaN": int(not_finite)}
                results[method].append({"panel": panel.name, "method": method, **found})
    return {method: sorted(found, key=lambda f: f["x"]) for method, found in results.items()}


def plot_panels(panels: tuple[Panel, ...], results: dict):
    """Panels side by side, with one line per method; crosses mark empty pixels."""
    size = (4.5 * len(panels) + 1.8, 3)
    figure, axes = pyplot.subplots(1, len(panels), figsize=size, sharey=True, layout="constrained")
    for axis, panel in zip(axes, panels):
        for method, found in results[panel.name].items():
            x, y = [f["x"] for f in found], [f["dB"] for f in found]
            axis.plot(x, y, marker="o", markersize=3, label=method, color=COLORS[method])
            y = [f["dB"] if f["empty"] else math.nan for f in found]
            axis.plot(x, y, "x", color=COLORS[method], markersize=8)
        if panel.least:
            axis.axhline(panel.least, color="gray", linestyle="--", linewidth=1, label="quads, held by tests")
        axis.set(xscale="log" if panel.is_log else "linear", xlabel=panel.x, ylim=(0, EQUAL + 10))
        axis.grid(alpha=0.3)
    axes[0].set_ylabel("PSNR, dB")
    # Beside the panels, because inside one it would hide lines.
    known = {label: handle for axis in axes for handle, label in zip(*axis.get_legend_handles_labels())}
    figure.legend(known.values(), known, loc="outside right center", fontsize=8)
    return figure


def cell(found: list[dict]) -> str:
    """The lowest PSNR, and if there are any, the numbers of empty pixels and non-finite values in all shots."""
    counts = {name: sum(f[name] for f in found) for name in ("empty", "NaN")}
    least = f"{min(f['dB'] for f in found):.0f}"
    return ", ".join([least, *(f"{count} {name}" for name, count in counts.items() if count)])


def arguments(parser) -> None:
    parser.add_argument("--only", choices=FIGURES, help="one figure")
    parser.add_argument("--shots", type=int, help="of each panel, the first ones only")


def run(options, report) -> None:
    device = open_device(options.device)
    report.header(device)
    figures = {name: panels for name, panels in FIGURES.items() if options.only in (None, name)}
    renderers, every = {method: Renderer(device) for method in METHODS}, []

    def rows():
        for name, panels in figures.items():
            results = {}
            for panel in report.steps(panels, name):
                results[panel.name] = measure(panel, renderers, options.shots)
                every.extend(found for method in METHODS for found in results[panel.name][method])
                yield panel.name, *map(cell, results[panel.name].values())
            report.plot(name, plot_panels(panels, results))
            report.csv("numerics", every)

    report.table(["least dB", *METHODS], rows())
