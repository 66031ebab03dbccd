# SPDX-License-Identifier: GPL-3.0-or-later
"""How many surfels a mesh will become, known before the conversion and cheap enough for the sidebar.

The count is a projected area over the spacing squared, so only the area and the longest edge of each evaluated mesh
are kept. They are measured by a timer shortly after they are first asked for, never while drawing, and forgotten
when the depsgraph tells that the geometry changed.
"""

from __future__ import annotations

from dataclasses import dataclass

import bpy
from bpy.app.handlers import persistent

from ..sampling import drop_unusable, grid_spacing, projected_area
from .mesh_extraction import extract_triangles

#: Waiting this long gathers the changes of a stroke or a drag into one measurement.
_DELAY_SECONDS = 0.2


@dataclass(frozen=True)
class Extent:
    """area: projected area, longest_edge: of the bounding box; object units, both 0 for nothing usable."""

    area: float
    longest_edge: float

    def predict(self, fineness: dict[str, float]) -> tuple[int, float]:
        """(surfels, spacing) for {"resolution": r} or {"spacing": h}; both 0 where that is 0 or nothing is usable."""
        spacing = fineness.get("spacing") or self.longest_edge / (fineness.get("resolution") or float("inf"))
        return (round(self.area / spacing**2), spacing) if spacing > 0 else (0, 0.0)


def measure(source: bpy.types.Object, depsgraph: bpy.types.Depsgraph) -> Extent:
    """The extent of a mesh object with its modifiers; not fast: 0.3 s for a million triangles."""
    mesh, _ = drop_unusable(extract_triangles(source, depsgraph))
    return Extent(projected_area(mesh), grid_spacing(mesh, resolution=1)) if len(mesh) else Extent(0.0, 0.0)


def known_extents(sources: list[bpy.types.Object]) -> list[Extent] | None:
    """Those of all sources, or None while some are still to be measured, for which the timer is started."""
    missing = [source.session_uid for source in sources if source.session_uid not in _extents]
    if not missing:
        return [_extents[source.session_uid] for source in sources]
    _wanted.update(missing)
    if not bpy.app.timers.is_registered(_measure_wanted):
        bpy.app.timers.register(_measure_wanted, first_interval=_DELAY_SECONDS)
    return None


#: session_uid of an object -> its extent, as long as that is true
_extents: dict[int, Extent] = {}

#: session_uids that the sidebar asked for
_wanted: set[int] = set()


def _measure_wanted() -> None:
    depsgraph = bpy.context.evaluated_depsgraph_get()
    for source in bpy.context.view_layer.objects:
        if source.session_uid in _wanted and source.type == "MESH" and source.mode == "OBJECT":
            _extents[source.session_uid] = measure(source, depsgraph)
    _wanted.clear()
    for window in bpy.context.window_manager.windows:
        for area in window.screen.areas:
            if area.type == "VIEW_3D":
                area.tag_redraw()


@persistent
def forget_changed(scene, depsgraph):
    """Drop what a depsgraph update made untrue."""
    for update in depsgraph.updates:
        if update.is_updated_geometry and isinstance(update.id, bpy.types.Object):
            _extents.pop(update.id.original.session_uid, None)


@persistent
def forget_all(*_):
    """Drop everything: another file, or another point in its history."""
    _extents.clear()


_HANDLERS = (
    (bpy.app.handlers.depsgraph_update_post, forget_changed),
    (bpy.app.handlers.frame_change_post, forget_changed),
    (bpy.app.handlers.undo_post, forget_all),
    (bpy.app.handlers.redo_post, forget_all),
    (bpy.app.handlers.load_post, forget_all),
)


def register():
    for handlers, function in _HANDLERS:
        handlers.append(function)


def unregister():
    for handlers, function in _HANDLERS:
        handlers.remove(function)
    if bpy.app.timers.is_registered(_measure_wanted):
        bpy.app.timers.unregister(_measure_wanted)
    forget_all()
