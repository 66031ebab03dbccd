# SPDX-License-Identifier: GPL-3.0-or-later
"""FLIP against time, a panel for each scene: what lies towards the lower left is better, the line is the frontier."""

from __future__ import annotations

from pathlib import Path

import matplotlib

matplotlib.use("Agg")
from matplotlib import pyplot, ticker

from splat_addon.rendering.methods import METHODS

from .choices import FORMATS
from .frontier import frontier
from .report import by_scene
from .truth import FILTERS

COLORS = dict(zip(METHODS, pyplot.cm.tab10.colors, strict=False))


def plot_scene(rows: list[dict], path: Path) -> None:
    """One scene: both filters, against milliseconds."""
    figure, axes = pyplot.subplots(1, len(FILTERS), figsize=(9, 4), layout="constrained")
    for axis, name in zip(axes, FILTERS, strict=True):
        _panel(axis, rows, f"flip_{name}", "ms")
        axis.set(title=f"{rows[0]['scene']}, {name} filter", xlabel="ms a frame", ylabel="mean FLIP")
    axes[0].legend(fontsize=7)
    _save(figure, path)


def plot_overview(rows: list[dict], path: Path) -> None:
    """Every scene under the Gaussian, against the yardstick's time."""
    scenes = by_scene(rows)
    across = min(len(scenes), 3)
    down = -(-len(scenes) // across)
    figure, axes = pyplot.subplots(
        down, across, figsize=(3.2 * across, 2.5 * down), layout="constrained", squeeze=False
    )
    for axis in axes.flat[len(scenes) :]:
        axis.set_visible(False)
    for axis, (scene, mine) in zip(axes.flat, scenes.items(), strict=False):
        _panel(axis, mine, "flip_gaussian", "ratio")
        axis.set_title(scene, fontsize=9)
        axis.tick_params(labelsize=7, which="both")
    # Beside the panels: within one it would hide points.
    figure.legend(*axes.flat[0].get_legend_handles_labels(), loc="outside upper center", ncols=8, fontsize=6)
    figure.supxlabel("time in that of quads with one sample", fontsize=9)
    figure.supylabel("mean FLIP, Gaussian filter", fontsize=9)
    _save(figure, path)


def _panel(axis, rows: list[dict], error: str, cost: str) -> None:
    best = frontier(rows, error, cost)
    axis.step([r[cost] for r in best], [r[error] for r in best], color="0.7", where="post", zorder=0)
    for method, color in COLORS.items():
        mine = [row for row in rows if row["method"] == method]
        if not mine:
            continue
        plain = [all(row[name] == next(iter(values)) for name, values in FORMATS.items()) for row in mine]
        faces = [color if is_plain else "white" for is_plain in plain]
        x, y = [row[cost] for row in mine], [row[error] for row in mine]
        axis.scatter(x, y, c=faces, edgecolors=[color] * len(mine), s=22, label=METHODS[method].label)
        for row in mine:
            axis.annotate(
                row["samples"][0], (row[cost], row[error]), fontsize=6, xytext=(3, 2), textcoords="offset points"
            )
    axis.set(xscale="log", yscale="log")
    for side in (axis.xaxis, axis.yaxis):
        side.set_major_locator(ticker.LogLocator(subs=(1, 2, 5)))
        side.set_major_formatter("{x:g}")
        side.set_minor_formatter(ticker.NullFormatter())
    axis.grid(alpha=0.3)


def _save(figure, path: Path) -> None:
    figure.savefig(path, dpi=90)
    pyplot.close(figure)
