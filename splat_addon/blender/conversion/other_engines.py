# SPDX-License-Identifier: GPL-3.0-or-later
"""Other engines and shading modes show what surfels were made of, and the surfels as points only where that is hidden
or gone: never points over the surface that they stand for."""

from __future__ import annotations

import bpy

from ..doors import unattended, with_handlers
from ..geometry.points_proxy import let_others_see
from .made_of import converted
from .source_record import sources_of


def show_one(made: bpy.types.Object, view_layer: bpy.types.ViewLayer) -> None:
    """Let other engines show either a surfel object or its sources."""
    let_others_see(made, not any(_is_shown(source, view_layer) for source in sources_of(made)))


def _is_shown(source: bpy.types.Object, view_layer: bpy.types.ViewLayer) -> bool:
    return not source.hide_render and source.visible_get(view_layer=view_layer)


@unattended("Showing surfels to other engines")
def _after_update(scene, depsgraph) -> None:
    """Look again when objects may have been hidden, shown or deleted, all of which are updates of the scene."""
    if any(isinstance(update.id, bpy.types.Scene) for update in depsgraph.updates):
        for made in converted():
            if made.library is None:
                show_one(made, depsgraph.view_layer)


register, unregister = with_handlers((bpy.app.handlers.depsgraph_update_post, _after_update))
