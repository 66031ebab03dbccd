# SPDX-License-Identifier: GPL-3.0-or-later
"""Motion blur: the times during an open shutter at which a final render evaluates the scene."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from contextlib import contextmanager

import bpy
import numpy as np

from ...rendering.assembly.accumulation import moment_places
from ..ids import RENDER_SETTINGS

#: position -> when the shutter opens relative to the frame, as a share of the exposure time
_OPENS = {"START": 0.0, "CENTER": -0.5, "END": -1.0}

_CURVE_STEPS = 256


def shutter_times(scene: bpy.types.Scene, view_layer: bpy.types.ViewLayer, samples: int) -> list[float]:
    """Frames, with fractions, at which a final render of this many samples evaluates the scene; empty without motion
    blur.

    Their density follows the shutter's curve (importance sampling, as in Cycles), so that all have equal weight.
    """
    render = scene.render
    if not (render.use_motion_blur and view_layer.use_motion_blur) or samples == 1 or _is_odd(render):
        return []
    moments = min(samples, getattr(scene, RENDER_SETTINGS).motion_blur_steps)
    now = scene.frame_current + scene.frame_subframe
    opens, length = _OPENS[render.motion_blur_position], render.motion_blur_shutter
    places = _under_curve(render.motion_blur_shutter_curve, moment_places(samples, moments))
    return [now + (opens + float(place)) * length for place in places]


@contextmanager
def moving_time(
    engine: bpy.types.RenderEngine, depsgraph: bpy.types.Depsgraph, evaluated: Callable[[], None]
) -> Iterator:
    """Yields go(time), which evaluates the depsgraph at a fractional frame; the frame is restored at the end.

    evaluated: called after each evaluation.
    """
    scene = depsgraph.scene
    now = scene.frame_current + scene.frame_subframe
    moved = False

    def go(time: float) -> None:
        nonlocal moved
        moved = True
        engine.frame_set(math.floor(time), time - math.floor(time))
        evaluated()

    try:
        yield go
    finally:
        if moved:
            go(now)


def motion_blur_notes(scene: bpy.types.Scene, view_layer: bpy.types.ViewLayer, samples: int) -> Iterator[str]:
    """Reasons why a scene that requests motion blur will not show any."""
    if not (scene.render.use_motion_blur and view_layer.use_motion_blur):
        return
    if _is_odd(scene.render):
        yield f"A shutter cannot be open for {scene.render.motion_blur_shutter:g} frames; nothing is blurred"
    elif samples == 1:
        yield "Motion blur needs Samples above 1 in the render properties; nothing is blurred in this picture"


#: A longer shutter ends at no frame that Blender has.
_LONGEST = 1e5


def _is_odd(render: bpy.types.RenderSettings) -> bool:
    """Whether the time for which the shutter is open cannot be one."""
    return not 0 <= render.motion_blur_shutter <= _LONGEST


def _under_curve(curve: bpy.types.CurveMapping, places: list[float]) -> np.ndarray:
    """Maps shares of the area under the curve to shares of its length; a curve without area counts as constant."""
    curve.initialize()
    steps = (np.arange(_CURVE_STEPS) + 0.5) / _CURVE_STEPS
    heights = np.array([max(curve.evaluate(curve.curves[0], step), 0.0) for step in steps])
    if not heights.any():
        heights[:] = 1.0
    area = np.concatenate([[0.0], np.cumsum(heights)])
    return np.interp(places, area / area[-1], np.linspace(0, 1, _CURVE_STEPS + 1))
