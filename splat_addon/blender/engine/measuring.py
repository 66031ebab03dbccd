# SPDX-License-Identifier: GPL-3.0-or-later
"""Measure This Scene: a render whose picture is drawn with many settings, and what each of them costs and gains."""

from __future__ import annotations

from dataclasses import dataclass, field

import bpy

from ...rendering import Frame, Settings
from ...trade import Choice, ExactPictures, Row, choices_for, measure, page
from .targets import Drawing

#: What was measured in this session, by the scene's name.
_measured: dict[str, Measured] = {}


@dataclass
class Measured:
    """What was measured in a scene, and can be gone on with.

    settings: those that the choices change. size: width and height in pixels. about: a sentence on the machine.
    choices: what is to be measured. rows: what has been.
    """

    settings: Settings
    size: tuple[int, int]
    about: str
    exact: ExactPictures
    choices: list[Choice]
    rows: list[Row] = field(default_factory=list)

    @property
    def is_whole(self) -> bool:
        return len(self.rows) == len(self.choices)

    def page(self, title: str) -> str:
        """The HTML page."""
        about = f"{self.size[0]} x {self.size[1]} pixels, {self.about}, Blender {bpy.app.version_string}."
        return page(title, about, self.rows, self.exact)


def measured(scene: bpy.types.Scene) -> Measured | None:
    """What was measured in a scene in this session."""
    return _measured.get(scene.name)


def forget_measurements() -> None:
    """Forget what was measured in all scenes."""
    _measured.clear()


class Measuring:
    """Draws the first picture of a render with all choices, and every picture as set. Call it with a `Drawing`.

    pictures: that the exact ones are made from. turns: times that each choice is drawn. goes_on: keep what a render
    that was cancelled had measured, if settings and size are still the same.
    """

    def __init__(self, scene: bpy.types.Scene, pictures: int, turns: int, goes_on: bool):
        self._name, self._pictures, self._turns, self._goes_on = scene.name, pictures, turns, goes_on
        self._is_done = False

    def __call__(self, drawing: Drawing) -> Frame:
        renderer, scene, camera, settings, told = drawing
        frame = renderer.render(scene, camera, settings, told, is_repeatable=True)
        if self._is_done:
            return frame
        self._is_done = True
        work = self._begun(drawing, frame)
        left = [choice for choice in work.choices if choice not in {row.choice for row in work.rows}]
        for row in measure(
            renderer, scene, camera, work.settings, left, work.exact, self._turns, drawing.share(0.3, 1.0, "measuring")
        ):
            work.rows.append(row)
        work.rows.sort(key=lambda row: work.choices.index(row.choice))
        return frame

    def _begun(self, drawing: Drawing, frame: Frame) -> Measured:
        plain, before = drawing.plain(), _measured.get(self._name)
        if self._goes_on and before and (before.settings, before.size) == (plain, drawing.camera.size):
            return before
        told = drawing.share(0.0, 0.3, "exact pictures")
        exact = ExactPictures.drawn(drawing.renderer, drawing.scene, drawing.camera, plain, self._pictures, told)
        about = f"{frame.stats['device']}, {frame.stats['backend']}"
        choices = choices_for(plain, frame.stats["plan"])
        _measured[self._name] = made = Measured(plain, drawing.camera.size, about, exact, choices)
        return made
