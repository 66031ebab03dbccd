# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs inside a Blender window: a view draws its pictures in slices, at rest and while it turns, and then at once.

The clock by which slices end moves with each look at it, so that it does not matter how fast the machine is.
test_slices.py reads the report.
"""

import sys
from functools import partial
from pathlib import Path

import bpy
import gpu
import numpy as np
from mathutils import Quaternion

sys.path[:0] = [str(Path(__file__).resolve().parents[2]), str(Path(__file__).resolve().parent)]

from steps import play, until, view3d  # noqa: E402

import splat_addon  # noqa: E402
from splat_addon.blender.engine import viewport  # noqa: E402
from splat_addon.blender.geometry.attributes import write_surfels  # noqa: E402
from splat_addon.reference import scenes  # noqa: E402
from splat_addon.rendering import Pace  # noqa: E402

COUNT = 300_000
#: Turns of the view, the angle of one, and the calls between two of them.
TURNS, TURN, CALLS = 6, 0.1, 4

#: of each call of the view: whether it left a picture unfinished, how many samples are in its sum, and what it shows
calls = []


class Clock:
    """Two looks take longer than a call may."""

    now = 0.0

    def __call__(self):
        self.now += 0.03
        return self.now


def watch(draw):
    def watching(engine, context, depsgraph):
        draw(engine, context, depsgraph)
        region, frame = context.region, gpu.state.active_framebuffer_get()
        seen = frame.read_color(0, 0, region.width, region.height, 4, 0, "FLOAT")
        seen.dimensions = region.width * region.height * 4
        pixels = np.array(seen, np.float32).reshape(region.height, region.width, 4)[..., :3]
        refinement = engine.surfel_state.refinement
        calls.append((refinement.is_drawing, refinement.samples, pixels))

    return watching


def summary():
    """Of each call: whether it left a picture unfinished, its samples, the share of pixels that the object covers, and
    the largest difference from the call before."""
    background = calls[-1][2][2, 2]
    found, before = [], calls[0][2]
    for is_unfinished, samples, pixels in calls:
        covered = float((np.abs(pixels - background).max(axis=-1) > 0.02).mean())
        change = float(np.abs(pixels - before).max())
        found.append({"is_unfinished": is_unfinished, "samples": samples, "covered": covered, "change": change})
        before = pixels
    return found


def turn(space, angle):
    space.region_3d.view_rotation = space.region_3d.view_rotation @ Quaternion((0, 0, 1), angle)


def until_at_rest(samples):
    is_at_rest = lambda: calls and calls[-1][1] == samples and not calls[-1][0]  # noqa: E731
    yield from until(is_at_rest, "the view comes to rest")


def some_calls():
    until_now = len(calls)
    yield from until(lambda: len(calls) >= until_now + CALLS, f"the view is drawn {CALLS} times")


def steps():
    """Yields the seconds to wait after each step, and returns the report."""
    scene = bpy.context.scene
    settings = scene.surfel_splatting
    scene.render.engine, settings.viewport_samples, settings.viewport_rate = "SURFEL_SPLATTING", 2, 10
    settings.detail_tolerance = 0
    bpy.data.objects.remove(bpy.data.objects["Cube"])
    made = bpy.data.objects.new("torus", write_surfels("torus", scenes.torus(COUNT)[0].surfels[0].surfels))
    scene.collection.objects.link(made)
    area, _ = view3d()
    space = area.spaces[0]
    space.overlay.show_overlays, space.show_gizmo, space.show_region_header = False, False, False
    space.shading.type = "RENDERED"
    space.region_3d.view_distance = 5
    yield from until_at_rest(2)
    report = {"rest": summary()}
    at_rest = calls[-1][2]
    calls.clear()
    for _ in range(TURNS):
        turn(space, TURN)
        yield from some_calls()
    yield from until_at_rest(2)
    report["turning"] = summary()
    turn(space, -TURNS * TURN)
    yield from some_calls()
    calls.clear()
    settings.viewport_rate = 0
    yield from until_at_rest(2)
    report["at_once"] = summary()
    report["apart"] = float(np.abs(calls[-1][2] - at_rest).max())
    return report


viewport.Pace = partial(Pace, clock=Clock())
viewport.draw = watch(viewport.draw)
splat_addon.register()
play(steps())
