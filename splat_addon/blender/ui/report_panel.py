# SPDX-License-Identifier: GPL-3.0-or-later
"""Report on the last picture: messages, statistics, times, memory, and its plan."""

from __future__ import annotations

from collections.abc import Iterator

import bpy

from ..doors import register_classes_factory
from ..engine import final_render, viewport
from ..spoken import said
from .engine_panel import EnginePanel
from .wrapped_text import write


class RENDER_PT_surfel_report(EnginePanel, bpy.types.Panel):
    bl_label = "Last Picture"
    bl_context = "render"
    #: Behind all settings, and behind Blender's Color Management, whose order is 100.
    bl_order = 200
    bl_options = frozenset({"DEFAULT_CLOSED"})

    def draw(self, context):
        stats = final_render.last_frame_stats
        for line in measured(stats):
            write(self.layout, line, context)
        for title, sentences in (("Render", stats.get("notes", [])), ("3D View", viewport.last_notes)):
            if sentences:
                box = self.layout.box()
                box.label(text=title, icon="ERROR")
                for sentence in sentences:
                    write(box, sentence, context)


class _ReportPart(EnginePanel):
    """A part of the report; it is shown if the last picture has the statistic."""

    bl_context = "render"
    bl_parent_id = "RENDER_PT_surfel_report"
    bl_options = frozenset({"DEFAULT_CLOSED"})
    statistic = ""

    @classmethod
    def poll(cls, context):
        return super().poll(context) and bool(final_render.last_frame_stats.get(cls.statistic))


class RENDER_PT_surfel_report_times(_ReportPart, bpy.types.Panel):
    bl_label = "Times"
    statistic = "passes"

    def draw(self, context):
        for name, milliseconds in final_render.last_frame_stats["passes"].items():
            self.layout.label(text=f"{name}: {milliseconds:,.1f} ms")


class RENDER_PT_surfel_report_plan(_ReportPart, bpy.types.Panel):
    bl_label = "Plan"
    statistic = "plan"

    def draw(self, context):
        for line in str(final_render.last_frame_stats["plan"]).splitlines():
            write(self.layout, line, context)


def measured(stats: dict) -> Iterator[str]:
    """Lines about a final render: what was drawn, time and memory. stats: of `final_render`."""
    if not stats:
        yield said("Nothing has been rendered yet")
        return
    yield said("Drawn: {splats_drawn:,} of {splats:,} splats, and {polygons:,} polygons", **stats)
    if stats.get("culled"):
        percent = 100 * stats["culled"] / stats["culled_of"]
        yield said("Back-facing splats left out: {culled:,} ({percent:.0f}%)", percent=percent, **stats)
    yield said("Time: {milliseconds:,.0f} ms", **stats)
    if (samples := stats.get("samples", 1)) > 1:
        yield said("Samples: {samples}", samples=samples)
    yield said("Textures on the device: {megabytes:,.1f} MB", megabytes=stats["texture_bytes"] / 1e6)
    yield said("Device: {device}, {backend}", **stats)


register, unregister = register_classes_factory(
    (RENDER_PT_surfel_report, RENDER_PT_surfel_report_times, RENDER_PT_surfel_report_plan)
)
