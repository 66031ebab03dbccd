# SPDX-License-Identifier: GPL-3.0-or-later
"""Draws pictures in turn and records the milliseconds that each frame reports."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterable, Mapping
from functools import partial

import numpy as np

from measuring.timing import Turns, frame, in_turn
from splat_addon.rendering import Frame, Settings


def draw_in_turn(
    draw: Callable[[Settings], Frame], choices: Mapping[Hashable, Settings] | Iterable[Settings], turns: int, **options
) -> Turns:
    """Draw with each of the settings, by name if they have one."""
    named = choices if isinstance(choices, Mapping) else {settings: settings for settings in choices}
    stored = None

    def job(settings: Settings) -> Frame:
        nonlocal stored
        if settings.storage != stored:
            draw(settings)  # packs and uploads the surfels, which later frames need not do
            stored = settings.storage
        return draw(settings)

    return in_turn({name: partial(job, settings) for name, settings in named.items()}, turns, frame, **options)


def holes(drawn: Frame, exact: Frame) -> int:
    """Number of pixels that the reference covers fully and the frame not at all."""
    return int(np.count_nonzero((exact.coverage > 0.999) & (drawn.coverage == 0)))
