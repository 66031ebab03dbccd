# SPDX-License-Identifier: GPL-3.0-or-later
"""Shows converted surfels with one click: sets the render engine and the 3D view's shading."""

from __future__ import annotations

import bpy

from ..doors import register_classes_factory
from ..ids import ENGINE, ENGINE_LABEL, SHOW_SURFELS


def shows_surfels(context: bpy.types.Context) -> bool:
    """Whether the engine is active and the 3D view, if the context has one, renders with it."""
    space = context.space_data
    is_rendered = space is None or space.type != "VIEW_3D" or space.shading.type == "RENDERED"
    return context.scene.render.engine == ENGINE and is_rendered


class VIEW3D_OT_surfels_show(bpy.types.Operator):
    """Switch to Surfel Splatting as the render engine, and to Rendered shading in this 3D view"""

    bl_idname = SHOW_SURFELS
    bl_label = f"Show with {ENGINE_LABEL}"
    bl_options = {"REGISTER", "UNDO"}  # noqa: RUF012 - Blender reads a set

    def execute(self, context):
        context.scene.render.engine = ENGINE
        space = context.space_data
        if space is not None and space.type == "VIEW_3D":
            space.shading.type = "RENDERED"
        return {"FINISHED"}


register, unregister = register_classes_factory((VIEW3D_OT_surfels_show,))
