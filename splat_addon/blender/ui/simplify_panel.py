# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's Simplify, in its place among this engine's panels: Blender's own class would come before all of them."""

from __future__ import annotations

import bpy
from bl_ui import properties_render as stock

from .engine_panel import EnginePanel


class RENDER_PT_surfel_simplify(EnginePanel, bpy.types.Panel):
    bl_label = "Simplify"
    bl_context = "render"
    bl_options = frozenset({"DEFAULT_CLOSED"})

    draw_header = stock.RENDER_PT_simplify.draw_header

    def draw(self, context):
        pass


class RENDER_PT_surfel_simplify_viewport(EnginePanel, bpy.types.Panel):
    bl_label = "Viewport"
    bl_context = "render"
    bl_parent_id = "RENDER_PT_surfel_simplify"

    draw = stock.RENDER_PT_simplify_viewport.draw


class RENDER_PT_surfel_simplify_render(EnginePanel, bpy.types.Panel):
    bl_label = "Render"
    bl_context = "render"
    bl_parent_id = "RENDER_PT_surfel_simplify"

    draw = stock.RENDER_PT_simplify_render.draw


SIMPLIFY = (RENDER_PT_surfel_simplify, RENDER_PT_surfel_simplify_viewport, RENDER_PT_surfel_simplify_render)
