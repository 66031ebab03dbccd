# SPDX-License-Identifier: GPL-3.0-or-later
"""Draws a case with every choice, turn by turn, and makes a row of each.

Turn by turn, so that what else the machine does meets all choices alike; the first turn warms up and is not counted.
A time's `ratio` is the median over the turns of it and the yardstick's in the same turn.
"""

from __future__ import annotations

import statistics
from collections.abc import Callable

from splat_addon.rendering import Frame, Settings

from .choices import FORMATS, YARDSTICK, columns
from .truth import FILTERS, accuracy

COLUMNS = (
    "scene",
    "method",
    "prefilter",
    "samples",
    *FORMATS,
    *(f"{metric}_{name}" for name in FILTERS for metric in ("psnr", "flip")),
    "ratio",
    "ratio_min",
    "ratio_max",
    "ms",
    "ms_min",
    "ms_max",
    "holes",
    "non_finite",
)


def measure(
    name: str, draw: Callable[[Settings], Frame], chosen: list[Settings], turns: int, exact, advance
) -> tuple[list[dict], dict[Settings, Frame]]:
    """A row for each choice, and its last frame. advance: called after every frame."""
    frames, times = draw_turns(draw, chosen, turns, advance)
    rows = [{"scene": name, **columns(s), **accuracy(frames[s], exact), **spread(times, s)} for s in chosen]
    return rows, frames


def draw_turns(draw: Callable[[Settings], Frame], chosen: list[Settings], turns: int, advance: Callable[[], None]):
    """The last frame and the milliseconds of every counted turn, each by settings."""
    frames, times, stored = {}, {settings: [] for settings in chosen}, None
    for turn in range(turns + 1):
        for settings in chosen:
            if settings.storage != stored:
                draw(settings)  # takes the time to pack and upload surfels, which other frames do not
                stored = settings.storage
            frames[settings] = draw(settings)
            if turn:
                times[settings].append(frames[settings].stats["milliseconds"])
            advance()
    return frames, times


def spread(times: dict[Settings, list[float]], settings: Settings) -> dict:
    """Median, least and most of the times and of their ratios to the yardstick's."""
    mine = times[settings]
    ratios = [own / unit for own, unit in zip(mine, times[YARDSTICK], strict=True)]
    return {
        "ratio": round(statistics.median(ratios), 2),
        "ratio_min": round(min(ratios), 2),
        "ratio_max": round(max(ratios), 2),
        "ms": round(statistics.median(mine), 1),
        "ms_min": round(min(mine), 1),
        "ms_max": round(max(mine), 1),
    }
