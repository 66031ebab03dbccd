# SPDX-License-Identifier: GPL-3.0-or-later
"""The cost of each feature.

This page is generated. Each row renders a picture with the feature and the same picture without it. *Time* is the
median ratio of the two in one turn (minimum to maximum). *More* lists what the feature adds to the frame: passes and
their shader parts, textures and tables that are read, with a minus sign for what it removes, and the MiB of textures
that passes write. A feature that a scene does not use costs nothing: it adds no pass, no texture and no line of shader
code (`tests/rendering/test_plan_table.py`).
"""

from __future__ import annotations

from bench.features.planned import added, planned_bytes
from environment import Problem
from measuring.timing import Spread, frame, in_turn
from splat_addon.reference.features import FEATURES, Feature
from splat_addon.reference.shots import Shot, plain
from splat_addon.rendering import Renderer, open_device

DEVICES = ("standalone", "blender")
QUICK = {"turns": 3, "size": 128, "splats": 10_000}
COLUMNS = "feature", "beside", "time", "ms more", "passes, shaders", "textures, tables", "MiB more"


def arguments(parser) -> None:
    parser.add_argument("--only", nargs="+", metavar="NAME", help="features whose name or group has one of these words")
    parser.add_argument("--size", type=int, default=256, help="pixels along each side")
    parser.add_argument("--splats", type=int, default=40_000)
    parser.set_defaults(turns=15)


def run(options, report) -> None:
    device = open_device(options.device)
    shot = plain(options.splats, (options.size, options.size))
    features = [f for f in wanted(options) if f.present(shot).settings.multisampling in (0, *device.multisample_counts)]
    how = f"{options.size} x {options.size} pixels, {options.splats:,} splats, medians of {options.turns} turns"
    report.header(device, how)
    rows = []

    def measured():
        for feature in report.steps(features, "Features"):
            rows.append(measure(feature, shot, device, options.turns))
            report.csv("features", rows)
            yield cells(rows[-1])

    report.table(COLUMNS, measured())


def wanted(options) -> list[Feature]:
    """The selected features. Raises Problem if a name does not exist."""
    if not options.only:
        return [f for f in FEATURES if f.is_quick or not options.quick]
    chosen = [f for f in FEATURES if any(word in f"{f.group} {f.name}" for word in options.only)]
    if not chosen:
        groups = ", ".join(dict.fromkeys(f.group for f in FEATURES))
        raise Problem(f"No feature's name or group has {' or '.join(options.only)} in it; the groups are {groups}.", 2)
    return chosen


def measure(feature: Feature, base: Shot, device, turns: int) -> dict:
    """Measure one row. ms: time without the feature. bytes: additional size of the plan's textures.

    Each side has its own renderer, so that neither evicts the other's textures.
    """
    shots = {"without": feature.absent(base), "with": feature.present(base)}
    renderers = {side: Renderer(device) for side in shots}
    try:
        jobs = {side: lambda side=side, shot=shot: renderers[side].render(*shot) for side, shot in shots.items()}
        drawn = in_turn(jobs, turns, frame)
    finally:
        for renderer in renderers.values():
            renderer.release()
    plans = [drawn.results[side].stats["plan"] for side in shots]
    ratio, more = drawn.ratio("with", "without"), zip(drawn.values["with"], drawn.values["without"])
    passes, textures = added(*plans)
    return {
        "group": feature.group, "feature": feature.name, "beside": feature.beside,
        "ratio": round(ratio.median, 2), "ratio_min": round(ratio.least, 2), "ratio_max": round(ratio.most, 2),
        "ms": round(drawn.spread("without").median, 1),
        "ms_more": round(Spread.of(present - absent for present, absent in more).median, 1),
        "passes": passes, "textures": textures, "bytes": planned_bytes(plans[1]) - planned_bytes(plans[0]),
    }  # fmt: skip


def cells(row: dict) -> tuple:
    """A row of the published table."""
    time = f"{row['ratio']:.2f} ({row['ratio_min']:.2f} to {row['ratio_max']:.2f})"
    space = f"{row['bytes'] / 2**20:.2f}" if row["bytes"] else ""
    more = f"{row['ms_more']:.1f} on {row['ms']:.1f}"
    return row["feature"], row["beside"], time, more, row["passes"], row["textures"], space
