# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes instances of objects that have surfels: from their attributes, or from a file."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import NamedTuple

import bpy
import numpy as np

from ...primaries import recolored
from ...rendering import Instance
from ...streaming import Stream
from ...surfels import Surfels
from ..geometry.attributes import since_written
from ..geometry.offsets import offset_of
from ..geometry.points_proxy import is_solid, shown_points
from ..geometry.reading import own_materials
from ..geometry.stored_surfels import Stored
from ..ids import POINT_ATTRIBUTES
from ..materials.material_override import overridden
from . import passed_over
from .contents import Content, attributes_of
from .holdouts import held_slots, with_holes
from .notes import Notes
from .scan_colors import painter, stream_paint
from .shading import shading_material
from .streams import not_followed
from .styles import style_of
from .surfel_store import SurfelStore
from .traits import Traits


class _Read(NamedTuple):
    """What there is of an object's surfels. paint: the result of `painter`, or None."""

    stored: Stored
    paint: Callable[..., Surfels] | None = None


class SurfelInstances:
    """Makes the instances of one depsgraph, each in the space of its entry.

    override: the material override of the view layer. made: the objects in the .blend whose surfels were read from
    their attributes.
    """

    def __init__(self, depsgraph: bpy.types.Depsgraph, store: SurfelStore, override: bpy.types.Material | None):
        self.made: set[bpy.types.Object] = set()
        self._depsgraph, self._store, self._override = depsgraph, store, override

    def stored(
        self, entry: bpy.types.DepsgraphObjectInstance, content: Content, traits: Traits, notes: Notes
    ) -> list[Instance]:
        """The instances of an entry whose surfels are attributes; none while the store reads them. Raises ValueError
        for broken attributes."""
        self.made.add(entry.object.original)
        return self._instances(entry.object, self._read(entry, content), traits, self._override, notes)

    def stream_of(self, owner: bpy.types.Object, notes: Notes) -> Stream | None:
        """The file of an object in the .blend, if it has one that can be read."""
        try:
            return self._store.streams.get(owner)
        except ValueError as error:
            notes.left_out.append(str(error))
            notes.add(str(error))
            return None

    def streamed(self, object_: bpy.types.Object, stream: Stream, traits: Traits, notes: Notes) -> list[Instance]:
        """The instances of an object whose surfels are in a file. Its points are relative to the file's origin, of
        which the mesh's offset is what the object's location lacks."""
        if sentence := not_followed(object_.original):
            notes.add(sentence)
        if self._override is not None:
            notes.add(f"{object_.name} keeps its own colours under the overriding material, as they come from a file")
        to_origin = np.eye(4)
        to_origin[:3, 3] = offset_of(object_.original.data) - stream.file.origin
        coarsest, paint = stream.coarsest, stream_paint(object_, stream, to_origin, notes)
        if paint is not None:
            coarsest = self._store.derived.get(
                coarsest, paint.key, lambda: paint.of(stream.coarsest, stream.roots.scan)
            )
        read = _Read(Stored(coarsest, skipped=0, strayed=0))
        made = self._instances(object_, read, traits, None, notes)
        if len(made) > 1:
            notes.add(
                f"{object_.name} cuts no hole, as its surfels come from a file and only some of its materials are a "
                "Holdout"
            )
        given = {"shape": coarsest, "stream": stream, "paint": paint, "matrix_world": to_origin}
        return [replace(each, **given) for each in made[:1]]

    def _read(self, entry: bpy.types.DepsgraphObjectInstance, content: Content) -> _Read:
        object_, owner = entry.object, entry.object.original
        offset = offset_of(owner.data)
        if Content.SHOWN_POINTS in content:
            with shown_points(entry.instance_object or object_) as points:
                key = object_.data.session_uid
                stored = self._store.get(points, key, owner.name_full, offset, is_solid(owner))
                return _Read(stored, painter(object_, self._store, points, key, stored.skipped))
        with attributes_of(object_) as points:
            # an evaluated point cloud that no modifier made has no session_uid of its own
            key = points.session_uid or points.original.session_uid
            stored = self._store.get(points, key, points.name_full, offset)
            return _Read(stored, painter(object_, self._store, points, key, stored.skipped))

    def _instances(
        self,
        object_: bpy.types.Object,
        read: _Read,
        traits: Traits,
        override: bpy.types.Material | None,
        notes: Notes,
    ) -> list[Instance]:
        """The instance of an object, in two if it has holes; none while its surfels are read."""
        surfels, owner, textures = read.stored.surfels, object_.original, self._store.textures
        # a point cloud made by modifiers has no slots of its own
        slots = own_materials(owner.evaluated_get(self._depsgraph))
        if surfels is None:
            if POINT_ATTRIBUTES["uvs"].name in owner.data.attributes:
                for material in slots:  # now, because images of some colour spaces cannot be read while a view is drawn
                    textures.get(material, notes)
            return []
        surfels = self._in_working_space(surfels, owner)
        if read.stored.skipped:
            notes.add(f"{object_.name}: {read.stored.skipped:,} surfels with unusable values are left out")
        if read.stored.strayed:
            notes.add(
                f"{object_.name}: {read.stored.strayed:,} surfels were moved one by one and keep their old directions; "
                "convert the source again if it was deformed"
            )
        for sentence in passed_over.of_object(owner):
            notes.add(sentence)
        style = style_of(owner, self._depsgraph.scene)
        if override is not None:
            materials = style.on((shading_material(override, notes),))
            painted = overridden(surfels, override, self._store.derived, notes)
            return with_holes(Instance(painted, materials=materials, **traits._asdict()), held_slots([override]))
        if read.paint is not None:
            surfels = read.paint(surfels, notes=notes)
        own = surfels.arrays().keys()
        materials = style.on(tuple(shading_material(material, notes, own) for material in slots))
        shown = tuple(textures.get(material, notes) for material in slots) if surfels.has_uvs else ()
        instance = Instance(surfels, materials=materials, textures=shown, **traits._asdict())
        return with_holes(instance, held_slots(slots))

    def _in_working_space(self, surfels: Surfels, owner: bpy.types.Object) -> Surfels:
        """The surfels of an object with their colours in the file's working space."""
        matrix = since_written(owner.data)
        if np.array_equal(matrix, np.eye(3)):
            return surfels
        key = tuple(matrix.ravel().tolist())
        return self._store.derived.get(surfels, key, lambda: recolored(surfels, matrix))
