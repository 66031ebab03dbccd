# SPDX-License-Identifier: GPL-3.0-or-later
"""What an entry of a depsgraph has to be drawn, and the sentences about what it has besides."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from enum import Flag, auto

import bpy

from ..geometry.attributes import has_surfels, has_surfels_beside_faces
from ..geometry.gaussian_clouds import is_gaussian_cloud
from ..geometry.offsets import Points
from ..geometry.points_proxy import shown_points, shows_as_points


class Content(Flag):
    """What an entry has.

    SURFELS: those of its mesh or point cloud. SHOWN_POINTS: surfels that it shows as points, in the place of these.
    FACES: of its mesh. BARE_POINTS: a mesh of points alone that are no surfels; one of edges shows nothing, as in
    Cycles.
    """

    SURFELS = auto()
    SHOWN_POINTS = auto()
    FACES = auto()
    BARE_POINTS = auto()

    @property
    def has_surfels(self) -> bool:
        return bool(self & (Content.SURFELS | Content.SHOWN_POINTS))


#: An entry of which nothing is drawn.
NOTHING = Content(0)

#: What can be converted besides, and where.
_POINTS = "are not drawn; convert them with Object > Convert Points to Surfels"
ABOUT_BARE_POINTS = f"Meshes of points without faces {_POINTS}"

#: Blender's type -> its name, for things that other engines show and that are not meshes. Curves and texts arrive as
#: meshes, and Blender itself draws grease pencil over the picture of any engine.
_NOT_DRAWN = {"POINTCLOUD": "point cloud", "CURVES": "hair curves", "VOLUME": "volume"}


def not_drawn(object_: bpy.types.Object) -> str:
    """The sentence about an evaluated object of which nothing is drawn; empty if there is nothing to say."""
    if object_.type not in _NOT_DRAWN or shows_as_points(object_.original):
        return ""
    if object_.type == "POINTCLOUD":
        return f"{'Gaussian splats' if is_gaussian_cloud(object_.data) else 'Point clouds'} {_POINTS}"
    return f"Objects of type {_NOT_DRAWN[object_.type]} are not drawn; convert them to meshes first"


def content_of(entry: bpy.types.DepsgraphObjectInstance) -> Content:
    """What an entry of `depsgraph.object_instances` has."""
    object_ = entry.object
    if object_.type == "POINTCLOUD":
        # the points of a surfel object are read together with its mesh
        is_its_own = not shows_as_points(object_.original) and has_surfels(object_.data)
        return Content.SURFELS if is_its_own else NOTHING
    if object_.type != "MESH":
        return NOTHING
    with attributes_of(object_) as mesh:
        if mesh.polygons:
            own = Content.FACES | Content.SURFELS if has_surfels_beside_faces(mesh) else Content.FACES
        elif has_surfels(mesh):
            own = Content.SURFELS
        else:
            own = Content.BARE_POINTS if len(mesh.vertices) and not len(mesh.edges) else NOTHING
    source = entry.instance_object or object_
    if not shows_as_points(object_.original) or source.type != "MESH" or source.data != object_.data:
        return own
    with shown_points(source) as points:
        if points is None or not has_surfels(points):
            return own
    # points are the vertices that belong to no face
    return own & Content.FACES | Content.SHOWN_POINTS


@contextmanager
def attributes_of(object_: bpy.types.Object) -> Iterator[Points]:
    """The attributes of an evaluated object: those of its mesh (also in edit mode, where its data is empty) or point
    cloud."""
    if object_.type == "POINTCLOUD":
        yield object_.data
        return
    try:
        yield object_.to_mesh() if object_.data.is_editmode else object_.data
    finally:
        object_.to_mesh_clear()
