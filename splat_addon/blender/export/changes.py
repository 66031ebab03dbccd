# SPDX-License-Identifier: GPL-3.0-or-later
"""What Blender's evaluations of a scene changed, so that everything else is not read again.

Blender reports it in `depsgraph.updates` until the next evaluation, also in a final render, whose engine keeps its
depsgraph from frame to frame. The report follows all dependencies: a driver, a texture that is placed by a moving
object, or a node group names the materials that use it.
"""

from __future__ import annotations

from dataclasses import dataclass

import bpy


@dataclass(frozen=True)
class Changes:
    """geometry: full names of objects and their data whose geometry may differ. objects: of all objects that may differ
    in anything. materials: session_uids of materials in the file. are_pixels_edited: whether images may differ.
    is_sky_edited: whether the world's picture may.
    """

    geometry: frozenset[str] = frozenset()
    objects: frozenset[str] = frozenset()
    materials: frozenset[int] = frozenset()
    are_pixels_edited: bool = False
    is_sky_edited: bool = False

    def __or__(self, later: Changes) -> Changes:
        return Changes(
            self.geometry | later.geometry,
            self.objects | later.objects,
            self.materials | later.materials,
            self.are_pixels_edited or later.are_pixels_edited,
            self.is_sky_edited or later.is_sky_edited,
        )


def changes_of(depsgraph: bpy.types.Depsgraph) -> Changes:
    """What the last evaluation changed."""
    geometry, objects, materials, kinds = set(), set(), set(), set()
    for update in depsgraph.updates:
        id_ = update.id
        kinds.add(id_.id_type)
        if isinstance(id_, bpy.types.Object):
            objects.add(id_.name_full)
        elif isinstance(id_, bpy.types.Material):
            materials.add(id_.original.session_uid)  # an evaluated material has none of its own
        if update.is_updated_geometry:
            geometry.add(id_.name_full)
            if data := getattr(id_, "data", None):
                geometry.add(data.name_full)
    # Blender reports the world if a picture in it was reloaded
    sky = bool(kinds & {"WORLD", "IMAGE"})
    return Changes(frozenset(geometry), frozenset(objects), frozenset(materials), "IMAGE" in kinds, sky)
