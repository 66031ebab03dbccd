# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures in turn, with the milliseconds that each frame says it took."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterable, Mapping
from functools import partial

import numpy as np

from measuring.timing import Turns, frame, in_turn
from splat_addon.rendering import Frame, Settings


def draw_in_turn(
    draw: Callable[[Settings], Frame], choices: Mapping[Hashable, Settings] | Iterable[Settings], turns: int, **options
) -> Turns:
    """Each of the settings, by its name or by itself where it has none."""
    named = choices if isinstance(choices, Mapping) else {settings: settings for settings in choices}
    stored = None

    def job(settings: Settings) -> Frame:
        nonlocal stored
        if settings.storage != stored:
            draw(settings)  # takes the time to pack and upload surfels, which other frames do not
            stored = settings.storage
        return draw(settings)

    return in_turn({name: partial(job, settings) for name, settings in named.items()}, turns, frame, **options)


def holes(drawn: Frame, exact: Frame) -> int:
    """Pixels that the truth covers whole and the frame not at all."""
    return int(np.count_nonzero((exact.coverage > 0.999) & (drawn.coverage == 0)))
