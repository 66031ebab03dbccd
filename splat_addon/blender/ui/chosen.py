# SPDX-License-Identifier: GPL-3.0-or-later
"""What the sidebar is about: the active object, or else the first that is selected, and all selected ones like it."""

from __future__ import annotations

from typing import NamedTuple

import bpy

from ..conversion.made_of import surfels_of
from ..conversion.source_record import sources_of
from ..geometry.points_extraction import has_points
from ..geometry.sources import has_surfaces, is_surfel_object
from ..geometry.surfel_files import file_of
from ..ids import SURFELS_FROM_MESH, SURFELS_FROM_POINTS, UPDATE_SURFELS
from ..spoken import said


class Kind(NamedTuple):
    """operator: what the large button does. icon: of the status line."""

    operator: str
    icon: str


NOTHING = Kind(SURFELS_FROM_MESH, "INFO")
MESHES = Kind(SURFELS_FROM_MESH, "OUTLINER_OB_MESH")
POINTS = Kind(SURFELS_FROM_POINTS, "OUTLINER_OB_POINTCLOUD")
SURFELS = Kind(UPDATE_SURFELS, "OUTLINER_OB_POINTCLOUD")


class Chosen(NamedTuple):
    """kind: what it is. lead: the object. made: its surfels if it has some, or if it is surfels. source: what they were
    made of, if it is in the file."""

    kind: Kind = NOTHING
    lead: bpy.types.Object | None = None
    made: bpy.types.Object | None = None
    source: bpy.types.Object | None = None

    @property
    def can_update(self) -> bool:
        return self.source is not None


def chosen(context: bpy.types.Context) -> Chosen:
    """What is chosen in a context."""
    active, selected = context.active_object, context.selected_objects
    lead = active if active is not None and active.select_get() else next(iter(selected), None)
    if lead is None:
        return Chosen()
    made = lead if is_surfel_object(lead) else next(iter(surfels_of(lead)), None)
    if made is not None:
        return Chosen(SURFELS, lead, made, next(iter(sources_of(made)), None))
    if is_scan(lead, context):
        return Chosen(POINTS, lead)
    return Chosen(MESHES, lead) if has_surfaces(lead) else Chosen()


def is_scan(owner: bpy.types.Object, context: bpy.types.Context) -> bool:
    """Whether an object is bare points: a point cloud, or a mesh with points and without faces as its modifiers make
    it."""
    if not has_points(owner) or owner.type != "MESH":
        return owner.type == "POINTCLOUD"
    # in edit mode the evaluated mesh is not there yet
    shown = owner.data if owner.mode == "EDIT" else owner.evaluated_get(context.view_layer.depsgraph).data
    return len(owner.data.vertices) > 0 and not shown.polygons


def status(what: Chosen) -> str:
    """The line above the button: how many surfels or points there are, if any."""
    if what.kind is NOTHING:
        return said("Select a mesh or a scan")
    if what.kind is MESHES:
        return said("No surfels of {name} yet", name=what.lead.name)
    if what.kind is POINTS:
        data = what.lead.data
        count = len(data.vertices if what.lead.type == "MESH" else data.points)
        return said("{count:,} points in {name}", count=count, name=what.lead.name)
    if file_of(what.made):
        return said("Surfels in a file: {name}", name=what.made.name)
    name = what.source.name if what.source else what.made.name
    return said("{count:,} surfels of {name}", count=len(what.made.data.vertices), name=name)
