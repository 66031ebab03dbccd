# SPDX-License-Identifier: GPL-3.0-or-later
"""The rows as CSV and as Markdown, under a line that says how they were come by."""

from __future__ import annotations

import csv
import datetime
import os
import platform
import subprocess
from math import exp, log
from pathlib import Path

from environment import ROOT

from splat_addon.rendering import PRESETS, Settings

from .choices import YARDSTICK, columns, label
from .frontier import frontier
from .measurement import COLUMNS
from .truth import FILTERS


def write_csv(rows: list[dict], path: Path) -> None:
    with path.open("w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, COLUMNS)
        writer.writeheader()
        writer.writerows(rows)


def write_markdown(rows: list[dict], chosen: list[Settings], head: str, skipped: dict, path: Path) -> None:
    """Two tables of choices by scenes, then every row."""
    parts = [head]
    parts += [f"**Skipped: {name}**, because {why}." for name, why in skipped.items()]
    for name in FILTERS:
        parts.append(f"PSNR in dB / mean FLIP under the {name} pixel filter; times are in that of {label(YARDSTICK)}:")
        parts.append(table(*summary(rows, chosen, name)))
    parts.append("Every row; * is on the frontier of FLIP (gaussian) and time:")
    on_frontier = {id(row) for mine in by_scene(rows).values() for row in frontier(mine)}
    cells = [[*(str(row[c]) for c in COLUMNS), "*" if id(row) in on_frontier else ""] for row in rows]
    parts.append(table([*COLUMNS, ""], cells))
    path.write_text("\n\n".join(parts) + "\n", encoding="utf-8")


def summary(rows: list[dict], chosen: list[Settings], name: str) -> tuple[list[str], list[list[str]]]:
    """Column names, and a line for each choice; the time is the geometric mean over the scenes, and its range."""
    scenes = by_scene(rows)
    lines = []
    for settings in chosen:
        mine = {scene: row_of(found, settings) for scene, found in scenes.items()}
        ratios = [row["ratio"] for row in mine.values()]
        mean = exp(sum(map(log, ratios)) / len(ratios))
        cells = [f"{row[f'psnr_{name}']:.1f} / {row[f'flip_{name}']:.3f}" for row in mine.values()]
        time = f"{mean:.1f} ({min(ratios):.1f} to {max(ratios):.1f})"
        lines.append([f"{label(settings)}{preset_of(settings)}", *cells, time])
    return ["", *scenes, "time"], lines


def preset_of(settings: Settings) -> str:
    """(Name) of the preset that these settings are, or nothing."""
    for preset in PRESETS.values():
        if preset.of(YARDSTICK) == settings:
            return f" (**{preset.label}**)"
    return ""


def by_scene(rows: list[dict]) -> dict[str, list[dict]]:
    return {scene: [row for row in rows if row["scene"] == scene] for scene in dict.fromkeys(r["scene"] for r in rows)}


def row_of(rows: list[dict], settings: Settings) -> dict:
    """The row of that choice among those of one scene."""
    wanted = columns(settings)
    return next(row for row in rows if all(row[name] == value for name, value in wanted.items()))


def table(names: list[str], lines: list[list[str]]) -> str:
    head = [f"| {' | '.join(names)} |", "|" + "---|" * len(names)]
    return "\n".join([*head, *(f"| {' | '.join(cells)} |" for cells in lines)])


def header(device, how: str) -> str:
    """Machine, driver, date, commit and how it was measured."""
    git = ["git", "describe", "--always", "--dirty"]
    commit = subprocess.run(git, cwd=ROOT, capture_output=True, text=True).stdout.strip() or "unknown"
    machine = f"{processor()}, {os.cpu_count()} cores, {device.renderer}"
    where = f"{device.kind} device on {device.backend}, {_version(device)}"
    return f"{machine}; {where}; {datetime.date.today()}, commit {commit}; {how}."


def processor() -> str:
    """The processor's model, or its architecture where the system does not tell."""
    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
    except OSError:
        lines = []
    models = (line.split(":", 1)[1].strip() for line in lines if line.startswith("model name"))
    return next(models, platform.processor() or platform.machine())


def _version(device) -> str:
    if device.kind == "standalone":
        return f"driver {device.version}"
    import bpy

    return f"driver {device.version}, Blender {bpy.app.version_string}"
