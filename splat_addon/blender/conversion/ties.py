# SPDX-License-Identifier: GPL-3.0-or-later
"""Ties a new surfel object to its sources: it records them, follows them, and replaces them in renders."""

from __future__ import annotations

import bpy
import numpy as np

from ..ids import OBJECT_SETTINGS
from ..meshes.mesh_extraction import is_unread
from .animation import animated_paths
from .as_rendered import as_rendered, differing_levels
from .bring_back import hide_source, is_disabled_in_renders
from .changed_sources import remember_shapes
from .following import follow, follow_visibility
from .made_of import forget
from .object_info import sentences_about
from .other_engines import show_new
from .placement import placed
from .shape_following import follow_shape, is_bent
from .source_record import keep_record, record_of


def tie(conversion, made: bpy.types.Object, kind: str, settings, follows: bool, hides: bool) -> list[str]:
    """Tie an object to its sources. If renders show none of them, such as the cutter of a Boolean, they do not show it.

    conversion: placed as `made`.
    kind, settings: of the record.
    follows: whether it follows its source.
    hides: whether its sources are hidden for as long as it exists.
    Returns a sentence for each respect in which it does not follow or is not shown.
    """
    notes = []
    keep_record(made, conversion.sources, kind, settings)
    matrix_world, _ = placed(conversion.matrix_world, conversion.surfels.origin)
    forget()
    record_of(made).hides_sources = hides
    keep_unread(made, conversion)
    if follows:
        unit = float(np.median(conversion.surfels.scales)) * min(map(abs, matrix_world.to_scale()))
        follow(made, conversion.sources[0], matrix_world, unit)
        notes = [*follow_visibility(made, conversion.sources), *tie_shape(conversion, made, kind)]
    if are_never_rendered(conversion.sources):
        made.hide_render, made.display_type = True, conversion.sources[0].display_type
        notes.append(f"{made.name!r} is disabled in renders, as its source is")
    for source in conversion.sources:
        notes += sentences_about(source, made, bpy.context.scene)
        # an earlier choice about how to render the source must not show it beside its surfels
        getattr(source, OBJECT_SETTINGS).render_as = "SCENE"
        if hides:
            hide_source(source)
    show_new(made, matrix_world, bpy.context.view_layer)
    return notes


def are_never_rendered(sources: list[bpy.types.Object]) -> bool:
    """Whether renders show none of some objects, whatever the frame and apart from conversions that hid them."""
    return all(is_disabled_in_renders(each) and "hide_render" not in animated_paths(each) for each in sources)


def keep_unread(made: bpy.types.Object, conversion) -> None:
    """Record in a surfel object which inputs could be baked."""
    record_of(made).unread = "\n".join(filter(is_unread, conversion.notes))


def tie_shape(conversion, made: bpy.types.Object, kind: str) -> list[str]:
    """Make the surfels follow the deformation of their source; returns sentences like `tie`."""
    [source, *_], why = conversion.sources, None
    if kind == "MESH":
        with as_rendered(conversion.sources, bpy.context) as depsgraph:
            why = follow_shape(made, conversion, depsgraph)
    remember_shapes(made, bpy.context.evaluated_depsgraph_get())
    if why:
        return [f"What bends {source.name!r} does not bend its surfels: {why}"]
    if is_bent(made) and (differing := differing_levels(source)):
        return [f"The surfels are bent in renders only: {differing} has other levels in the viewport"]
    return []
