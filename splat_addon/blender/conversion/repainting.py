# SPDX-License-Identifier: GPL-3.0-or-later
"""Gives the surfels of an object the colours that the materials of its sources have by now.

Materials are those of the sources if the sources' slots were changed last, or else those of the surfels' own slots.
"""

from __future__ import annotations

from dataclasses import replace
from functools import partial

import bpy
import numpy as np

from ...sampling import Repainting, drop_strays, drop_unusable, has_normal_map
from ...surfels import OPTIONAL_LAYOUT
from ..geometry.attributes import remove_attribute, since_written, stamp_space, write_attribute
from ..geometry.stored_surfels import read_field, room_for
from ..geometry.surfel_files import file_of
from ..ids import POINT_ATTRIBUTES
from ..materials.fingerprints import missing_image, told_of
from ..materials.slots import slot_materials
from ..meshes.mesh_extraction import read_mesh
from .as_rendered import as_rendered
from .following import follows
from .gathering import GatheredMesh, gather
from .mesh_settings import choices
from .painted_as import (
    PaintedAs,
    has_all_sources,
    keep,
    names_of,
    painted_as,
    places_of,
    told_of_layers,
    told_of_triangles,
)
from .shape_following import are_corners_known, bind_normals, is_bent
from .source_record import record_of, sources_of

#: Optional fields that follow from materials.
_OF_MATERIALS = ("roughness", "metallic", "emission")


def told_now(made: bpy.types.Object, before: PaintedAs, known: dict | None = None) -> PaintedAs:
    """What the surfels of an object in the file would be painted as. known: fingerprints of materials."""
    known = {} if known is None else known
    for material in made.data.materials:
        if material not in known:
            known[material] = told_of(material)
    slots = [known[material] for material in made.data.materials]
    # without all sources nobody knows better
    layers = told_of_layers(sources_of(made)) if has_all_sources(made) else before.layers
    return replace(before, slots=slots, layers=layers)


class Repaint:
    """Paints the surfels of one object again, in steps.

    Raises ValueError with the end of a sentence if that is impossible.
    """

    def __init__(self, made: bpy.types.Object, context: bpy.types.Context):
        self.made, mesh = made, made.data
        self._before = painted_as(mesh)
        _check(made, self._before, context)
        self._in_world_units = choices(record_of(made).mesh).in_world_units
        sources = sources_of(made)
        layers = told_of_layers(sources)
        with as_rendered(sources, context) as depsgraph:
            gathered = self._gathered(sources, depsgraph)
            usable = drop_strays(drop_unusable(gathered.mesh)[0])[0]
            if told_of_triangles(usable) != self._before.triangles:
                raise ValueError("its source has other faces than when it was converted")
            self._triangles, self._places = places_of(mesh)
            if self._triangles.max(initial=-1) >= len(usable):
                raise ValueError("they do not know where on it they lie")
            self._are_bound = None
            if is_bent(made):
                data = sources[0].evaluated_get(depsgraph).data
                self._are_bound = are_corners_known(usable, self._triangles.clip(0), data)
        self._now = replace(
            self._before,
            slots=[told_of(material) for material in mesh.materials],
            materials=names_of(gathered.materials),
            layers=layers,
            are_bent=has_normal_map(usable),
        )
        was = self._before
        self._work = Repainting(usable, was.spacing, was.splat_size, was.texture_mapped, was.are_bent)
        self._rows = self._rows_to_paint()
        if usable.materials is not None:  # large arrays of one material take less time than many small ones
            order = usable.materials[self._triangles[self._rows]].argsort(kind="stable")
            self._rows = self._rows[order]
        self._values = {name: self._room(name) for name in self._work.fields}
        arrays = {name: self._read(name)[self._rows] for name in ("rotations", "scales")}
        arrays["scales"] = arrays["scales"][:, :2]
        self._blocks = self._work.blocks(self._triangles[self._rows], self._places[self._rows], arrays)

    def _gathered(self, sources: list[bpy.types.Object], depsgraph: bpy.types.Depsgraph) -> GatheredMesh:
        """The sources with the materials that count; the slots of the surfels are set where the sources lead."""
        images: dict = {}
        slots = self.made.data.materials
        gathered = gather(sources, depsgraph, self._in_world_units, partial(read_mesh, images=images))
        if names_of(gathered.materials) != self._before.materials:
            was = self._before.materials
            for k, material in enumerate(gathered.materials):
                if k >= len(slots):
                    slots.append(material)
                elif k >= len(was) or names_of([material]) != was[k : k + 1]:
                    slots[k] = material
            while len(slots) > max(len(gathered.materials), 1):
                slots.pop()
        chosen = {of: slots[k] for k, of in enumerate(gathered.materials) if k < len(slots) and slots[k] != of}
        if not chosen:
            return gathered

        def read(evaluated: bpy.types.Object, mesh: bpy.types.Mesh):
            own = [material and material.original for material in slot_materials(evaluated, mesh)]
            return read_mesh(evaluated, mesh, images=images, slots=[chosen.get(each, each) for each in own])

        return replace(gather(sources, depsgraph, self._in_world_units, read), materials=gathered.materials)

    def _rows_to_paint(self) -> np.ndarray:
        """The surfels whose values may be others."""
        has_place, mesh = self._triangles >= 0, self.made.data
        before, now = self._before, self._now
        has_fields = {name for name in _OF_MATERIALS if POINT_ATTRIBUTES[name].name in mesh.attributes}
        is_alike = before.layers == now.layers and before.materials == now.materials
        is_alike &= len(before.slots) == len(now.slots) and has_fields >= {*self._work.fields} & {*_OF_MATERIALS}
        if not is_alike or (since_written(mesh) != np.eye(3)).any():
            return np.flatnonzero(has_place)
        changed = [k for k, (then, told) in enumerate(zip(before.slots, now.slots, strict=True)) if then != told]
        return np.flatnonzero(has_place & np.isin(self._read("materials").clip(0, len(now.slots) - 1), changed))

    def _read(self, name: str) -> np.ndarray:
        return read_field(self.made.data, POINT_ATTRIBUTES[name], self.made.data.name_full)

    def _room(self, name: str) -> np.ndarray:
        """(N, ...) values of a field: those that the surfels have, or its default."""
        layout = POINT_ATTRIBUTES[name]
        if layout.name in self.made.data.attributes:
            return self._read(name)
        values = room_for(layout, len(self._triangles))
        values[...] = OPTIONAL_LAYOUT[name][2]
        return values

    def step(self) -> bool:
        """Paint some surfels; returns whether there are more."""
        painted = next(self._blocks, None)
        if painted is None:
            return False
        rows, values = painted
        for name, array in values.items():
            self._values[name][self._rows[rows]] = array
        return True

    def finish(self) -> int:
        """Write the values into the mesh; returns how many surfels were painted."""
        mesh = self.made.data
        for name, values in self._values.items():
            write_attribute(mesh, POINT_ATTRIBUTES[name], values)
        for name in _OF_MATERIALS:
            if name not in self._values:
                remove_attribute(mesh, POINT_ATTRIBUTES[name])
        if self._are_bound is not None and "normals" in self._values:
            bind_normals(mesh, self._values["normals"], self._triangles.clip(0), self._work.mesh, self._are_bound)
        stamp_space(mesh)
        keep(mesh, self._now)
        mesh.update()
        return len(self._rows)


def _check(made: bpy.types.Object, before: PaintedAs | None, context: bpy.types.Context) -> None:
    if made.data.library is not None:
        raise ValueError("they belong to a linked file")
    if file_of(made):
        raise ValueError("they are in a file of their own")
    if before is not None and before.is_baked:
        raise ValueError("some of them were baked")
    if not has_all_sources(made) or not sources_of(made):
        raise ValueError("its source was deleted")
    if not follows(made, sources_of(made)[0]):
        raise ValueError("they are a frozen copy")
    for source in sources_of(made):
        if source.name not in context.view_layer.objects:
            raise ValueError(f"its source {source.name!r} is not in this view layer")
    if name := next(filter(None, map(missing_image, made.data.materials)), None):
        raise ValueError(f"the file of the image {name!r} is missing")
    if before is None or before.count != len(made.data.vertices):
        raise ValueError("surfels were added or removed")
