# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs a job where a device can be opened: for Blender's device that is inside a render, because background mode has a
graphics context nowhere else."""

from __future__ import annotations

from collections.abc import Callable


def run_on(device: str | None, job: Callable[[], None]) -> None:
    """Run the job where `open_device(device)` works. Raises what the job raises."""
    if device != "blender":
        return job()
    import bpy

    errors = []

    class JobEngine(bpy.types.RenderEngine):
        bl_idname, bl_label, bl_use_gpu_context = "MEASURE_JOB", "Measure", True

        def render(self, depsgraph):
            try:
                job()
            except BaseException as error:
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
