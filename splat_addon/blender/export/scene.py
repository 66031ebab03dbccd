# SPDX-License-Identifier: GPL-3.0-or-later
"""Converts a depsgraph to `rendering.Scene`: surfels, meshes, instances, lights, world; what cannot be drawn is
counted."""

from __future__ import annotations

from collections.abc import Collection, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from typing import NamedTuple

import bpy
import numpy as np

from ...primaries import recolored
from ...rendering import Instance, Light, Scene
from ...rendering.detail.hierarchies import replaced
from ...rendering.scene import placed_at
from ...rendering.scene.light_probe import LightProbe
from ...streaming import Stream
from ...surfels import Surfels
from ..conversion.changed_sources import ChangedSources
from ..conversion.color_watch import out_of_date
from ..conversion.placement import finite_matrix
from ..conversion.series import why_not_shown
from ..conversion.source_record import is_stood_in, stood_in
from ..geometry.attributes import (
    Points,
    has_surfels,
    has_surfels_beside_faces,
    have_same_values,
    offset_of,
    read_beside,
    read_stored,
    since_written,
)
from ..geometry.derived import Derived
from ..geometry.gaussian_clouds import is_gaussian_cloud
from ..geometry.points_proxy import is_solid, shown_points, shows_as_points
from ..geometry.sources import asked_of, may_change, owner_of
from ..ids import POINT_ATTRIBUTES
from ..materials.material_override import overridden, override_of
from ..materials.surface_textures import TextureStore
from ..mesh_sampling_settings import Form, density_of_meshes, form_of, looks_of_meshes
from ..object_detail import detail_of
from . import passed_over
from .entries import kind_of, matrices_of
from .holdouts import held_slots, with_holes
from .light_linking import LightSets
from .light_probes import is_sphere_probe, light_probe_of
from .live_meshes import LiveMesh, LiveMeshes, Manner, Place
from .notes import Notes
from .scan_colors import Column, painter, stream_paint
from .shading import light_of, shading_material
from .streams import Streams, not_followed
from .styles import style_of
from .world import WorldStore


class Kept(NamedTuple):
    """A mesh as it was read."""

    name: str
    surfels: Surfels
    skipped: int
    strayed: int


def tell_replaced(before: list[Kept], kept: Kept) -> None:
    """Tell the renderer what a mesh's surfels were in the frame before."""
    if before and all(kept.surfels is not old.surfels for old in before):
        replaced(before[-1].surfels, kept.surfels)


class SurfelStore:
    """Keeps the `Surfels` of meshes between frames: the same object as long as the values are unchanged.

    Device data is cached by that identity. The values of what is read again are compared: reading and comparing a
    million surfels takes a tenth of the time of packing and uploading them.

    A mesh is identified by its session_uid: objects that share a mesh but differ in modifiers have evaluated meshes of
    the same name, and each evaluation by modifiers makes a new mesh of the same name.
    """

    def __init__(self):
        self.world = WorldStore()
        self.textures = TextureStore()
        self.derived = Derived()
        self.changed_sources = ChangedSources()
        self.streams = Streams()
        self._kept: dict[int, Kept] = {}
        self._current: set[int] = set()
        self._followed: dict = {}
        self._columns: dict[tuple[int, str], Column | None] = {}

    def get(
        self, points: Points, key: int, name: str, offset: np.ndarray, is_solid: bool = False
    ) -> tuple[Surfels | None, int, int]:
        """The result of `attributes.read_stored`; read once per mesh and frame. There may be no surfels yet.

        key: session_uid of the mesh or point cloud, or of the mesh that the points were made beside.
        name: identifies it in the next evaluation. offset: of the mesh in the .blend.
        """
        if key not in self._current or self._kept[key].name != name:
            surfels, skipped, strayed = read_stored(points, self._followed, name, is_solid, offset)
            before = [kept for kept in self._kept.values() if kept.name == name]
            kept = next((k for k in before if have_same_values(k.surfels, surfels)), None)
            kept = kept or Kept(name, surfels, 0, 0)
            tell_replaced(before, kept)
            self._kept[key] = kept._replace(skipped=skipped, strayed=strayed)
            self._current.add(key)
        kept = self._kept[key]
        return kept.surfels, kept.skipped, kept.strayed

    def column(self, points: Points, key: int, attribute: str, skipped: int) -> Column | None:
        """An attribute of the surfels that `get` gave for this key, read once per mesh and frame; empty until all of
        these are there."""
        if key not in self._current:
            return Column(np.zeros(0, np.float32), 0)
        if (key, attribute) not in self._columns:
            values = read_beside(points, attribute, skipped)
            self._columns[key, attribute] = None if values is None else Column.of(values)
        return self._columns[key, attribute]

    def begin_frame(
        self,
        changed: Collection[str] | None = None,
        are_materials_edited: bool = False,
        is_sky_edited: bool = False,
        are_strokes_told: bool = True,
    ) -> None:
        """Start a frame: meshes named in `changed` (None: all) are read again when next requested.

        are_materials_edited: whether materials or their images may have been edited. is_sky_edited: the same of the
            world's. are_strokes_told: whether the former includes pixels that were painted, as in a viewport.
        """
        self.world.begin_frame(is_sky_edited)
        self.derived.begin_frame()
        self.changed_sources.begin_frame(changed is None or bool(changed))
        self.streams.begin_frame()
        self.textures.begin_frame(are_materials_edited, is_told=changed is not None and are_strokes_told)
        self._current = {k for k in self._current if changed is not None and self._kept[k].name not in changed}
        self._columns = {key: column for key, column in self._columns.items() if key[0] in self._current}

    def forget_unused(self) -> None:
        """Drop meshes and close files that this frame did not request."""
        self.streams.forget_unused()
        self._kept = {key: kept for key, kept in self._kept.items() if key in self._current}
        names = {kept.name for kept in self._kept.values()}
        self._followed = {name: before for name, before in self._followed.items() if name in names}


def export_scene(depsgraph: bpy.types.Depsgraph, store: SurfelStore, live_meshes: LiveMeshes) -> tuple[Scene, Notes]:
    """Everything in the depsgraph that the renderer can draw, and notes on what it cannot.

    live_meshes: keeps the meshes that are not surfels.
    """
    notes, bpy_scene = Notes(), depsgraph.scene
    for sentence in passed_over.of_scene(bpy_scene):
        notes.add(sentence)
    lights, light_sets, probes = _lights(depsgraph, notes)
    things = _Things(depsgraph, store, live_meshes, light_sets, notes)
    if depsgraph.view_layer_eval.use_solid:
        things.add_all()
    for sentence in store.changed_sources.sentences(things.made, depsgraph):
        notes.add(sentence)
    if older := sorted(each.name for each in things.made if not np.array_equal(since_written(each.data), np.eye(3))):
        notes.add(
            "Colours of surfels are of another working space than the file's; this engine converts them, other engines "
            f"do not: convert {older[0]}{f' and {len(older) - 1:,} more' if older[1:] else ''} again"
        )
    sampled, polygons = live_meshes.instances(
        depsgraph, density_of_meshes(bpy_scene), looks_of_meshes(bpy_scene), notes
    )
    lights = (replace(light, receivers=light_sets.lit_by(number)) for number, light in enumerate(lights))
    scene = Scene((*things.surfels, *sampled), tuple(lights), polygons=tuple(polygons), light_probes=tuple(probes))
    world = _world_of(depsgraph)
    try:
        return store.world.around(scene, world, notes), notes
    except Exception as error:
        notes.leave_out(f"The world {world.name!r}", error)
        return scene, notes


@dataclass(eq=False)
class _Kind:
    """What entries show that differ in their places only.

    shows: whether it may be visible. surfels: instances of those that are surfels, placed in the space of an entry.
    mesh: the one that it shows, in some manner. notes: on one entry. count: how many entries there are.
    """

    name: str
    shows: bool = False
    surfels: list[Instance] = field(default_factory=list)
    mesh: LiveMesh | None = None
    manner: Manner | None = None
    notes: Notes = field(default_factory=Notes)
    count: int = 0


class _Things:
    """What the entries of a depsgraph show.

    surfels: instances of those that are surfels; meshes are added to `live_meshes`. made: the objects of the former in
        the .blend, without those whose surfels are in files.
    """

    def __init__(
        self,
        depsgraph: bpy.types.Depsgraph,
        store: SurfelStore,
        live_meshes: LiveMeshes,
        light_sets: LightSets,
        notes: Notes,
    ):
        self.surfels: list[Instance] = []
        self.made: set[bpy.types.Object] = set()
        self._depsgraph, self._store, self._live_meshes = depsgraph, store, live_meshes
        self._light_sets, self._notes = light_sets, notes
        self._override = override_of(depsgraph)
        self._stood_in = stood_in(depsgraph)

    def add_all(self) -> None:
        """Add all entries."""
        matrices = matrices_of(self._depsgraph)
        are_finite = np.isfinite(matrices).all(axis=(1, 2)).tolist()
        kinds: dict[tuple, _Kind] = {}
        surfels: list[tuple[_Kind, int]] = []
        for row, entry in enumerate(self._depsgraph.object_instances):
            if not entry.show_self:
                continue
            key = kind_of(entry)
            if key not in kinds:
                kinds[key] = self._kind(entry)
            kind = kinds[key]
            if kind.shows and not are_finite[row]:
                self._leave_out(kind.name, matrices[row])
                continue
            kind.count += 1
            if kind.mesh is not None:
                kind.mesh.places.append(Place(matrices[row], kind.manner))
            if kind.surfels:
                surfels.append((kind, row))
        for kind in kinds.values():
            self._notes.add_those_of(kind.notes, kind.count)
        self._place(surfels, matrices)

    def _leave_out(self, name: str, matrix: np.ndarray) -> None:
        try:
            finite_matrix(matrix)
        except ValueError as error:
            self._notes.leave_out(name, error)

    def _place(self, surfels: list[tuple[_Kind, int]], matrices: np.ndarray) -> None:
        """Make the instances of surfels. surfels: kinds, and rows of their matrices."""
        parts = [(part, row) for kind, row in surfels for part in kind.surfels]
        try:
            self.surfels = _placed(parts, matrices)
        except ValueError:  # of some of them, which are found
            for kind, row in surfels:
                try:
                    self.surfels += _placed([(part, row) for part in kind.surfels], matrices)
                except ValueError as error:
                    self._notes.leave_out(kind.name, error)

    def _kind(self, entry: bpy.types.DepsgraphObjectInstance) -> _Kind:
        """The kind of an entry, whose meshes are read while the entry is valid."""
        kind = _Kind(entry.object.name)
        if any(_ways_it_shows(entry, self._depsgraph).values()):
            try:
                self._fill(kind, entry)
            except Exception as error:
                kind.notes.leave_out(kind.name, error)
        return kind

    def _fill(self, kind: _Kind, entry: bpy.types.DepsgraphObjectInstance) -> None:
        """Find what an entry shows. Raises ValueError with a sentence if it cannot be drawn."""
        object_, notes = entry.object, kind.notes
        if sentence := why_not_shown(object_.original.data):
            raise ValueError(sentence)
        what = _content(entry)
        if not what:
            if object_.type in _NOT_DRAWN and not shows_as_points(object_.original):
                notes.add(_not_drawn(object_))
            return
        kind.shows = True
        owner = owner_of(entry)
        fields = {
            "light_set": self._light_sets.of_instance(entry),
            **_ways_it_shows(entry, self._depsgraph),
            "may_change": may_change(entry),
            "name": object_.name,
            "index": object_.pass_index,
            "is_holdout": owner.holdout_get(view_layer=self._depsgraph.view_layer),
        }
        if {"surfels", "shown"} & {*what}:
            if sentence := out_of_date(object_.original):
                notes.add(sentence)
            rest = self._depsgraph, fields, self._store, notes, self._override
            stream = _stream_of(object_.original, self._store, notes)
            if stream is not None:
                kind.surfels += _streamed(object_, stream, *rest)
                return
            self.made.add(object_.original)
            for each in what:
                if each in ("surfels", "shown"):
                    kind.surfels += _instances(object_, self._kept(entry, each), *rest)
        form = form_of(entry, self._depsgraph.scene) if "faces" in what else _NO_FORM
        if form.kind != "HIDDEN" and not any(is_stood_in(each, self._stood_in) for each in asked_of(entry)):
            kind.mesh = self._live_meshes.of(object_, owner, form, self._override)
            kind.manner = Manner(fields, form, detail_of(owner), style_of(object_.original, self._depsgraph.scene))
        if "points" in what:
            notes.add(_BARE_POINTS)

    def _kept(self, entry: bpy.types.DepsgraphObjectInstance, kind: str) -> tuple:
        """What the store has of an entry's surfels, or of those that are shown as points, and their `painter`."""
        object_, owner = entry.object, entry.object.original
        offset = offset_of(owner.data)
        if kind == "shown":
            with shown_points(entry.instance_object or object_) as points:
                key = object_.data.session_uid
                kept = self._store.get(points, key, owner.name_full, offset, is_solid(owner))
                return *kept, painter(object_, self._store, points, key, kept[1])
        with _attributes_of(object_) as points:
            # an evaluated point cloud that no modifier made has no session_uid of its own
            key = points.session_uid or points.original.session_uid
            kept = self._store.get(points, key, points.name_full, offset)
            return *kept, painter(object_, self._store, points, key, kept[1])


def _world_of(depsgraph: bpy.types.Depsgraph) -> bpy.types.World | None:
    """The world of the view layer, which from Blender 5.0 on may have its own, or None."""
    view_layer = depsgraph.view_layer_eval
    if not view_layer.use_sky:
        return None
    return getattr(view_layer, "world_override", None) or depsgraph.scene.world


def _ways_it_shows(entry: bpy.types.DepsgraphObjectInstance, depsgraph: bpy.types.Depsgraph) -> dict[str, bool]:
    """The fields of an instance by which the camera, reflections and lights see it: Blender's Ray Visibility."""
    object_, owner = entry.object, owner_of(entry)
    is_indirect = owner.indirect_only_get(view_layer=depsgraph.view_layer)
    return {
        "is_seen": object_.visible_camera and owner.visible_camera and not is_indirect,
        "is_reflected": object_.visible_glossy and owner.visible_glossy,
        "casts_shadow": object_.visible_shadow,
    }


def _lights(depsgraph: bpy.types.Depsgraph, notes: Notes) -> tuple[list[Light], LightSets, list[LightProbe]]:
    """All lights that emit, the objects that they light, and the sphere probes: in one walk, of which Blender keeps a
    wrapper for each instance."""
    lights, objects, probes = [], [], []
    for entry in depsgraph.object_instances:
        if is_sphere_probe(entry):
            try:
                probes.append(light_probe_of(entry))
            except Exception as error:
                notes.leave_out(entry.object.name, error)
        if entry.object.type == "LIGHT" and entry.show_self:
            try:
                light = light_of(entry.object.data, finite_matrix(entry.matrix_world), notes)
            except Exception as error:
                notes.leave_out(entry.object.name, error)
                continue
            if light:
                for sentence in passed_over.of_light(entry.object.original):
                    notes.add(sentence)
                lights.append(light)
                objects.append(entry.object.original)
    return lights, LightSets(objects, notes), probes


#: Types without faces.
_NO_FORM = Form("HIDDEN")

#: Blender's type -> its name, for things that other engines show and that are not meshes. Curves and texts arrive as
#: meshes, and Blender itself draws grease pencil over the picture of any engine.
_NOT_DRAWN = {"POINTCLOUD": "point cloud", "CURVES": "hair curves", "VOLUME": "volume"}


#: What can be converted besides, and where.
_POINTS = "are not drawn; convert them with Object > Convert Points to Surfels"


def _not_drawn(object_: bpy.types.Object) -> str:
    """The sentence about an evaluated object of one of the types above."""
    if object_.type == "POINTCLOUD":
        return f"{'Gaussian splats' if is_gaussian_cloud(object_.data) else 'Point clouds'} {_POINTS}"
    return f"Objects of type {_NOT_DRAWN[object_.type]} are not drawn; convert them to meshes first"


_BARE_POINTS = f"Meshes of points without faces {_POINTS}"


def _content(entry: bpy.types.DepsgraphObjectInstance) -> tuple[str, ...]:
    """Which of "surfels", "faces" and "points" an entry has, and whether its surfels are "shown" as points."""
    object_ = entry.object
    if object_.type == "POINTCLOUD":
        # the points of a surfel object are read together with its mesh
        return () if shows_as_points(object_.original) or not has_surfels(object_.data) else ("surfels",)
    if object_.type != "MESH":
        return ()
    with _attributes_of(object_) as mesh:
        if mesh.polygons:
            own = ("surfels", "faces") if has_surfels_beside_faces(mesh) else ("faces",)
        elif has_surfels(mesh):
            own = ("surfels",)
        else:
            own = ("points",) if len(mesh.vertices) else ()
    source = entry.instance_object or object_
    if not shows_as_points(object_.original) or source.type != "MESH" or source.data != object_.data:
        return own
    with shown_points(source) as points:
        if points is None or not has_surfels(points):
            return own
    # points are the vertices that belong to no face
    return (*(kind for kind in own if kind == "faces"), "shown")


def _placed(parts: list[tuple[Instance, int]], matrices: np.ndarray) -> list[Instance]:
    """Instances at the places of entries. parts: placed in the space of an entry, and the row of its matrix."""
    moved = [matrices[row] @ part.matrix_world if part.stream is not None else matrices[row] for part, row in parts]
    return placed_at([part for part, _ in parts], np.array(moved))


def _instances(object_, kept, depsgraph, fields: dict, store: SurfelStore, notes: Notes, override) -> list[Instance]:
    """The instance of an object that has surfels, in its own space; none while the surfel store, whose result `kept`
    is, reads them. kept: also has the function that paints them, or None.

    Raises ValueError for broken attributes.
    """
    surfels, skipped, strayed, paint = kept
    # a point cloud made by modifiers has no slots of its own
    slots = [slot.material for slot in object_.original.evaluated_get(depsgraph).material_slots]
    if surfels is None:
        if POINT_ATTRIBUTES["uvs"].name in object_.original.data.attributes:
            for material in slots:  # now, because images of some colour spaces cannot be read while a view is drawn
                store.textures.get(material, notes)
        return []
    surfels = _in_working_space(surfels, object_.original, store)
    if skipped:
        notes.add(f"{object_.name}: {skipped:,} surfels with unusable values are left out")
    if strayed:
        notes.add(
            f"{object_.name}: {strayed:,} surfels were moved one by one and keep their old directions; convert the "
            "source again if it was deformed"
        )
    for sentence in passed_over.of_object(object_.original):
        notes.add(sentence)
    if override is not None:
        materials = style_of(object_.original, depsgraph.scene).on((shading_material(override, notes),))
        painted = overridden(surfels, override, store.derived, notes)
        return with_holes(Instance(painted, materials=materials, **fields), held_slots([override]))
    if paint is not None:
        surfels = paint(surfels, notes=notes)
    own = surfels.arrays().keys()
    materials = tuple(shading_material(material, notes, own) for material in slots)
    materials = style_of(object_.original, depsgraph.scene).on(materials)
    textures = tuple(store.textures.get(material, notes) for material in slots) if surfels.has_uvs else ()
    return with_holes(Instance(surfels, materials=materials, textures=textures, **fields), held_slots(slots))


def _in_working_space(surfels: Surfels, owner: bpy.types.Object, store: SurfelStore) -> Surfels:
    """The surfels of an object with their colours in the file's working space."""
    matrix = since_written(owner.data)
    if np.array_equal(matrix, np.eye(3)):
        return surfels
    return store.derived.get(surfels, tuple(matrix.ravel().tolist()), lambda: recolored(surfels, matrix))


def _stream_of(owner: bpy.types.Object, store: SurfelStore, notes: Notes) -> Stream | None:
    """The file of an object in the .blend, if it has one that can be read."""
    try:
        return store.streams.get(owner)
    except ValueError as error:
        notes.left_out.append(str(error))
        notes.add(str(error))
        return None


def _streamed(object_, stream: Stream, depsgraph, fields: dict, store: SurfelStore, notes, override) -> list[Instance]:
    """The instance of an object whose surfels are in a file. Its points are relative to the file's origin, of which the
    mesh's offset is what the object's location lacks."""
    if sentence := not_followed(object_.original):
        notes.add(sentence)
    if override is not None:
        notes.add(f"{object_.name} keeps its own colours under the overriding material, as they come from a file")
    to_origin = np.eye(4)
    to_origin[:3, 3] = offset_of(object_.original.data) - stream.file.origin
    coarsest, paint = stream.coarsest, stream_paint(object_, to_origin, notes)
    if paint is not None:
        coarsest = store.derived.get(coarsest, paint.key, lambda: paint.of(stream.coarsest))
    made = _instances(object_, (coarsest, 0, 0, None), depsgraph, fields, store, notes, None)
    if len(made) > 1:
        notes.add(
            f"{object_.name} cuts no hole, as its surfels come from a file and only some of its materials are a Holdout"
        )
    given = {"shape": coarsest, "stream": stream, "paint": paint, "matrix_world": to_origin}
    return [replace(instance, **given) for instance in made[:1]]


@contextmanager
def _attributes_of(object_: bpy.types.Object) -> Iterator[Points]:
    """The attributes of an evaluated object: those of its mesh (also in edit mode, where its data is empty) or point
    cloud."""
    if object_.type == "POINTCLOUD":
        yield object_.data
        return
    try:
        yield object_.to_mesh() if object_.data.is_editmode else object_.data
    finally:
        object_.to_mesh_clear()
