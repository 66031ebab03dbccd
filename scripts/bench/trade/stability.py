# SPDX-License-Identifier: GPL-3.0-or-later
"""How much pictures flicker: while the picture moves by parts of a pixel, and while the camera turns around the scene.

*Flicker* is the mean change of a picture's error from one picture to the next, in code values of sRGB (0 to 255): what
changes in the exact pictures, too, does not count. It is measured under the pixel filter that a choice is closer to.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import partial
from itertools import pairwise

import numpy as np

from bench.trade.cases import CASES, View
from measuring.report import Table
from splat_addon.differences import srgb
from splat_addon.rendering import Camera, Renderer, Settings
from splat_addon.trade import Choice, ExactPictures, series_of

SCENES = "checker", "torus"
HOW = "shifted", "turned"
STEPS = 16

#: Degrees that the camera turns around the scene from picture to picture: a pixel or so.
_TURN = 0.4

_WANTED = "Preview", "Balanced, 1 sample", "Balanced, 16 samples", "Final, 2 x 2", "Final, 4 x 4"
_OTHERS = {"EWA, 1 sample": "ewa", "Ray Cast, 1 sample": "raycast"}


def choices() -> list[Choice]:
    found = [choice for choice in series_of() if choice.name in _WANTED]
    return found + [Choice(name, {"method": method, "detail_tolerance": 0.0}) for name, method in _OTHERS.items()]


def units(renderer: Renderer, options, report) -> dict[str, Callable[[], list[dict]]]:
    return {name: partial(_measure, name, renderer, options) for name in SCENES[: 1 if options.quick else None]}


def _measure(name: str, renderer: Renderer, options) -> list[dict]:
    """A row for each choice: flicker while the picture shifts and while the camera turns."""
    settings = Settings(shading="flat", outputs=("color",))
    scene, camera = CASES[name].build(View(options.size, options.models))
    rows = [{"scene": name, "choice": choice.name} for choice in choices()]
    for how, cameras in zip(HOW, (shifted(camera), turned(camera)), strict=True):
        exact = [ExactPictures.drawn(renderer, scene, each, settings, 16).colors for each in cameras]
        for row, choice in zip(rows, choices(), strict=True):
            row[how] = round(_flicker(renderer, scene, cameras, exact, choice.of(settings)), 3)
    return rows


def made(rows: list[dict]) -> dict[str, Table]:
    about = "Flicker in code values, over 16 shifts within a pixel, and 16 pictures of a camera that turns:"
    scenes = list(dict.fromkeys(row["scene"] for row in rows))
    lines = [
        [choice.name, *(f"{row[how]:.2f}" for row in rows if row["choice"] == choice.name for how in HOW)]
        for choice in choices()
    ]
    return {"flicker": Table(about, ["", *(f"{name}, {how}" for name in scenes for how in HOW)], lines)}


def shifted(camera: Camera) -> list[Camera]:
    """The camera with its picture moved to each of 4 x 4 places within a pixel, row by row."""
    left, right, bottom, top = camera.window
    dx, dy = (right - left) / camera.size[0] / 4, (top - bottom) / camera.size[1] / 4
    places = [(i % 4, i // 4) for i in range(STEPS)]
    return [
        camera.with_values(window=(left + x * dx, right + x * dx, bottom + y * dy, top + y * dy)) for x, y in places
    ]


def turned(camera: Camera) -> list[Camera]:
    """The camera turned around the vertical through the scene's origin, step by step."""
    found = []
    for step in range(STEPS):
        angle, turn = math.radians(_TURN * step), np.eye(4)
        turn[:2, :2] = (math.cos(angle), -math.sin(angle)), (math.sin(angle), math.cos(angle))
        found.append(camera.with_values(matrix_world=turn @ camera.matrix_world))
    return found


def _flicker(renderer: Renderer, scene, cameras: list[Camera], exact: list[dict], settings: Settings) -> float:
    shown = [srgb(renderer.render(scene, camera, settings, is_repeatable=True).color[..., :3]) for camera in cameras]
    found = []
    for kind in exact[0]:
        errors = [picture - srgb(truth[kind][..., :3]) for picture, truth in zip(shown, exact, strict=True)]
        found.append(255 * np.mean([np.abs(later - before).mean() for before, later in pairwise(errors)]))
    return min(found)
