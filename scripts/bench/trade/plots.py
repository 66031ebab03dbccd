# SPDX-License-Identifier: GPL-3.0-or-later
"""Plots FLIP against time, one panel per scene: lower left is better, and the line is the Pareto frontier. Also draws
the reference beside some choices, with the FLIP map under each."""

from __future__ import annotations

import matplotlib
import numpy as np

matplotlib.use("Agg")
from matplotlib import pyplot, ticker

from bench.trade.choices import PICTURED, label
from splat_addon.differences import flip, srgb
from splat_addon.rendering.methods import METHODS
from splat_addon.trade.page import magma

COLORS = dict(zip(METHODS, (*pyplot.cm.tab10.colors, "0.2", "0.5")))

#: Pixels an inch of the figures: what is set in points can be read without enlarging.
_DPI = 100

#: Scenes of the plot, and of the pictures.
PLOTTED, SHOWN = ("checker200", "text", "armadillo"), ("text", "torus")


def by_scene(rows: list[dict]) -> dict[str, list[dict]]:
    return {scene: [row for row in rows if row["scene"] == scene] for scene in dict.fromkeys(r["scene"] for r in rows)}


def frontier(rows: list[dict], error: str) -> list[dict]:
    """The rows of a scene that no other row beats in both time and FLIP, fastest first; of equal rows the first. error:
    the column of FLIP."""
    kept = []
    for row in sorted(rows, key=lambda row: (row["ratio"], row[error])):
        if not kept or row[error] < kept[-1][error]:
            kept.append(row)
    return kept


def plot_frontier(rows: list[dict]):
    """Some scenes, under the Gaussian and the box, with times relative to the yardstick."""
    scenes = by_scene(rows)
    scenes = {name: mine for name, mine in scenes.items() if name in PLOTTED} or scenes
    figure, axes = pyplot.subplots(
        len(scenes), 2, figsize=(9, 3 * len(scenes) + 0.9), dpi=_DPI, layout="constrained", squeeze=False
    )
    for across, (scene, mine) in zip(axes, scenes.items()):
        for axis, kind in zip(across, ("gaussian", "box")):
            _panel(axis, mine, f"flip_{kind}")
            axis.set_title(f"{scene}, {kind.title()} pixel", fontsize=11)
    # Beside the panels, because inside one it would hide points.
    known = [name for name in COLORS if any(row["method"] == name for row in rows)]
    handles = [_shown("o", COLORS[name], METHODS[name].label) for name in known]
    handles.append(pyplot.Line2D([], [], linestyle="", marker="o", mfc="white", mec="0.3", label="hardware samples"))
    figure.legend(handles=handles, loc="outside upper center", ncols=4, fontsize=9)
    figure.supxlabel("time in that of Quads with one sample", fontsize=10)
    figure.supylabel("mean FLIP", fontsize=10)
    return figure


def _shown(shape: str, color, name: str):
    """An entry of the legend."""
    return pyplot.Line2D([], [], linestyle="", marker=shape, color=color, label=name)


def _panel(axis, rows: list[dict], error: str) -> None:
    best = frontier(rows, error)
    axis.step([r["ratio"] for r in best], [r[error] for r in best], color="0.7", where="post", zorder=0)
    for row in rows:
        color = COLORS[row["method"]]
        face = "white" if row["multisampling"] else color
        axis.scatter(row["ratio"], row[error], c=[face], edgecolors=[color], s=34)
    axis.set(xscale="log", yscale="log")
    axis.margins(x=0.3, y=0.15)
    _name(axis, best, error)
    axis.tick_params(labelsize=9, which="both")
    for side in (axis.xaxis, axis.yaxis):
        side.set_major_locator(ticker.LogLocator(subs=(1, 2, 5)))
        side.set_major_formatter("{x:g}")
        side.set_minor_formatter(ticker.NullFormatter())
    axis.grid(alpha=0.3)


def _name(axis, best: list[dict], error: str) -> None:
    """Names of the frontier's points: to their left and below, where no other points are, and below one another."""
    free = np.inf
    for number, row in enumerate(best):
        samples = "4 in hardware" if row["multisampling"] else row["samples"].replace(" ", "")
        place = {"ha": "right", "va": "top", "xytext": (-6, -1)}
        if number == 0:
            place = {"ha": "center", "va": "bottom", "xytext": (6, 5)}
        else:
            height = axis.transData.transform((row["ratio"], row[error]))[1] * 72 / axis.figure.dpi
            place["xytext"] = (-6, min(-1, free - height))
            free = height + place["xytext"][1] - 11
        name = f"{METHODS[row['method']].label} {samples}"
        axis.annotate(name, (row["ratio"], row[error]), fontsize=9, textcoords="offset points", **place)


def pictured(drawn: dict, truth: np.ndarray) -> dict[str, tuple[np.ndarray, np.ndarray]]:
    """What `plot_differences` shows of a scene: name -> a picture as a screen shows it, and its FLIP as colours.

    drawn: settings -> (h, w, 4). truth: of the Gaussian.
    """
    colors = {"exact": truth[..., :3]} | {label(s): color[..., :3] for s, color in drawn.items() if s in PICTURED}
    return {name: (srgb(np.nan_to_num(color)), magma(flip(color, truth[..., :3]))) for name, color in colors.items()}


def plot_differences(shown: dict[str, dict]):
    """The exact picture of each scene and some choices beside it; below each its FLIP under the Gaussian."""
    names = list(next(iter(shown.values())))
    size = (1.8 * len(names), 3.6 * len(shown) + 0.3)
    figure, axes = pyplot.subplots(
        2 * len(shown), len(names), figsize=size, dpi=_DPI, layout="constrained", squeeze=False
    )
    for axis in axes.flat:
        axis.set_axis_off()
    for row, pictures in enumerate(shown.values()):
        for column, name in enumerate(names):
            axes[2 * row, column].set_title(name if row == 0 else "", fontsize=10)
            for below, picture in enumerate(pictures[name][: 1 if column == 0 else 2]):
                axes[2 * row + below, column].imshow(np.clip(picture, 0, 1), origin="lower", interpolation="nearest")
    return figure
