# SPDX-License-Identifier: GPL-3.0-or-later
"""What is measured of a scene before its first picture, and the settings that follow for a target."""

from __future__ import annotations

from collections.abc import Callable
from time import perf_counter

from ..rendering import Camera, Renderer, Scene, Settings, plan
from .choices import Choice, quick_choices
from .effects import Effects, tried_beside
from .exact import ExactPictures, Told, nobody
from .measuring import Row, measure
from .target import Promise, Target, chosen, settled

#: Pictures that the exact one is made from: enough for a FLIP of a few thousandths.
_PICTURES = 8

#: Frames of a choice whose median time is promised: single ones differ by more than a third.
TIMED_TURNS = 3

#: The choice that other settings than samples are changed of: where a picture is cheap, and they act alone.
_BESIDE = "Balanced, 1 sample"


class Survey:
    """A few choices, measured beside exact pictures, and the effects of single settings. rows, effects: what was
    found."""

    def __init__(
        self,
        renderer: Renderer,
        scene: Scene,
        camera: Camera,
        settings: Settings,
        told: Told = nobody,
        turns: int = 1,
        clock: Callable[[], float] = perf_counter,
    ):
        """Measure a scene. settings: those that choices change; their outputs should be colour alone. Raises as
        `measure`."""

        def share(first: float, last: float) -> Told:
            return lambda part: told(first + (last - first) * part)

        exact = ExactPictures.drawn(renderer, scene, camera, settings, _PICTURES, share(0.0, 0.3))

        def measured(choices: list[Choice], told: Told = nobody) -> list[Row]:
            return list(measure(renderer, scene, camera, settings, choices, exact, turns, told, clock))

        rows = measured(quick_choices(), share(0.3, 0.6))
        base = next(row for row in rows if row.choice.name == _BESIDE)
        tried = tried_beside(base.choice, settings, plan(scene, camera, base.choice.of(settings)))
        self.effects = Effects(base, measured(tried, share(0.6, 1.0)), settings, [row.choice for row in rows])
        self.rows = rows
        self._measured: Callable | None = measured

    def promise(self, target: Target, pace: float = 1.0) -> Promise:
        """What keeps a target. A choice of other settings than samples is drawn before it is promised; once the survey
        is closed, it is one of those that were."""
        if self._measured is None:
            return chosen(self.rows, target, pace, self.effects)
        return settled(self.rows, target, self.effects, lambda choice: self._measured([choice])[0], pace)

    def close(self) -> None:
        """Forget the scene and its pictures."""
        self.rows = [row.without_pictures() for row in self.rows]
        self._measured = None
