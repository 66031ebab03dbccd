# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes that are rendered without a conversion: as polygons, or sampled when first seen and followed from frame to
frame.

A mesh is read again when Blender reports that it or one of its materials changed. Unchanged values give the same
`Surfels` or `Polygons` object, by which the renderer recognises data already on the device.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import partial
from typing import NamedTuple

import bpy
import numpy as np

from ...rendering import Instance, Material, PolygonInstance, Polygons
from ...rendering.detail.hierarchies import replaced
from ...rendering.scene import Placed, placed_at
from ...sampling import (
    STRETCHED_SHARE,
    DeformingSurfels,
    NotSeenError,
    Outline,
    TriangleMesh,
    drop_strays,
    grid_spacing,
    have_same_values,
    joined_at_edges,
    outline,
    predict_count,
    projected_area,
)
from ...surfels import OPTIONAL_LAYOUT, Surfels
from ..conversion.animation import is_moving
from ..conversion.automatic_density import automatic_spacing
from ..conversion.camera_density import most_demanding, views_told, without_camera
from ..conversion.mesh_conversion import MAX_SURFELS, stray_triangles
from ..geometry.reading import readable_mesh
from ..geometry.sources import mesh_key
from ..geometry.split_meshes import MeshParts, parts_by_group
from ..materials.image_files import shows_frames
from ..materials.slots import slot_materials
from ..materials.surface_textures import MAPS, kept_maps
from ..mesh_sampling_settings import Form
from ..meshes.mesh_extraction import ExtractedMesh, Topology, read_mesh, read_topology
from ..meshes.mesh_polygons import left_out_of_polygons, mesh_polygons, needs_surfels
from ..object_detail import finer
from . import passed_over
from .changes import Changes
from .holdouts import held_slots, with_holes
from .notes import Notes
from .shading import shading_material
from .styles import OF_MATERIALS, ObjectStyle

#: A sampling is kept until it is coarser or finer than requested by more than this factor.
_TOO_COARSE, _TOO_FINE = 1.26, 2.5

#: Detail of an object outside the camera's view, whose light or shadow may still be visible.
_UNSEEN_RESOLUTION = 64


class Manner(NamedTuple):
    """What is the same at many places of a mesh. fields: of its instances, by name. form: how it is rendered, see
    `form_of`. detail: of its object. style: what replaces that of its materials."""

    fields: dict
    form: Form
    detail: float
    style: ObjectStyle = OF_MATERIALS


class Place(NamedTuple):
    """One place of a mesh. matrix: (4, 4) float64."""

    matrix: np.ndarray
    manner: Manner


@dataclass(eq=False)
class LiveMesh:
    """One evaluated mesh, with all its places. said: sentences about its materials and its object. bends: whether its
    object has shape keys or modifiers that deform it.

    key: result of `mesh_key` for the evaluation that was read. asked: result of `_asked_of` for it. made_of:
        session_uids of its materials. has_frames: whether they show an image that is another in each frame. held:
        result of `held_slots`. looks: the options of sampling that were chosen, see `looks_of_meshes`. settled: for
        which mesh, and what else, its spacing was found. shown: a sampling, and the surfels drawn from it.
    """

    key: tuple = ()
    asked: tuple = ()
    topology: Topology | None = None
    content: ExtractedMesh | None = None
    materials: tuple[Material, ...] = ()
    made_of: frozenset[int] = frozenset()
    has_frames: bool = False
    held: list[int] = field(default_factory=list)
    maps: dict[str, tuple] = field(default_factory=dict)
    looks: dict[str, bool] = field(default_factory=dict)
    places: list[Place] = field(default_factory=list)
    owner: str = ""
    said: list[str] = field(default_factory=list)
    bends: bool = False
    deforming: DeformingSurfels | None = None
    density: dict[str, float] = field(default_factory=dict)
    spacing: float = 0.0
    settled: tuple[TriangleMesh | None, tuple] = (None, ())
    surface: tuple[TriangleMesh, Outline] | None = None
    drawn: tuple[TriangleMesh, tuple[Polygons, ...]] | None = None
    parts: MeshParts | None = None
    shown: tuple[Surfels, Surfels] | None = None
    kept_strays: tuple[TriangleMesh, TriangleMesh, int] | None = None

    @property
    def sampled_at(self) -> list[Place]:
        return self._places_of(lambda form: form.has_surfels)

    @property
    def drawn_at(self) -> list[Place]:
        return self._places_of(lambda form: form.has_polygons)

    def _places_of(self, which: Callable[[Form], bool]) -> list[Place]:
        # thousands of places are in one manner
        forms = {id(manner): manner.form for _, manner in self.places}
        chosen = {key for key, form in forms.items() if which(form)}
        return self.places if len(chosen) == len(forms) else [place for place in self.places if id(place[1]) in chosen]

    @property
    def sampled_part(self) -> TriangleMesh:
        return self.parts.far if self.parts else self.whole

    @property
    def whole(self) -> TriangleMesh:
        """What may be sampled of the mesh: all of it but strays."""
        return self._without_strays[1]

    @property
    def strays(self) -> int:
        """The number of triangles that reach too far to be sampled."""
        return self._without_strays[2]

    @property
    def _without_strays(self) -> tuple[TriangleMesh, TriangleMesh, int]:
        mesh = self.content.triangles
        if self.kept_strays is None or self.kept_strays[0] is not mesh:
            self.kept_strays = mesh, *drop_strays(mesh)
        return self.kept_strays

    @property
    def drawn_part(self) -> TriangleMesh:
        return self.parts.near if self.parts else self.content.triangles

    @property
    def matrices(self) -> np.ndarray:
        """(n, 4, 4) the matrices of the places where it is sampled."""
        return np.array([place.matrix for place in self.sampled_at])

    @property
    def detail(self) -> float:
        """The highest detail that any of its places requests."""
        return max({place.manner.detail for place in self.sampled_at})

    def be_surfels(self) -> None:
        """Let places of a mesh that polygons cannot show be in the form that it needs."""
        manners = {id(manner): manner for _, manner in self.places}
        manners = {key: each._replace(form=each.form.of_surfels) for key, each in manners.items()}
        self.places = [Place(matrix, manners[id(manner)]) for matrix, manner in self.places]

    def placed(self, made: Callable[..., Placed], places: list[Place]) -> list[Placed]:
        """Instances at places. made: makes one of them from its fields, once for each manner."""
        parts, which, matrices = {}, [], []
        for matrix, manner in places:
            if id(manner) not in parts:
                materials = manner.style.on(self.materials)
                common = {"materials": materials, "split_distance": manner.form.split_distance} | manner.fields
                parts[id(manner)] = [(part, manner) for part in with_holes(made(**common), self.held)]
            for part in parts[id(manner)]:
                which.append(part)
                matrices.append(matrix)
        instances = placed_at([part for part, _ in which], np.array(matrices))
        if not any(manner.form.split_pixels for each in parts.values() for _, manner in each):
            return instances
        return [self._split(one, manner.form.split_pixels) for one, (_, manner) in zip(instances, which, strict=True)]

    def _split(self, placed: Placed, pixels: float | None) -> Placed:
        if pixels is None:
            return placed
        # None: a matrix of zeros leaves nothing to see
        return replace(placed, split_length=self.spacing * _stretch(placed.matrix_world) / pixels or None)

    def looked_up(self, field: str) -> tuple:
        """What is looked up of its surfaces, for one field of `MAPS`."""
        self.maps[field] = kept_maps(self.maps.get(field, ()), self.content.triangles.surfaces, field)
        return self.maps[field]

    def spacing_for(self, density: dict[str, float], depsgraph: bpy.types.Depsgraph, views: tuple) -> float:
        """Spacing in the mesh's own units: as fine as its most demanding place requests, or unchanged if that is close
        enough, or if nothing changed. views: the cameras of the depsgraph, as a value."""
        if density != self.density:
            self.deforming = None
        asked = self.detail, self.matrices.tobytes(), views
        is_settled = self.deforming is not None and self.settled[0] is self.whole and self.settled[1] == asked
        if is_settled:
            return self.spacing
        ((kind, value),) = density.items()
        spacing = _SPACINGS[kind](self, value, depsgraph)
        self.settled = self.whole, asked
        return spacing

    def kept_if_near(self, spacing: float) -> float:
        is_near = self.deforming and spacing / _TOO_FINE <= self.spacing <= spacing * _TOO_COARSE
        return self.spacing if is_near else spacing


class LiveMeshes:
    """The meshes of one render or one 3D view.

    counts: about the last frame. "read": meshes that were read. "polygon_meshes" and their "triangles": drawn as
        polygons; "meshes" and their "surfels": sampled meshes. Of the sampled meshes, "sampled" were sampled in this
        frame and "followed" an earlier sampling; "stretched" counts those sampled again because they had stretched too
        far.
    most: surfels of a mesh; it is sampled coarser if there would be more. Without, more than MAX_SURFELS are refused.
    """

    def __init__(self, most: int | None = None):
        self._most = most
        self._kept: dict[tuple, LiveMesh] = {}
        self._names: dict[tuple, tuple] = {}
        self._frame: dict[tuple, LiveMesh] = {}
        self._changes: Changes | None = None
        self._images: dict = {}
        self._views: tuple = ()
        self.counts: Counter = Counter()

    def begin_frame(self, changes: Changes | None = None) -> None:
        """Start a frame. changes: since the one before; None: anything may have changed."""
        self._changes, self._frame, self._names, self.counts = changes, {}, {}, Counter()

    def forget_images(self) -> None:
        """Read textures again after an image or a material was edited."""
        self._images.clear()

    def of(
        self,
        evaluated: bpy.types.Object,
        owner: bpy.types.Object,
        form: Form,
        override: bpy.types.Material | None = None,
    ) -> LiveMesh:
        """The mesh with faces of an entry of `depsgraph.object_instances`, to which places are added; it is read while
        the entry is valid.

        form: how the entry is rendered. override: the material override of this view layer.
        """
        key = *mesh_key(evaluated), override and override.original.session_uid, form.split_group
        asked = _asked_of(evaluated)
        first = self._frame.get(key)
        if first is not None and first.content.asks_owner and first.asked != asked:
            key = *key, evaluated.original.session_uid
        if key not in self._frame:
            live = self._kept.setdefault(self._lasting_key(evaluated, form.split_group), LiveMesh())
            live.places, live.owner = [], owner.name
            if live.key != key or self._may_differ(live, evaluated, asked):
                self.counts["read"] += 1
                self._read(live, evaluated, form.split_group, override)
                live.key, live.asked = key, asked
            self._frame[key] = live
        return self._frame[key]

    def _may_differ(self, live: LiveMesh, evaluated: bpy.types.Object, asked: tuple) -> bool:
        """Whether a mesh, of which nothing was evaluated again, may look different from when it was read."""
        changes = self._changes
        if changes is None or changes.are_pixels_edited or live.has_frames:
            return True
        # its owner may have been asked for any of its properties
        if live.content.asks_owner and (live.asked != asked or evaluated.name_full in changes.objects):
            return True
        names = evaluated.name_full, evaluated.data.name_full
        return not changes.geometry.isdisjoint(names) or not changes.materials.isdisjoint(live.made_of)

    def instances(
        self, depsgraph: bpy.types.Depsgraph, density: dict[str, float], looks: dict[str, bool], notes
    ) -> tuple[list[Instance], list[PolygonInstance]]:
        """All instances added to this frame; the places of one mesh share its surfels or polygons. looks: options of
        sampling by name, see `looks_of_meshes`."""
        sampled, drawn = [], []
        self._views = is_moving(depsgraph.scene.camera), *views_told(depsgraph)
        for live in self._frame.values():
            if not live.places:
                continue
            for sentence in (*live.content.notes, *live.said):
                notes.add(sentence)
            if needs_surfels(live.content.triangles):
                live.be_surfels()
            try:
                if live.sampled_at and len(live.sampled_part):
                    if live.strays:
                        notes.add(f"{live.owner}: left out of its surfels are {stray_triangles(live.strays)}")
                    sampled += self._sampled_instances(live, depsgraph, density, looks)
                if live.drawn_at and len(live.drawn_part):
                    drawn += self._polygon_instances(live, notes)
            except Exception as error:
                notes.leave_out(live.owner, error)
        self._kept = {name: live for name, live in self._kept.items() if name in self._names}
        return sampled, drawn

    def _sampled_instances(self, live: LiveMesh, depsgraph, density, looks: dict[str, bool]) -> list[Instance]:
        sampled = self._sampled(live, depsgraph, finer(density, live.detail), looks)
        if live.shown is None or live.shown[0] is not sampled:
            whole = joined_at_edges(sampled, *live.parts, live.spacing) if live.parts else sampled
            before, live.shown = live.shown, (sampled, whole)
            if before is not None:
                replaced(before[1], live.shown[1])
        textures = live.looked_up("textures") if sampled.has_uvs else ()
        self.counts["meshes"] += 1
        self.counts["surfels"] += len(live.shown[1])
        return live.placed(partial(Instance, live.shown[1], textures=textures), live.sampled_at)

    def _polygon_instances(self, live: LiveMesh, notes) -> list[PolygonInstance]:
        mesh = live.drawn_part
        if live.drawn is None or not have_same_values(live.drawn[0], mesh):
            live.drawn = mesh, mesh_polygons(mesh)
        self.counts["polygon_meshes"] += 1
        self.counts["triangles"] += len(mesh)
        for sentence in left_out_of_polygons(live.owner, mesh):
            notes.add(sentence)
        looked_up = {field: live.looked_up(field) for field in MAPS}
        return [
            instance
            for shape in live.drawn[1]
            for instance in live.placed(partial(PolygonInstance, shape, **looked_up), live.drawn_at)
        ]

    def _lasting_key(self, evaluated: bpy.types.Object, group: str) -> tuple:
        """A key that identifies the same mesh in the next frame, after it has been evaluated again.

        Geometry Nodes may put several meshes of the same name into an object; they are told apart by their order.
        """
        name = evaluated.original.session_uid, evaluated.data.name_full, group
        number = 0
        while (*name, number) in self._names:
            number += 1
        self._names[(*name, number)] = name
        return (*name, number)

    def _read(self, live: LiveMesh, evaluated: bpy.types.Object, group: str, override) -> None:
        # repeated each frame, because the mesh itself is not read each frame
        notes = Notes()
        for sentence in passed_over.of_object(evaluated.original):
            notes.add(sentence)
        with readable_mesh(evaluated) as mesh:
            slots = slot_materials(evaluated, mesh)
            if override is not None:
                slots = [override] * max(len(slots), 1)
            live.topology = read_topology(mesh, live.topology)
            live.content = read_mesh(evaluated, mesh, live.topology, self._images, slots)
            if unusable := _not_finite(live.content.triangles):
                notes.add(f"{live.owner}: {unusable:,} triangles with a non-finite vertex are left out")
            live.parts = parts_by_group(evaluated, mesh, live.content.triangles, group) if group else None
            live.bends = evaluated.original.is_deform_modified(bpy.context.scene, "RENDER")
            live.materials = tuple(shading_material(material, notes, OPTIONAL_LAYOUT) for material in slots)
            live.held = held_slots(slots)
            live.made_of = frozenset(material.original.session_uid for material in slots if material)
            live.has_frames = any(map(shows_frames, slots))
        live.said = list(notes.counts.elements())

    def _sampled(
        self, live: LiveMesh, depsgraph: bpy.types.Depsgraph, density: dict[str, float], looks: dict[str, bool]
    ) -> Surfels:
        """The sampling of a mesh. Raises ValueError with a sentence if it cannot be sampled."""
        if looks != live.looks:
            live.deforming, live.looks = None, looks
        mesh, spacing = live.sampled_part, live.spacing_for(density, depsgraph, self._views)
        if live.deforming is not None and spacing == live.spacing and live.deforming.has_triangles_of(mesh):
            surfels, stretched = live.deforming.at(mesh)
            if stretched <= STRETCHED_SHARE:
                self.counts["followed"] += 1
                return surfels
            self.counts["stretched"] += 1
            live.deforming = None
            spacing = live.spacing_for(density, depsgraph, self._views)
        predicted = predict_count(mesh, spacing=spacing)
        if self._most is not None and predicted > self._most:
            spacing *= math.sqrt(predicted / self._most)
        elif predicted > MAX_SURFELS:
            raise ValueError(f"It would be {predicted:,} surfels and the limit is {MAX_SURFELS:,}; sample it coarser.")
        live.deforming = _deforming(mesh, spacing, looks, live.parts is None, live.bends)
        live.density, live.spacing = density, spacing
        self.counts["sampled"] += 1
        return live.deforming.at(mesh)[0]


def _asked_of(evaluated: bpy.types.Object) -> tuple:
    """What the nodes of a material may ask about an object, in a form that can be compared."""
    placed = evaluated.matrix_world.copy().freeze()
    return evaluated.original.session_uid, placed, tuple(evaluated.color), evaluated.pass_index


def _deforming(
    mesh: TriangleMesh, spacing: float, looks: dict[str, bool], ends_at_edges: bool, bends: bool
) -> DeformingSurfels:
    """A mesh sampled as the operator does. ends_at_edges: False for a part of a mesh whose border continues as
    polygons. bends: whether planes that fit the mesh now will not fit it later.
    """
    edges = {} if ends_at_edges else {"crease_angle": None}
    if bends:
        edges["fits_planes"] = False
    return DeformingSurfels(mesh, spacing=spacing, deforms=bends, **looks, **edges)


def _not_finite(mesh: TriangleMesh) -> int:
    """Number of triangles that have a vertex without a place."""
    are_bad = ~np.isfinite(mesh.positions).all(axis=1)
    return int(np.count_nonzero(are_bad[mesh.triangles].any(axis=1))) if are_bad.any() else 0


def _stretch(matrix: np.ndarray) -> float:
    """The largest factor by which a matrix lengthens."""
    return float(np.linalg.norm(matrix[:3, :3], 2))


def _by_resolution(live: LiveMesh, resolution: float, depsgraph) -> float:
    # deforming meshes keep their surfels, unless they are stretched too far
    return live.spacing if live.deforming else grid_spacing(live.whole, resolution=resolution)


def _by_spacing(live: LiveMesh, spacing: float, depsgraph) -> float:
    stretch = float(np.linalg.svd(live.matrices[:, :3, :3], compute_uv=False).max())
    return live.kept_if_near(spacing / stretch if stretch > 0 else math.inf)


def _by_camera(live: LiveMesh, pixels: float, depsgraph) -> float:
    mesh, spacings = live.whole, []
    if live.surface is None or live.surface[0] is not mesh:
        live.surface = mesh, outline(mesh)
    for matrix in most_demanding(pixels, live.surface[1], live.matrices, depsgraph):
        try:
            spacings.append(without_camera({"pixels": pixels}, lambda: live.surface[1], matrix, depsgraph)["spacing"])
        except NotSeenError:
            continue
    if spacings:
        return live.kept_if_near(min(spacings))
    return live.spacing if live.deforming else grid_spacing(mesh, resolution=_UNSEEN_RESOLUTION)


def _by_itself(live: LiveMesh, pixels: float, depsgraph) -> float:
    """The spacing that the most demanding place needs, within the limits of `automatic_density`; kept until it changes
    much."""
    mesh = live.whole
    if live.surface is None or live.surface[0] is not mesh:
        live.surface = mesh, outline(mesh)
    # The detail is already in the pixels, but it also counts if no camera sees the mesh.
    asked, surface = pixels * live.detail, live.surface[1]
    spacing = partial(automatic_spacing, asked, lambda: surface, projected_area(mesh), grid_spacing(mesh, resolution=1))
    matrices = most_demanding(asked, surface, live.matrices, depsgraph)
    return live.kept_if_near(min(spacing(matrix, depsgraph, detail=live.detail).spacing for matrix in matrices))


#: kind of density -> function of a mesh, the number and the depsgraph that returns the spacing
_SPACINGS = {"resolution": _by_resolution, "spacing": _by_spacing, "pixels": _by_camera, "automatic": _by_itself}
