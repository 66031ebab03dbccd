# SPDX-License-Identifier: GPL-3.0-or-later
"""How coarse a view is drawn while it moves, so that its pictures follow one another at a rate."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from time import perf_counter

from ..scene.camera import Camera
from ..settings import Settings

#: The largest tolerance of a moving view, in pixels.
COARSEST = 16.0
#: The widest pixels of a moving view, in pixels at rest.
WIDEST = 4.0
#: A picture that takes less than this share of its time allows finer ones.
_SPARE = 0.6
#: The most that one picture changes the tolerance or the resolution by, and the most of one that took many times its
#: time: a second of such a picture is worse than one that is too coarse.
_STEP, _LEAP = 2.0, 4.0
#: How many times its time that is.
_FAR_TOO_LONG = 4.0


#: The share of a picture's time after which a call of the view ends: the last step may take as long again. A call may
#: take as long as what comes between two, such as redrawing the window, up to the second share.
SLICE, LONGEST_SLICE = 0.4, 0.8

#: Surfels of files that a moving view may draw in any case, and in its first picture.
LEAST_STREAMED = 1 << 15


class Pace:
    """Limits how many surfels a moving view takes from files, multiplies its tolerance, and if fewer surfels do not
    help enough, the width of its pixels. rate: pictures per second; None: whatever they take.

    The number of splats falls with the square of the tolerance, and that of pixels with the square of their width, so
    both change with the root of the time.
    """

    def __init__(self, rate: float | None, clock: Callable[[], float] = perf_counter):
        self.rate = rate
        self._clock = clock
        self._started = 0.0
        self._paused: float | None = None
        self._tolerance = self._width = 1.0
        self._raised: tuple[float, float] | None = None
        self._does_merging_help = True
        self._most = float(LEAST_STREAMED)

    def slice_end(self) -> float | None:
        """The time at which a call of the view that begins now should end; None: once it has a picture."""
        if self.rate is None:
            return None
        now = self._clock()
        between = 0.0 if self._paused is None else now - self._paused
        return now + min(max(between, SLICE / self.rate), LONGEST_SLICE / self.rate)

    def pause(self) -> None:
        """The time until `go_on` is not the picture's."""
        self._paused = self._clock()

    def go_on(self) -> None:
        """Go on with the picture after a pause, if there was one."""
        if self._paused is not None:
            self._started += self._clock() - self._paused
            self._paused = None

    def is_over(self, end: float | None) -> bool:
        """Whether that time has come."""
        return end is not None and self._clock() >= end

    @property
    def most(self) -> int | None:
        """Surfels that a moving view may take from files."""
        return None if self.rate is None else int(self._most)

    def begin_coarsely(self) -> None:
        """Draw the next picture as coarse as any if nothing is known about the time that it takes."""
        if not self._started:
            self._width = WIDEST

    def begin(self, camera: Camera, settings: Settings) -> tuple[Camera, Settings]:
        """The camera and the settings to draw the next picture of a moving view with; the same objects if they need not
        be coarser."""
        self._started, self._paused = self._clock(), None
        if self.rate is None:
            return camera, settings
        tolerance = min(settings.detail_tolerance * self._tolerance, max(COARSEST, settings.detail_tolerance))
        size = tuple(max(round(edge / self._width), 1) for edge in camera.size)
        texels = self._shadow_texels(settings.shadow_resolution)
        drawn = replace(settings, detail_tolerance=tolerance, shadow_resolution=texels)
        return (
            camera if size == camera.size else replace(camera, size=size),
            settings if drawn == settings else drawn,
        )

    def _shadow_texels(self, resolution: int) -> int:
        """Texels along a shadow map: halved as often as the width of pixels was doubled, in multiples of 16."""
        for _ in range(int(math.log2(self._width))):
            if resolution % 32 == 0:
                resolution //= 2
        return resolution

    def end(self, settings: Settings, streamed: int = 0) -> None:
        """Learn from the time that the picture took. settings: those that it would have at rest. streamed: surfels that
        it had from files."""
        if self.rate is None:
            return
        load, raised, self._raised = (self._clock() - self._started) * self.rate, self._raised, None
        if raised and load > raised[0] * (1 + raised[1] ** -2) / 2:
            # less than half of what fewer splats would save: fewer pixels instead
            self._does_merging_help = False
            self._tolerance = max(self._tolerance / raised[1], 1.0)
            self._width = min(self._width * raised[1], WIDEST)
        elif streamed > LEAST_STREAMED and load > 1:
            # others come later, and the tolerance is not what decides how many there are
            self._most = max(min(streamed, self._most) / min(load, _STEP**2), LEAST_STREAMED)
        elif not _SPARE <= load <= 1:
            most = _LEAP if load > _FAR_TOO_LONG else _STEP
            self._change(load, min(max((load / (_SPARE + 1) * 2) ** 0.5, 1 / _STEP), most), settings, streamed)

    def _change(self, load: float, step: float, settings: Settings, streamed: int) -> None:
        """Make the next picture coarser (a step above 1) or finer."""
        most = max(COARSEST / settings.detail_tolerance, 1.0) if settings.detail_tolerance else 1.0
        if step > 1 and self._does_merging_help and self._tolerance < most:
            before, self._tolerance = self._tolerance, min(self._tolerance * step, most)
            self._raised = load, self._tolerance / before
        elif step > 1 and self._width == WIDEST:
            # nothing else is left, and few fewer splats are better than none
            self._tolerance = min(self._tolerance * step, most)
        elif step > 1 or self._width > 1:
            self._width = min(max(self._width * step, 1.0), WIDEST)
        elif self._tolerance > 1:
            self._tolerance = max(self._tolerance * step, 1.0)
            self._does_merging_help |= self._tolerance == 1
        else:
            self._does_merging_help = True
            # far more than there are would take long to find out that they are too many
            self._most = min(self._most / step**2, max(_STEP**2 * streamed, LEAST_STREAMED))
