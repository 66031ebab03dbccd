# SPDX-License-Identifier: GPL-3.0-or-later
"""How coarse a view is drawn while it moves, so that its pictures follow one another at a rate."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from time import perf_counter

from .settings import Settings

#: The largest tolerance of a moving view, in pixels.
COARSEST = 16.0
#: A picture that takes less than this share of its time allows finer ones.
_SPARE = 0.6
#: The most that one picture changes the tolerance by.
_STEP = 2.0


class Pace:
    """Multiplies the tolerance of moving views. rate: pictures per second; None: whatever they take.

    The number of splats falls with the square of the tolerance, so it changes with the root of the time.
    """

    def __init__(self, rate: float | None, clock: Callable[[], float] = perf_counter):
        self.rate = rate
        self._clock = clock
        self._factor = 1.0
        self._started = 0.0

    def begin(self, settings: Settings) -> Settings:
        """The settings to draw the next picture of a moving view with; the same object if it need not be coarser."""
        self._started = self._clock()
        tolerance = min(settings.detail_tolerance * self._factor, max(COARSEST, settings.detail_tolerance))
        return settings if tolerance == settings.detail_tolerance else replace(settings, detail_tolerance=tolerance)

    def end(self, settings: Settings) -> None:
        """Learn from the time that the picture took. settings: those that it would have at rest."""
        if self.rate is None or not settings.detail_tolerance:
            return
        load = (self._clock() - self._started) * self.rate
        if not _SPARE <= load <= 1:
            factor = self._factor * min(max((load / (_SPARE + 1) * 2) ** 0.5, 1 / _STEP), _STEP)
            self._factor = min(max(factor, 1.0), max(COARSEST / settings.detail_tolerance, 1.0))
