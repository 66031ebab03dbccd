# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs a job where a device can be opened: Blender's inside a render of its wheel, for in background mode there is a
graphics context nowhere else.
"""

from __future__ import annotations

from collections.abc import Callable


def inside_a_render(job: Callable[[], None]) -> None:
    """Raises what the job raised."""
    import bpy

    errors = []

    class JobEngine(bpy.types.RenderEngine):
        bl_idname, bl_label, bl_use_gpu_context = "MEASURE_JOB", "Measure", True

        def render(self, depsgraph):
            try:
                job()
            except Exception as error:
                errors.append(error)

    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    scene.camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    bpy.utils.register_class(JobEngine)
    scene.render.engine = "MEASURE_JOB"
    scene.render.resolution_x = scene.render.resolution_y = 4
    bpy.ops.render.render()
    if errors:
        raise errors[0]


def run_on(device: str, job: Callable[[], None]) -> None:
    """The job, where `open_device(device)` works. Raises what the job raised."""
    if device == "standalone":
        job()
    else:
        inside_a_render(job)
