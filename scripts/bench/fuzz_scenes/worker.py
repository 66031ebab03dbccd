# SPDX-License-Identifier: GPL-3.0-or-later
"""The watched process: makes random scenes, exports them, draws some, and writes a line of JSON for each step.

`python -m bench.fuzz_scenes.worker FIRST COUNT EVERY`: cases FIRST to FIRST + COUNT - 1, of which each EVERYth is drawn
and converted.
"""

from __future__ import annotations

import faulthandler
import json
import os
import sys
import time
import traceback
from collections.abc import Callable

import bpy
import numpy as np

try:
    import resource
except ImportError:  # on Windows
    resource = None

import splat_addon
from environment.leaving import run_and_leave
from splat_addon.blender import doors
from splat_addon.blender.cameras import final_camera
from splat_addon.blender.engine import final_render
from splat_addon.blender.engine.exchange import exchanging
from splat_addon.blender.engine.render_passes import outputs_of
from splat_addon.blender.export.live_meshes import LiveMeshes
from splat_addon.blender.export.scene import export_scene
from splat_addon.blender.export.surfel_store import SurfelStore
from splat_addon.blender.properties import final_settings, viewport_settings
from splat_addon.faults import is_worded, sentence_of
from splat_addon.rendering import Camera, plan

from . import HANG
from .extremes import Chance
from .random_scene import build, settings

#: Bytes that the process may take.
MOST_BYTES = 8 << 30

#: The beginning of the sentence about an exception that nobody worded.
FAULT = "This is a fault of the extension"


class Case:
    """One random scene, and what went wrong with it. tell: takes a record for the watcher."""

    def __init__(self, number: int, tell: Callable[[dict], None]):
        self.number, self._tell = number, tell
        self.by, self.seconds = Chance(number), {}
        self.unworded: list[str] = []
        self.left_out: list[str] = []
        self.not_finite = self.pictures = 0

    def run(self, is_drawn: bool) -> None:
        """Make the scene and export it with each of its cameras; draw it, and convert its objects."""
        bpy.ops.wm.read_factory_settings(use_empty=True)
        scene = bpy.context.scene
        scene.render.engine = "SURFEL_SPLATTING"
        scene.surfel_splatting.broken_objects = "WARN"
        held = self._step("build", lambda: build(self.by))
        self._step("set up", lambda: settings(self.by, scene))
        self._step("evaluate", lambda: scene.frame_set(self.by.pick((-5, 0, 1, 7))))
        self._step("export", self._export)
        if is_drawn:
            self._step("draw", self._draw)
            self._step("convert", self._convert)
        self._tell({"case": self.number, "held": held, "seconds": self.seconds, "unworded": self.unworded,
                    "left_out": self.left_out,
                    "not_finite": self.not_finite, "pictures": self.pictures})  # fmt: skip

    def _step(self, name: str, job: Callable):
        self._tell({"case": self.number, "step": name})
        started = time.process_time()
        try:
            return job()
        finally:
            self.seconds[name] = time.process_time() - started

    def _export(self) -> None:
        scene, depsgraph = bpy.context.scene, bpy.context.evaluated_depsgraph_get()
        store, live_meshes = SurfelStore(), LiveMeshes()
        store.begin_frame()
        live_meshes.begin_frame()
        told = len(doors.told)
        exported, notes = self._tried(lambda: export_scene(depsgraph, store, live_meshes)) or (None, None)
        self.unworded += [sentence for sentence in (*(notes.counts if notes else ()), *doors.told[told:])
                          if FAULT in sentence]  # fmt: skip
        self.left_out = notes.left_out if notes else []
        layer = scene.view_layers[0]
        chosen = self._tried(lambda: final_settings(layer, scene, outputs_of(layer)))
        self._tried(lambda: viewport_settings(scene))
        for each in [each for each in scene.objects if each.type == "CAMERA"]:
            camera = self._tried(lambda each=each: final_camera(depsgraph, each.evaluated_get(depsgraph)))
            if exported and chosen and isinstance(camera, Camera):
                self._tried(lambda camera=camera: plan(exported, camera, chosen))
            scene.camera = each

    def _tried(self, job: Callable):
        try:
            return job()
        except Exception as error:
            if not is_worded(error):
                self.unworded.append(sentence_of(error))
            return None

    def _draw(self) -> None:
        def look(layer: str, view: str, frame) -> None:
            self.pictures += 1
            for name in ("color", "depth", "normal", "coverage", "position", "emission", "diffuse_color", "shadow"):
                values = getattr(frame, name)
                self.not_finite += 0 if values is None else int(np.count_nonzero(~np.isfinite(values)))

        with exchanging(kept=look):
            self._called(bpy.ops.render.render)
        self.unworded += [each for each in final_render.last_frame_stats.get("notes", ()) if FAULT in each]

    def _convert(self) -> None:
        for each in bpy.context.view_layer.objects:
            each.select_set(each.type == "MESH" and not each.hide_get())
        few = {"density": "RESOLUTION", "resolution": 4}
        for operator, options in ((bpy.ops.object.surfels_from_mesh, few), (bpy.ops.object.surfels_from_points, {})):
            if operator.poll():
                self._called(operator, **options)

    def _called(self, operator, **options) -> None:
        """Call an operator, whose report of an error is a RuntimeError."""
        try:
            operator(**options)
        except RuntimeError as error:
            self.unworded += [str(error)] * (FAULT in str(error))
        except Exception as error:
            self.unworded.append(sentence_of(error))


def main(arguments: list[str]) -> int:
    first, count, every = map(int, arguments)
    lines = os.fdopen(os.dup(1), "w", encoding="utf-8")
    os.dup2(2, 1)  # what Blender prints

    def tell(record: dict) -> None:
        print(json.dumps(record), file=lines, flush=True)

    faulthandler.enable()
    if resource is not None:
        resource.setrlimit(resource.RLIMIT_AS, (MOST_BYTES, MOST_BYTES))
    splat_addon.register()
    with np.errstate(all="ignore"):
        for number in range(first, first + count):
            # a hang ends with the stack of where it was, and exit code 1
            faulthandler.dump_traceback_later(HANG, exit=True)
            try:
                Case(number, tell).run(number % every == 0)
            except Exception:
                traceback.print_exc()
                return 3
    return 0


if __name__ == "__main__":
    run_and_leave(lambda: main(sys.argv[1:]))
