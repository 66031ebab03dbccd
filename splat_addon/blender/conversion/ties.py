# SPDX-License-Identifier: GPL-3.0-or-later
"""A new surfel object is tied to what it was made of: it knows it, follows it, and stands in its place."""

from __future__ import annotations

import bpy
import numpy as np
from mathutils import Matrix

from ..ids import OBJECT_SETTINGS
from .bring_back import hide_source
from .following import follow
from .source_record import keep_record


def tie(conversion, made: bpy.types.Object, kind: str, settings, follows: bool, hides: bool) -> None:
    """conversion: placed as `made`. kind, settings: of the record. follows: it goes where its source goes. hides: its
    sources are hidden for as long as it is there."""
    keep_record(made, conversion.sources, kind, settings)
    if follows:
        matrix_world = conversion.matrix_world @ Matrix.Translation(conversion.surfels.origin)
        unit = float(np.median(conversion.surfels.scales)) * min(map(abs, matrix_world.to_scale()))
        follow(made, conversion.sources[0], matrix_world, unit)
    for source in conversion.sources:
        # what was chosen for its earlier form does not keep it beside its surfels
        getattr(source, OBJECT_SETTINGS).render_as = "SCENE"
        if hides:
            hide_source(source)
