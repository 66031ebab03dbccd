# SPDX-License-Identifier: GPL-3.0-or-later
"""Plots FLIP against time, one panel per scene: lower left is better, and the line is the Pareto frontier. Also draws
the reference beside some choices, with the FLIP map under each."""

from __future__ import annotations

import matplotlib
import numpy as np

matplotlib.use("Agg")
from matplotlib import pyplot, ticker

from bench.trade.choices import FORMATS, PICTURED, label
from splat_addon.reference.metrics import flip_map, mean_flip, srgb
from splat_addon.rendering.methods import METHODS

COLORS = dict(zip(METHODS, pyplot.cm.tab10.colors))


def by_scene(rows: list[dict]) -> dict[str, list[dict]]:
    return {scene: [row for row in rows if row["scene"] == scene] for scene in dict.fromkeys(r["scene"] for r in rows)}


def frontier(rows: list[dict], error: str = "flip_gaussian", cost: str = "ratio") -> list[dict]:
    """The rows of a scene that no other row beats in both time and FLIP, fastest first; of equal rows the first."""
    kept = []
    for row in sorted(rows, key=lambda row: (row[cost], row[error])):
        if not kept or row[error] < kept[-1][error]:
            kept.append(row)
    return kept


def plot_overview(rows: list[dict]):
    """All scenes under the Gaussian, with times relative to the yardstick."""
    scenes = by_scene(rows)
    across = min(len(scenes), 3)
    down = -(-len(scenes) // across)
    size = (3.2 * across, 2.5 * down)
    figure, axes = pyplot.subplots(down, across, figsize=size, layout="constrained", squeeze=False)
    for axis in axes.flat[len(scenes) :]:
        axis.set_visible(False)
    for axis, (scene, mine) in zip(axes.flat, scenes.items()):
        _panel(axis, mine, "flip_gaussian", "ratio")
        axis.set_title(scene, fontsize=9)
        axis.tick_params(labelsize=7, which="both")
    # Beside the panels, because inside one it would hide points.
    figure.legend(*axes.flat[0].get_legend_handles_labels(), loc="outside upper center", ncols=8, fontsize=6)
    figure.supxlabel("time in that of quads with one sample", fontsize=9)
    figure.supylabel("mean FLIP, Gaussian filter", fontsize=9)
    return figure


def _panel(axis, rows: list[dict], error: str, cost: str) -> None:
    best = frontier(rows, error, cost)
    axis.step([r[cost] for r in best], [r[error] for r in best], color="0.7", where="post", zorder=0)
    for method, color in COLORS.items():
        mine = [row for row in rows if row["method"] == method]
        if not mine:
            continue
        plain = (all(row[name] == next(iter(values)) for name, values in FORMATS.items()) for row in mine)
        faces = [color if is_plain else "white" for is_plain in plain]
        x, y = [row[cost] for row in mine], [row[error] for row in mine]
        axis.scatter(x, y, c=faces, edgecolors=[color] * len(mine), s=22, label=METHODS[method].label)
        for row, place in zip(mine, zip(x, y)):
            axis.annotate(row["samples"][0], place, fontsize=6, xytext=(3, 2), textcoords="offset points")
    axis.set(xscale="log", yscale="log")
    for side in (axis.xaxis, axis.yaxis):
        side.set_major_locator(ticker.LogLocator(subs=(1, 2, 5)))
        side.set_major_formatter("{x:g}")
        side.set_minor_formatter(ticker.NullFormatter())
    axis.grid(alpha=0.3)


def draw_differences(name: str, frames: dict, truth, report) -> None:
    """The reference, then one column for each chosen frame, with its FLIP map below."""
    shown = {label(settings): frame.color[..., :3] for settings, frame in frames.items() if settings in PICTURED}
    truth = truth.color[..., :3]
    labels = (f"{label} {mean_flip(color, truth):.4f}" for label, color in shown.items())
    report.say(f"{name}, FLIP under the Gaussian: {'; '.join(labels)}.")
    above = [srgb(np.nan_to_num(color)) for color in (truth, *shown.values())]
    below = [flip_map(color, truth) for color in (truth, *shown.values())]
    report.picture(f"{name}-differences", above + below, columns=len(above), encode=None)
