# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfels or their sources: hiding the surfels shows the sources, in every engine, and showing them replaces these."""

from __future__ import annotations

import bpy

from .bring_back import hide_source, show_source
from .source_record import record_of, sources_of
from .ties import are_never_rendered


def are_shown(made: bpy.types.Object) -> bool:
    """Whether a surfel object is seen in the active view layer."""
    return not made.hide_get()


def show_sources(made: bpy.types.Object) -> None:
    """Hide surfels, and show what they were made of."""
    for source in sources_of(made):
        show_source(source)
    made.hide_set(True)
    made.hide_render = True


def show_surfels(made: bpy.types.Object) -> None:
    """Show surfels in place of their sources, as after the conversion."""
    sources = sources_of(made)
    made.hide_render = are_never_rendered(sources)
    made.hide_set(False)
    if record_of(made).hides_sources:
        for source in sources:
            hide_source(source)
