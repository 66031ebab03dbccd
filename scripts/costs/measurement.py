# SPDX-License-Identifier: GPL-3.0-or-later
"""Draws a picture with a feature and without it, turn by turn, and makes a row of both.

Turn by turn, so that what else the machine does meets both alike; a renderer each, so that neither makes room for the
other's textures; the first turn compiles and is not counted.
"""

from __future__ import annotations

import statistics
from collections.abc import Callable

from splat_addon.rendering import Renderer

from .features import Feature
from .planned import added, planned_bytes
from .shots import Shot

COLUMNS = (
    "group",
    "feature",
    "beside",
    "ratio",
    "ratio_min",
    "ratio_max",
    "ms",
    "ms_more",
    "passes",
    "textures",
    "bytes",
)


def measure(feature: Feature, plain: Shot, device, turns: int, advance: Callable[[], None]) -> dict:
    """One row: time with the feature over time without, medians over the turns of both in the same turn.

    ms: without it. bytes: of the plan's textures, more than without. advance: called after every frame.
    """
    shots = feature.absent(plain), feature.present(plain)
    renderers = [Renderer(device) for _ in shots]
    try:
        pairs = [[_draw(r, shot, advance) for r, shot in zip(renderers, shots, strict=True)] for _ in range(turns + 1)]
    finally:
        for renderer in renderers:
            renderer.release()
    plans = [stats["plan"] for stats in pairs[0]]
    times = [[stats["milliseconds"] for stats in pair] for pair in pairs[1:]]
    ratios = [present / absent for absent, present in times]
    passes, textures = added(*plans)
    return {
        "group": feature.group,
        "feature": feature.name,
        "beside": feature.beside,
        "ratio": round(statistics.median(ratios), 2),
        "ratio_min": round(min(ratios), 2),
        "ratio_max": round(max(ratios), 2),
        "ms": round(statistics.median(absent for absent, _ in times), 1),
        "ms_more": round(statistics.median(present - absent for absent, present in times), 1),
        "passes": passes,
        "textures": textures,
        "bytes": planned_bytes(plans[1]) - planned_bytes(plans[0]),
    }


def _draw(renderer: Renderer, shot: Shot, advance: Callable[[], None]) -> dict:
    stats = renderer.render(*shot).stats
    advance()
    return stats
