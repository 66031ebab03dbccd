# SPDX-License-Identifier: GPL-3.0-or-later
"""Predicts how many surfels a conversion will make, cheaply enough for the sidebar.

The count is a projected area over the spacing squared, less what large surfels spare. Of each evaluated mesh, only the
area, the longest edge and the extents of its flat faces are kept, and a coarse outline if a camera decides the density.
A timer measures them shortly after they are first needed, never while drawing, and they are forgotten when the
depsgraph reports a change of geometry.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import bpy
import numpy as np

from ...sampling import (
    NO_FLAT_EXTENTS,
    FlatExtents,
    Outline,
    drop_strays,
    drop_unusable,
    grid_spacing,
    outline,
    projected_area,
)
from ..density import Density, Measure
from ..doors import unattended, with_handlers
from ..geometry.sources import has_surfaces
from ..meshes.mesh_extraction import read_without_pixels
from .choices import Choices
from .gathering import frame_of, gather
from .mesh_conversion import flat_places
from .placement import relative

#: Delay that combines the changes of a stroke or a drag into one measurement. A sidebar that opens fades in meanwhile.
_DELAY_SECONDS = 0.2
#: Further delay, in which what has faded in is drawn: a measurement would leave it half there for as long as it takes.
_DRAWING_SECONDS = 0.01


@dataclass(frozen=True, eq=False)
class Extent:
    """area: projected area.
    longest_edge: of the bounding box. Both are in units of the result, and 0 if nothing is usable.
    surface: its outline, if the settings need it.
    flat: its flat faces, in which large surfels replace others.
    others: session_uids of further objects that are part of it.
    """

    area: float
    longest_edge: float
    surface: Outline | None = None
    flat: FlatExtents = NO_FLAT_EXTENTS
    others: frozenset[int] = frozenset()

    def predict(self, density: Density) -> tuple[int, float]:
        """(surfels, spacing) for a resolution, spacing or count; both 0 if that is 0 or nothing is usable."""
        spacing = _SPACINGS[density.measure](self, density.value) if density.value > 0 else 0.0
        return (round(self.area / spacing**2 - self.flat.saved(spacing)), spacing) if spacing > 0 else (0, 0.0)


#: The extent of an object that cannot be converted.
NOTHING = Extent(0.0, 0.0, Outline(np.zeros((0, 3)), 0.0, 0.0))

#: spacing from the extent and a value above 0
_SPACINGS = {
    Measure.RESOLUTION: lambda extent, value: extent.longest_edge / value,
    Measure.SPACING: lambda extent, value: value,
    Measure.COUNT: lambda extent, value: math.sqrt(extent.area / value),
}


def measure(sources: list[bpy.types.Object], depsgraph: bpy.types.Depsgraph, choices: Choices) -> Extent:
    """The extent of all sources together; this is slow: 0.3 s for a million triangles."""
    try:
        gathered = gather(sources, depsgraph, choices.in_world_units, read_without_pixels)
    except ValueError:
        return NOTHING
    mesh, _ = drop_strays(drop_unusable(gathered.mesh)[0])
    if not len(mesh):
        return NOTHING
    surface = outline(mesh) if choices.asks_camera else None
    area = projected_area(mesh, choices.reduction, choices.grazing_angle)
    flat = flat_places(mesh, choices, sources, gathered.unread)
    return Extent(area, grid_spacing(mesh, resolution=1), surface, flat, gathered.others)


def known_extents(groups: list[list[bpy.types.Object]], choices: Choices) -> list[Extent] | None:
    """The extents of all groups of sources, or None while some still have to be measured, which starts the timer."""
    keys = [_key(sources, choices) for sources in groups]
    missing = [key for key in keys if key not in _extents]
    if not missing:
        return [_extents[key] for key in keys]
    _wanted.update({key: choices for key in missing})
    if not any(map(bpy.app.timers.is_registered, _TIMERS)):
        bpy.app.timers.register(_wait_for_drawing, first_interval=_DELAY_SECONDS)
    return None


def _key(sources: list[bpy.types.Object], choices: Choices) -> tuple:
    """The sources' session_uids, and those parts of their transforms, materials and settings that affect the extent."""
    try:
        frame = frame_of(sources[0], choices.in_world_units)
        maps = (relative(np.array(source.matrix_world, np.float64), frame) for source in sources)
        places = tuple(float(f"{value:.4g}") for matrix in maps for value in matrix.ravel())
    except ValueError:
        places = ()
    uids = tuple(source.session_uid for source in sources)
    plain = uids, places, choices.reduction, choices.grazing_angle, choices.asks_camera, choices.in_world_units
    if choices.tolerance is None:
        return plain
    looks = tuple(_look(slot.material) for source in sources for slot in source.material_slots)
    return *plain, looks, choices.texture_mapped, choices.bake


def _look(material: bpy.types.Material | None) -> tuple:
    """What changes if an image comes into a material."""
    if material is None:
        return ()
    tree = material.node_tree
    return material.session_uid, *((len(tree.nodes), len(tree.links)) if tree else ())


#: key of sources and settings -> their extent, until it becomes outdated
_extents: dict[tuple, Extent] = {}

#: keys that the sidebar needs, and the settings that they belong to
_wanted: dict[tuple, Choices] = {}


@unattended("Counting surfels for the sidebar")
def _wait_for_drawing() -> None:
    """Measure in a later round of Blender's main loop; this one ends with drawing."""
    bpy.app.timers.register(_measure_wanted, first_interval=_DRAWING_SECONDS)


@unattended("Counting surfels for the sidebar")
def _measure_wanted() -> None:
    depsgraph = bpy.context.evaluated_depsgraph_get()
    objects = {object_.session_uid: object_ for object_ in bpy.context.view_layer.objects}
    wanted = dict(_wanted)
    _wanted.clear()
    for key, choices in wanted.items():
        sources = [objects.get(uid) for uid in key[0]]
        if all(source is not None and has_surfaces(source) and source.mode == "OBJECT" for source in sources):
            _extents[key] = measure(sources, depsgraph, choices)
    for window in bpy.context.window_manager.windows:
        for area in window.screen.areas:
            if area.type == "VIEW_3D":
                area.tag_redraw()


#: In the order in which they run.
_TIMERS = _wait_for_drawing, _measure_wanted


@unattended("Following changes for the sidebar")
def forget_changed(scene, depsgraph):
    """Drop the extents that a depsgraph update invalidates."""
    updates = [update for update in depsgraph.updates if isinstance(update.id, bpy.types.Object)]
    changed = {update.id.original.session_uid for update in updates if update.is_updated_geometry}
    touched = changed | {update.id.original.session_uid for update in updates if update.is_updated_transform}
    # collection instances also change with the collection's members
    is_regrouped = any(isinstance(update.id, bpy.types.Collection) for update in depsgraph.updates)
    for key, extent in list(_extents.items()):
        if changed & set(key[0]) or touched & extent.others or (is_regrouped and extent.others):
            del _extents[key]


@unattended("Forgetting counts for the sidebar")
def forget_all(*_):
    """Drop everything after loading another file, undo or redo."""
    _extents.clear()


register, _unregister_handlers = with_handlers(
    (bpy.app.handlers.depsgraph_update_post, forget_changed),
    (bpy.app.handlers.frame_change_post, forget_changed),
    (bpy.app.handlers.undo_post, forget_all),
    (bpy.app.handlers.redo_post, forget_all),
    (bpy.app.handlers.load_post, forget_all),
)


def unregister():
    _unregister_handlers()
    for timer in filter(bpy.app.timers.is_registered, _TIMERS):
        bpy.app.timers.unregister(timer)
    forget_all()
