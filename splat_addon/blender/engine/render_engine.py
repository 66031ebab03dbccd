# SPDX-License-Identifier: GPL-3.0-or-later
"""The RenderEngine class: one-line callbacks into `final_render` and `viewport`."""

from __future__ import annotations

import bpy

from ...rendering import background
from ..doors import register_classes_factory
from ..ids import ENGINE, ENGINE_LABEL
from . import final_render, render_passes, viewport


class SurfelSplattingEngine(bpy.types.RenderEngine):
    bl_idname = ENGINE
    bl_label = ENGINE_LABEL
    bl_use_gpu_context = True
    bl_use_preview = True
    bl_use_eevee_viewport = True
    bl_use_shading_nodes_custom = False

    def update_render_passes(self, scene=None, renderlayer=None):
        render_passes.register_passes(self, scene, renderlayer)

    def render(self, depsgraph):
        # Blender ignores an exception here: only a report fails the operator and the process.
        try:
            final_render.render(self, depsgraph)
        except Exception as error:
            final_render.report_failure(self, error)

    def view_update(self, context, depsgraph):
        viewport.guarded(self, viewport.update, context, depsgraph)

    def view_draw(self, context, depsgraph):
        viewport.guarded(self, viewport.draw, context, depsgraph)


register, _unregister_classes = register_classes_factory((SurfelSplattingEngine,))


def unregister():
    background.stop()
    _unregister_classes()
