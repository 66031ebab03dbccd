# SPDX-License-Identifier: GPL-3.0-or-later
"""Other engines and shading modes show what surfels were made of, and the surfels as points only where that is hidden,
gone or elsewhere: never points over the surface that they stand for."""

from __future__ import annotations

import bpy
import numpy as np
from mathutils import Matrix

from ..doors import unattended, with_handlers
from ..geometry.points_proxy import let_others_see
from .made_of import converted
from .source_record import record_of, sources_of

#: The difference of two matrices that is no other place: rounding, in the source's units.
_SAME_PLACE = 1e-3


def show_new(made: bpy.types.Object, matrix_world: Matrix, view_layer: bpy.types.ViewLayer) -> None:
    """Let other engines show either new surfels or their sources, and record where they are. matrix_world: of `made`,
    whose own is outdated."""
    sources = sources_of(made)
    record_of(made).place = np.array(sources[0].matrix_world.inverted_safe() @ matrix_world).ravel()
    let_others_see(made, not _are_shown(sources, view_layer))


def _show_one(made: bpy.types.Object, view_layer: bpy.types.ViewLayer) -> None:
    """Let other engines show either a surfel object or its sources, or both if they are apart."""
    sources = sources_of(made)
    let_others_see(made, not (_are_shown(sources, view_layer) and _is_in_place(made, sources[0])))


def _is_in_place(made: bpy.types.Object, source: bpy.types.Object) -> bool:
    """Whether surfels are where their source is; those of files without a record of their place are taken to be."""
    kept = np.array(record_of(made).place)
    now = np.array(source.matrix_world.inverted_safe() @ made.matrix_world).ravel()
    return not kept.any() or np.allclose(now, kept, rtol=_SAME_PLACE, atol=_SAME_PLACE)


def _are_shown(sources: list[bpy.types.Object], view_layer: bpy.types.ViewLayer) -> bool:
    return any(not each.hide_render and each.visible_get(view_layer=view_layer) for each in sources)


@unattended("Showing surfels to other engines")
def _after_update(scene, depsgraph) -> None:
    """Look again when objects may have been moved; hiding, showing and deleting them are updates of the scene."""
    if any(isinstance(update.id, bpy.types.Scene | bpy.types.Object) for update in depsgraph.updates):
        for made in converted():
            if made.library is None:
                _show_one(made, depsgraph.view_layer)


register, unregister = with_handlers((bpy.app.handlers.depsgraph_update_post, _after_update))
