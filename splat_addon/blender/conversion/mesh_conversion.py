# SPDX-License-Identifier: GPL-3.0-or-later
"""Converts one object, or several joined, to one surfel object in four steps: prepare, sample, bake, place.

Only `sample` does not access Blender's data, so it may run in a thread while the window stays responsive.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cache, partial

import bpy
from mathutils import Matrix

from ...sampling import (
    NO_FLAT_EXTENTS,
    REDUCTIONS,
    FlatExtents,
    Sampling,
    Tolerance,
    TriangleMesh,
    drop_strays,
    drop_unusable,
    flat_extents,
    grid_spacing,
    is_plain,
    is_solid,
    outline,
    predict_count,
    projected_area,
    sample_surface,
)
from ...surfels import Surfels
from ..density import Measure
from ..materials.baking import Bakeable, baked, baked_otherwise
from ..materials.material_surfaces import Unread
from ..meshes.mesh_extraction import read_mesh, unread_sentences
from ..object_detail import detail_of
from .automatic_density import automatic_spacing
from .camera_density import without_camera
from .changing_shape import is_deformed
from .choices import Choices
from .gathering import gather
from .surfel_objects import add_surfel_object, collections_of, render_like

#: How far the surface may be above or below its surfel, in spacings: because of curvature within the cell, or a move to
#: a lattice.
_REACH, _LATTICE_REACH = 0.25, 1.0
#: About 20 GB during conversion; a typo in the resolution must not freeze the machine.
MAX_SURFELS = 100_000_000
#: Surfels, and surfels a triangle, from which texture mapping is recommended for an image on flat faces.
_MANY, _MANY_OF_A_TRIANGLE = 500_000, 1000
#: The share of the surfels from which a report says how many flat places saved.
_LEAST_SAVED = 0.01


@dataclass(eq=False)
class Conversion:
    """The sources of one surfel object during conversion, and what will be reported about them.

    sources: the first one determines the place.
    whole: the mesh as it was read. mesh: without unusable triangles.
    unread: inputs of materials that need to be baked.
    deforms: whether the surfels will follow a deformation.
    reason: explanation of an automatic density.
    """

    sources: list[bpy.types.Object]
    whole: TriangleMesh
    mesh: TriangleMesh
    matrix_world: Matrix
    materials: tuple[bpy.types.Material | None, ...]
    unread: tuple[tuple[bpy.types.Material, Unread], ...]
    choices: Choices
    spacing: float
    triangles: int
    notes: list[str]
    seconds: float
    deforms: bool = False
    reason: str = ""
    surfels: Surfels | None = None
    sampling: Sampling | None = None

    @property
    def name(self) -> str:
        return self.sources[0].name

    def is_warning(self, note: str) -> bool:
        """Whether something is not as requested."""
        return True

    @property
    def _repeats_an_image(self) -> bool:
        """Whether so many surfels are in so few triangles only because each has a colour of an image."""
        needs_none = self.choices.texture_mapped or self.choices.tolerance is None
        are_many = len(self.surfels) >= max(_MANY, _MANY_OF_A_TRIANGLE * self.triangles)
        helps = (is_plain(s, is_mapped=True) and not is_plain(s, is_mapped=False) for s in self.mesh.surfaces)
        return not needs_none and are_many and any(helps)

    def summary(self) -> str:
        """A one-line summary of what was made."""
        parts, saved = self.sampling.small_parts, self.sampling.saved
        objects = f"{len(self.sources)} objects, " if len(self.sources) > 1 else ""
        why = f" ({self.reason})" if self.reason else ""
        details = [f"{parts:,} small part{'s' * (parts > 1)} got one surfel each"] if parts else []
        is_much = saved >= _LEAST_SAVED * (len(self.surfels) + saved)
        if self.choices.tolerance or (self.choices.tolerance is not None and is_much):
            off = f" and are off by {self.sampling.error:.2g} at most" if self.choices.tolerance else ""
            details.append(f"flat places saved {saved:,} surfels{off}")
        if self._repeats_an_image:
            details.append("Texture-Mapped needs far fewer where faces with an image are flat")
        return "; ".join(
            [
                f"{objects}{self.triangles:,} triangles -> {len(self.surfels):,} surfels "
                f"in {self.seconds:.1f} s, spacing {self.spacing:.4g}{why}",
                *details,
            ]
        )


def prepare(
    sources: list[bpy.types.Object], depsgraph: bpy.types.Depsgraph, choices: Choices, images: dict | None = None
) -> Conversion:
    """Read the sources, evaluated with their modifiers and instances.

    images: keeps the textures' pixels for the next call.
    Raises ValueError with a sentence: no faces, nothing usable, an impossible density or transform.
    """
    start = time.perf_counter()
    read = partial(read_mesh, images={} if images is None else images)
    gathered = gather(sources, depsgraph, choices.in_world_units, read)
    whole, matrix_world = gathered.mesh, gathered.matrix_world
    mesh, dropped = drop_unusable(whole)
    mesh, strays = drop_strays(mesh)
    skipped = [f"{count:,} triangle{'s' * (count > 1)} {reason}" for reason, count in dropped.items()]
    if not len(mesh):
        raise ValueError(f"The mesh has no usable faces, only {', '.join(skipped)}; repair it first.")
    flat = cache(lambda: flat_places(mesh, choices, sources, gathered.unread))
    spacing, reason = _spacing(mesh, matrix_world, sources, choices, depsgraph, lambda spacing: flat().saved(spacing))
    predicted = predict_count(mesh, spacing=spacing, **_kept_samples(choices))
    if predicted > MAX_SURFELS:
        predicted -= round(flat().saved(spacing))
    if predicted > MAX_SURFELS:
        raise ValueError(f"It would become {predicted:,} surfels and the limit is {MAX_SURFELS:,}; sample it coarser.")
    notes = [f"Skipped {', '.join(skipped)}"] if skipped else []
    notes += [f"Skipped {stray_triangles(strays)}"] * bool(strays)
    unread = tuple(each for each in gathered.unread if choices.bake and each[1].can_be_baked)
    notes += unread_sentences(each for each in gathered.unread if each not in unread)
    if unread and choices.tolerance is not None:
        if choices.tolerance:
            notes.append("Adaptive is left off: what is baked is known only once the surfels are there")
        choices = replace(choices, tolerance=None)
    seconds = time.perf_counter() - start
    return Conversion(
        sources,
        whole,
        mesh,
        matrix_world,
        gathered.materials,
        unread,
        choices,
        spacing,
        len(whole),
        [*notes, *gathered.notes],
        seconds,
        _deforms(sources),
        reason,
    )


def _spacing(
    mesh: TriangleMesh,
    matrix_world: Matrix,
    sources: list[bpy.types.Object],
    choices: Choices,
    depsgraph: bpy.types.Depsgraph,
    saved: Callable[[float], float],
) -> tuple[float, str]:
    """The spacing of surfels on a usable mesh, and the explanation of an automatic one. saved: as of
    `automatic_spacing`."""
    kept, detail = _kept_samples(choices), detail_of(sources[0])
    if choices.density.measure != Measure.AUTOMATIC:
        density = choices.density.finer(detail)
        density = without_camera(density, lambda: outline(mesh), matrix_world, depsgraph)
        return grid_spacing(mesh, **density.option, **kept), ""
    spacing, reason = automatic_spacing(
        choices.density.value,
        lambda: outline(mesh),
        projected_area(mesh, **kept),
        grid_spacing(mesh, resolution=1),
        matrix_world,
        depsgraph,
        sources,
        detail,
        saved,
    )
    return spacing, str(reason) if reason else ""


def _kept_samples(choices: Choices) -> dict:
    """The options of sampling that decide which samples are kept."""
    return {"reduction": choices.reduction, "grazing_angle": choices.grazing_angle}


def stray_triangles(count: int) -> str:
    """The end of a sentence about triangles that `drop_strays` found."""
    reach = "triangles that reach" if count > 1 else "triangle that reaches"
    return (
        f"{count:,} {reach} hundreds of times as far as the others; delete strays, and make a large surface an object "
        "of its own"
    )


def flat_places(
    mesh: TriangleMesh,
    choices: Choices,
    sources: list[bpy.types.Object],
    unread: tuple[tuple[bpy.types.Material, Unread], ...],
) -> FlatExtents:
    """The flat faces of a usable mesh in which a conversion makes large surfels."""
    if choices.tolerance is None or (choices.bake and unread):
        return NO_FLAT_EXTENTS
    return flat_extents(
        mesh,
        reduction=choices.reduction,
        grazing_angle=choices.grazing_angle,
        texture_mapped=choices.texture_mapped,
        deforms=_deforms(sources),
    )


def _deforms(sources: list[bpy.types.Object]) -> bool:
    """Whether the surfels will follow a deformation."""
    return len(sources) == 1 and is_deformed(sources[0])


def sample(
    conversion: Conversion,
    progress: Callable[[float], bool | None] | None = None,
    sampler: Callable[..., Sampling] = sample_surface,
) -> None:
    """Make the surfels, without accessing Blender. sampler: replaces `sample_surface`, with the same arguments.

    Raises SamplingCancelled if `progress` returns False, ValueError for settings that sampling cannot use.
    """
    start = time.perf_counter()
    sampling = sampler(conversion.mesh, progress=progress, **sampling_options(conversion))
    solid = sampling.keeps_both_sides and is_solid(conversion.whole)
    conversion.surfels = sampling.surfels.as_solid() if solid else sampling.surfels
    conversion.sampling = sampling
    if conversion.choices.texture_mapped and not sampling.surfels.has_uvs:
        conversion.notes.append("No base colour is one image times a constant, so no surfel is texture-mapped")
    conversion.seconds += time.perf_counter() - start


def sampling_options(conversion: Conversion) -> dict:
    """The options for `sample_surface`."""
    choices = conversion.choices
    return {
        "spacing": conversion.spacing,
        "reduction": choices.reduction,
        "grazing_angle": choices.grazing_angle,
        "splat_size": choices.splat_size,
        "tolerance": None if choices.tolerance is None else Tolerance(choices.tolerance),
        "deforms": conversion.deforms,
        "texture_mapped": choices.texture_mapped,
        "normal_fields": choices.normal_fields,
        "crease_angle": choices.crease_angle,
    }


def bake(conversion: Conversion, depsgraph: bpy.types.Depsgraph) -> None:
    """If chosen, bake the material inputs that could not be read into the surfels. Raises ValueError."""
    if not conversion.unread:
        return
    start, choices = time.perf_counter(), conversion.choices
    what = Bakeable(
        conversion.sources,
        conversion.matrix_world,
        conversion.unread,
        conversion.materials,
        conversion.mesh.surfaces,
        conversion.spacing,
        choices.splat_size,
        _LATTICE_REACH if REDUCTIONS[choices.reduction].moves else _REACH,
    )
    conversion.surfels, missed = baked(conversion.surfels, what, depsgraph)
    conversion.notes += baked_otherwise(conversion.unread)
    if missed:
        conversion.notes.append(f"The bake did not meet {missed:,} values; the plain values of their sockets are used")
    conversion.seconds += time.perf_counter() - start


def place(conversion: Conversion, fallback: bpy.types.Collection) -> bpy.types.Object:
    """Add the new object "<name> surfels" over its sources, in the collections of the first, rendered as that, and
    with their materials.

    fallback: the collection to use if no collection of that source takes new objects.
    """
    collections = collections_of(conversion.sources[0], fallback)
    name, matrix_world = f"{conversion.name} surfels", conversion.matrix_world
    made = add_surfel_object(name, conversion.surfels, matrix_world, collections, conversion.materials)
    render_like(made, conversion.sources[0])
    return made
