# SPDX-License-Identifier: GPL-3.0-or-later
"""Where the time of a frame goes: each preset with one sample, in the sun."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import partial

import numpy as np

from bench.trade.cases import View
from bench.trade.numbers import shots
from measuring.report import Table
from splat_addon.rendering import PRESETS, Renderer

SCENES = "tori in the sun", "a crowd of 36"


def units(renderer: Renderer, options, report) -> dict[str, Callable[[], list[dict]]]:
    return {name: partial(_measure, name, renderer, options) for name in SCENES[: 1 if options.quick else None]}


def _measure(name: str, renderer: Renderer, options) -> list[dict]:
    """A row for each preset: the median milliseconds of each pass."""
    build, settings = shots(View(options.size, options.models))[name]
    scene, camera = build()
    rows = []
    for preset in PRESETS.values():
        wanted = replace(preset.of(settings), samples=1, profile=True)
        found: dict[str, list[float]] = {}
        for turn in range(options.turns + 1):
            taken = renderer.render(scene, camera, wanted).stats["passes"]
            for each, milliseconds in taken.items() if turn else ():
                found.setdefault(each, []).append(milliseconds)
        medians = {each: round(float(np.median(times)), 2) for each, times in found.items()}
        rows.append({"scene": name, "preset": preset.label, "ms": medians})
    return rows


def made(rows: list[dict]) -> dict[str, Table]:
    about = "Milliseconds of all passes, one sample, and the share of each:"
    return {"passes": Table(about, ["preset", "scene", "ms", "passes"], list(_lines(rows)))}


def _lines(rows: list[dict]) -> Iterator[list]:
    for row in rows:
        whole = sum(row["ms"].values())
        shares = sorted(((each / whole, name) for name, each in row["ms"].items()), reverse=True)
        passes = ", ".join(f"{name} {share:.0%}" for share, name in shares if share > 0.01)
        yield [row["preset"], row["scene"], f"{whole:.1f}", passes]
