# SPDX-License-Identifier: GPL-3.0-or-later
"""How many surfels a mesh will become, known before the conversion and cheap enough for the sidebar.

The count is a projected area over the spacing squared, so only the area and the longest edge of each evaluated mesh
are kept, and a coarse outline where a camera is to decide. They are measured by a timer shortly after they are first
asked for, never while drawing, and forgotten when the depsgraph tells that the geometry changed.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import bpy
from bpy.app.handlers import persistent

from ..sampling import Outline, drop_unusable, grid_spacing, outline, projected_area
from .conversion import Choices
from .mesh_extraction import extract_triangles

#: Waiting this long gathers the changes of a stroke or a drag into one measurement.
_DELAY_SECONDS = 0.2


@dataclass(frozen=True, eq=False)
class Extent:
    """area: projected area. longest_edge: of the bounding box. Object units, both 0 for nothing usable.
    surface: its outline, where the choices need it."""

    area: float
    longest_edge: float
    surface: Outline | None = None

    def predict(self, fineness: dict[str, float]) -> tuple[int, float]:
        """(surfels, spacing) for a resolution, spacing or count; both 0 where that is 0 or nothing is usable."""
        ((kind, value),) = fineness.items()
        spacing = _SPACINGS[kind](self, value) if value > 0 else 0.0
        return (round(self.area / spacing**2), spacing) if spacing > 0 else (0, 0.0)


#: kind of fineness -> spacing from the extent and a value above 0
_SPACINGS = {
    "resolution": lambda extent, value: extent.longest_edge / value,
    "spacing": lambda extent, value: value,
    "count": lambda extent, value: math.sqrt(extent.area / value),
}


def measure(source: bpy.types.Object, depsgraph: bpy.types.Depsgraph, choices: Choices) -> Extent:
    """The extent of a mesh object with its modifiers; not fast: 0.3 s for a million triangles."""
    mesh, _ = drop_unusable(extract_triangles(source, depsgraph))
    surface = outline(mesh) if "pixels" in choices.fineness else None
    if not len(mesh):
        return Extent(0.0, 0.0, surface)
    area = projected_area(mesh, choices.reduction, choices.grazing_angle)
    return Extent(area, grid_spacing(mesh, resolution=1), surface)


def known_extents(sources: list[bpy.types.Object], choices: Choices) -> list[Extent] | None:
    """Those of all sources, or None while some are still to be measured, for which the timer is started."""
    keys = [_key(source, choices) for source in sources]
    missing = [key for key in keys if key not in _extents]
    if not missing:
        return [_extents[key] for key in keys]
    _wanted.update({key: choices for key in missing})
    if not bpy.app.timers.is_registered(_measure_wanted):
        bpy.app.timers.register(_measure_wanted, first_interval=_DELAY_SECONDS)
    return None


def _key(source: bpy.types.Object, choices: Choices) -> tuple:
    """The object's session_uid, and the choices that make a difference to its extent."""
    return source.session_uid, choices.reduction, choices.grazing_angle, "pixels" in choices.fineness


#: key of an object and choices -> its extent, as long as that is true
_extents: dict[tuple, Extent] = {}

#: keys that the sidebar asked for, and the choices that they were made of
_wanted: dict[tuple, Choices] = {}


def _measure_wanted() -> None:
    depsgraph = bpy.context.evaluated_depsgraph_get()
    sources = {source.session_uid: source for source in bpy.context.view_layer.objects}
    for key, choices in _wanted.items():
        source = sources.get(key[0])
        if source is not None and source.type == "MESH" and source.mode == "OBJECT":
            _extents[key] = measure(source, depsgraph, choices)
    _wanted.clear()
    for window in bpy.context.window_manager.windows:
        for area in window.screen.areas:
            if area.type == "VIEW_3D":
                area.tag_redraw()


@persistent
def forget_changed(scene, depsgraph):
    """Drop what a depsgraph update made untrue."""
    changed = {
        update.id.original.session_uid
        for update in depsgraph.updates
        if update.is_updated_geometry and isinstance(update.id, bpy.types.Object)
    }
    for key in [key for key in _extents if key[0] in changed]:
        del _extents[key]


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
