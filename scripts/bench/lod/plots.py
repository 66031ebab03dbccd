# SPDX-License-Identifier: GPL-3.0-or-later
"""Plots the time of a frame against the number of surfels, beside the rates of other programs."""

from __future__ import annotations

import matplotlib

matplotlib.use("Agg")
from matplotlib import pyplot

#: program -> (splats, milliseconds): measured in November 2026 with the programs themselves on 2 cores and llvmpipe,
#: 1024 x 768 pixels, means of 8 frames; their pictures differ from ours and from each other's.
PEERS = {
    "surface_splatting, EWA": (79_988, 342),
    "surface_splatting, EWA, fastest extents": (79_988, 116),
    "PyVista, points as Gaussians": (200_000, 285),
    "Open3D, lit points": (200_000, 3833),
}
LINES = {"all": "every surfel", "cut": "default tolerance", "bare": "the same, depth only"}


def plot_times(rows: list[dict]):
    """rows: surfels, view, and the milliseconds of each kind of frame in `LINES`. Peers have a constant rate."""
    views = list(dict.fromkeys(row["view"] for row in rows))
    figure, axes = pyplot.subplots(1, len(views), figsize=(4.2 * len(views), 3.4), sharey=True, layout="constrained")
    for axis, view in zip(axes, views):
        mine = [row for row in rows if row["view"] == view]
        counts = [row["surfels"] for row in mine]
        for (name, (splats, ms)), color in zip(PEERS.items(), ("0.35", "0.5", "0.65", "0.8")):
            axis.plot(counts, [ms * count / splats for count in counts], ":", color=color, label=f"{name} (rate)")
        for kind, label in LINES.items():
            axis.plot(counts, [row[kind] for row in mine], "o-", markersize=3, label=label)
        axis.set(xscale="log", yscale="log", xlabel="surfels", title=view)
        axis.grid(alpha=0.3)
    axes[0].set_ylabel("milliseconds per frame")
    figure.legend(*axes[0].get_legend_handles_labels(), loc="outside lower center", ncols=2, fontsize=7)
    return figure
