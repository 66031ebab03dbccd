# SPDX-License-Identifier: GPL-3.0-or-later
"""Final renders that aim at an error or a time: the first picture of a render measures what its scene needs."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from time import perf_counter
from typing import NamedTuple

from ...rendering import Camera, Panorama, Renderer, Scene, Settings
from ...trade import TIMED_TURNS, Pace, Promise, Survey, Target
from ..export.notes import Notes


class Drawing(NamedTuple):
    """A picture that is to be drawn. told: called with the finished share and the step; returns False to cancel."""

    renderer: Renderer
    scene: Scene
    camera: Camera | Panorama
    settings: Settings
    told: Callable[[float, str], bool]

    def plain(self) -> Settings:
        """The settings for pictures of which colours alone are of interest."""
        return replace(self.settings, outputs=("color",), profile=False)

    def share(self, first: float, last: float, step: str) -> Callable[[float], bool]:
        """Tells of a part of the work, from the share `first` of the whole to `last`."""
        return lambda share: self.told(first + (last - first) * share, step)


class Targets:
    """What was measured for a render, kept for its later frames. Times are corrected by those that frames took.

    promise: that of the last picture; None without a target.
    """

    def __init__(self):
        self._surveys: dict[tuple, Survey] = {}
        self._pace = Pace()
        self._begun = 0.0
        self.promise: Promise | None = None

    def settings_for(self, target: Target, drawing: Drawing, reading: float) -> Settings:
        """The settings that keep the target. reading: seconds that reading the scene took, which count. Raises as
        `Survey`."""
        # what else a scene that stays on the device may change is left to the correction
        key = drawing.camera.size, drawing.settings.shading, target
        is_new = key not in self._surveys
        if is_new:
            renderer, scene, camera, *_ = drawing
            told = drawing.share(0.0, 1.0, "measuring the scene")
            turns = 1 if target.seconds is None else TIMED_TURNS
            self._surveys[key] = Survey(renderer, scene, camera, drawing.plain(), told, turns)
        left = target if target.seconds is None else Target(seconds=max(target.seconds - reading, 1e-3))
        self.promise = self._surveys[key].promise(left, self._pace.factor)
        if is_new:
            self._surveys[key].close()
        self._begun = perf_counter()
        return self.promise.choice.of(drawing.settings)

    def was_drawn(self, notes: Notes) -> None:
        """The picture of the last promise is complete."""
        self._pace.drawn(self.promise.seconds / self._pace.factor, perf_counter() - self._begun)
        if not self.promise.is_kept:
            notes.add(f"The target cannot be kept. {self.promise.why}")
