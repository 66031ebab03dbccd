# SPDX-License-Identifier: GPL-3.0-or-later
"""Turns a mesh into surfels: clean, scan-convert, fill. The entry point of `sampling`.

There are two passes: the first finds all spans, so that the count is known exactly; the second fills arrays of that
size.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import partial

import numpy as np

from ..large_surfels import BLEND_STEPS, LARGE_SIZE, STEPS_OF_LARGE
from ..normal_fields import NORMAL_FIELDS, turned
from ..runs import ranges
from ..surfels import LAYOUT, Surfels, empty_surfels
from ..workers import in_order
from .attributes.blend_depths import blend_depths
from .attributes.lifts import edge_bulges, lifts
from .attributes.normal_changes import fields_on_triangles
from .attributes.sample_attributes import SampleFiller
from .attributes.tangents import layered_tangents
from .attributes.texture_seams import seam_edges
from .density import spacing_of
from .edges.borders import DEFAULT_CREASE_ANGLE, survey_edges
from .edges.clipping import clip_fields, clippings
from .edges.contacts import crossed_cells, find_contacts
from .edges.gaps import BorderPlaces, gap_surfels
from .edges.meetings import by_facing
from .ldc.depth_cube import axes_of, depth_cube, in_bands, row_bands, rows_of, triangles_of
from .ldc.grid import make_grid
from .ldc.missed_components import SampledSurface, missed_components
from .ldc.reductions import find_reduction
from .ldc.scan_conversion import BATCH, Spans, batches
from .materials.material_sampler import MaterialSampler
from .materials.texture_mapping import BORDER, UV_FIELDS, is_texture_mapped
from .mesh.barycentric import barycentric
from .mesh.cleaning import usable_triangles
from .mesh.solid import is_solid
from .mesh.triangle_mesh import TriangleMesh
from .options import SamplingOptions
from .progress import Progress, stage
from .refine.adaptive import merge_flat
from .refine.component_surfels import component_surfels
from .refine.fitted_planes import fit_planes
from .refine.flat_blocks import LARGEST, LEAST_AREA, RING, Large, divided
from .refine.flat_faces import flat_faces
from .refine.image_samples import inside_triangles
from .refine.two_sided import cards_of, mostly
from .table import SampleTable, check_table, empty_column, joined

#: Times of the steps that need neighbouring samples, relative to one another: clipping, fitting planes, merging.
_TIMES = 0.3, 0.5, 0.2


@dataclass(frozen=True, eq=False)
class Sampling:
    """The result of sampling a mesh.

    small_parts: number of parts that lay between all rays; each has one surfel, and these come last.
    keeps_both_sides: whether surfels of a solid mesh are solid. They are not if two sides were merged, or if a part has
        a single disc.
    gaps: number of surfels that were added to cover gaps left by others that end at clip lines; these come before those
        of small parts.
    triangles: (N,) int32, the triangle of the mesh on which each surfel lies, and of a merged one one of those.
    saved: how many fewer surfels there are than without a tolerance.
    error: the largest distance of a merged surfel's plane from the surfels it replaces, object units.
    """

    surfels: Surfels
    small_parts: int = 0
    keeps_both_sides: bool = True
    saved: int = 0
    error: float = 0.0
    gaps: int = 0
    triangles: np.ndarray = field(default_factory=lambda: np.empty(0, np.int32))


def sample_mesh(mesh: TriangleMesh, **options) -> Surfels:
    """The surfels of `sample_surface`, with the same options; of a closed mesh they are solid, so that backs are not
    drawn."""
    sampling = sample_surface(mesh, **options)
    return sampling.surfels.as_solid() if sampling.keeps_both_sides and is_solid(mesh) else sampling.surfels


def sample_surface(mesh: TriangleMesh, *, progress: Progress | None = None, **options) -> Sampling:
    """Sample a mesh on a grid of exact rays; surfels are ordered by axis, triangle, row, column. Larger ones come after
    the others.

    options: the fields of `SamplingOptions`; exactly one of spacing, resolution and count is required.
        The others' defaults are those of Blender's conversion; `**PLAIN` gives plain surfels.
    progress: called between chunks with the finished share, 0 to 1; if it returns False, `SamplingCancelled` is raised.
        Unusable triangles are left out; `drop_unusable` counts them. Positions are relative to the middle.
    A connected part between the rays gets one surfel. A mesh without usable triangles gives no surfels.

    Raises ValueError with one sentence for an unusable option.
    """
    run = SamplingRun(mesh, SamplingOptions(**options))
    if run.is_empty:
        return Sampling(empty_surfels())
    surface = SampledSurface(len(run.mesh.positions))
    # the steps that need neighbours take most of the time, where there are any
    found, filled = (0.5, 1.0) if run.finishes_at_once else (0.2, 0.35)
    images, large = run.images(surface, stage(progress, 0.0, found))
    missed = missed_components(run.mesh, surface)
    arrays = run.filled(images, stage(progress, found, filled))
    return run.finished(arrays, images, large, missed, stage(progress, filled, 1.0))


class SamplingRun:
    """The steps of `sample_surface`; several machines can share them (`blocks`).

    mesh: the usable triangles; if there are none, `is_empty` is True and the other attributes do not exist. grid: the
        grid of the samples.
    """

    def __init__(self, mesh: TriangleMesh, options: SamplingOptions):
        self.mesh, self._kept = usable_triangles(mesh)
        self.options, self._chosen = options, find_reduction(options.reduction)
        if self.is_empty:
            return
        mesh, clips = self.mesh, options.crease_angle is not None
        self.grid = make_grid(mesh, spacing_of(mesh, options))
        self._keeps = partial(self._chosen.keeps, grazing_angle=options.grazing_angle)
        self._coordinates = self.grid.coordinates(mesh.positions)
        self._sampler = MaterialSampler(mesh.surfaces)
        is_mapped = options.texture_mapped and is_texture_mapped(mesh.surfaces)
        self._uv_fields = (*UV_FIELDS, BORDER) if is_mapped else ()
        self._seams = seam_edges(mesh) if is_mapped and mesh.corner_uvs is not None else None
        self._tangents = layered_tangents(mesh) if self._sampler.needs_tangents else None
        angle = options.crease_angle if clips else DEFAULT_CREASE_ANGLE
        reach = options.splat_size * self.grid.spacing if clips else math.inf
        self._edges = survey_edges(mesh, angle, reach) if clips or options.fits_blending else None
        self._bends = (self._edges.bends, self._edges.sizes) if options.fits_blending else None
        self._contacts = find_contacts(mesh, self._edges, self.grid.spacing) if clips else None
        self._bulges = edge_bulges(mesh, self.grid.spacing) if options.lifts else None

    @property
    def is_empty(self) -> bool:
        return not len(self.mesh)

    @property
    def finishes_at_once(self) -> bool:
        """Whether no step needs neighbouring samples."""
        return self.options.crease_angle is None and not self._merges_flat

    def images(
        self, surface: SampledSurface, report: Callable, share: tuple[int, int] = (0, 1)
    ) -> tuple[tuple[Spans, ...], Large]:
        """The spans of all samples, or of one block, and those of large samples, which replace others.

        share: number of the block, from 0, and the number of blocks. surface: is told which triangles are sampled.
        """
        bands = row_bands(self._coordinates, self.grid, *share, LARGEST) if share[1] > 1 else None
        cube = partial(depth_cube, self._coordinates, self.mesh.triangles, self.grid, self._keeps, surface, report)
        if not self._enlarges:
            return cube(bands), {}
        # a block's outermost rows depend on those beside them
        around = None if bands is None else bands + np.array([[-RING], [RING]])
        images, large = divided(cube(around), self._flat_faces(), self._crossed_cells())
        if bands is not None:
            images, large = in_bands(images, bands), {edge: in_bands(of, bands) for edge, of in large.items()}
        return images, large

    def _flat_faces(self) -> np.ndarray:
        return flat_faces(
            self.mesh,
            self._edges,
            LEAST_AREA,
            self.grid.spacing,
            bulges=self._bulges,
            is_mapped=bool(self._uv_fields),
            deforms=self.options.deforms,
        )

    def _crossed_cells(self) -> list[np.ndarray] | None:
        return crossed_cells(self._contacts, self.grid) if self._contacts is not None else None

    @property
    def _enlarges(self) -> bool:
        options = self.options
        is_possible = options.fits_blending and self._chosen.merge is None and options.count is None
        return options.tolerance is not None and is_possible

    def filled(self, images: tuple[Spans, ...], report: Callable[[float], None], edge: int = 1) -> SampleTable:
        """The samples of these spans, as plain sampling gives them. edge: of the block that each sample covers, in
        cells."""
        total = sum(int(spans.counts.sum(dtype=np.int64)) for spans in images)
        names = [*LAYOUT, *self._sampler.optional, *self._uv_fields]
        names += ["blend_depth"] * (self._bends is not None) + ["rise"] * (self._bulges is not None)
        if self.options.normal_fields and self.mesh.corner_normals is not None:
            names += NORMAL_FIELDS
        arrays: SampleTable = {name: empty_column(name, total) for name in names}
        half_size = (self.options.splat_size if edge == 1 else LARGE_SIZE * edge) * self.grid.spacing
        of_mesh = self._sampler, self._tangents, self._seams, self._bends, self._bulges
        _fill(SampleFiller(self.mesh, self._coordinates, self.grid, half_size, *of_mesh, arrays), images, report)
        if edge > 1:
            arrays["blend_depth"][...] = STEPS_OF_LARGE[edge] / BLEND_STEPS
        return arrays

    def finished(
        self,
        arrays: SampleTable,
        images: tuple[Spans, ...],
        large: Large,
        missed: tuple,
        report: Callable[[float], None],
    ) -> Sampling:
        """The result after the steps that need neighbouring samples. arrays: of the images' samples. missed: result of
        `missed_components`."""
        total = len(arrays["positions"])
        arrays = check_table(arrays | {"triangle": triangles_of(images)})
        clipping, fitting, merging = self._stages(report)
        if self._chosen.merge is not None:
            arrays = self._chosen.merge(arrays, axes_of(images), self.grid.spacing)
        of_large = {
            edge: self.filled(large[edge], lambda share: None, edge) | {"triangle": triangles_of(large[edge])}
            for edge in sorted(large)
        }
        cards = {}
        if self._may_have_cards:
            every_image, every_table = {1: images, **large}, {1: arrays, **of_large}
            cards = cards_of(every_image, every_table, self.mesh, self.grid.spacing, self.options.deforms)
        gaps, gap_triangles = {}, np.empty(0, np.intp)
        if self.options.crease_angle is not None:
            arrays, gaps, gap_triangles = self._clipped(arrays, images, clipping)
        if self._fits_planes:
            inside, is_closed = inside_triangles(images), self._edges.borders.are_closed()
            fitted = fit_planes(arrays, rows_of(images), inside, self.grid, is_closed, fitting)
            arrays = arrays | fitted | turned(arrays, fitted.get("rotations", arrays["rotations"]))
        for edge, are_cards in cards.items():
            of_large.get(edge, arrays)["hidden_back"] = are_cards.astype(np.float32)
        if gaps and cards:
            gaps["hidden_back"] = mostly(cards[1], images, len(self.mesh))[gap_triangles].astype(np.float32)
        saved, error = 0, 0.0
        if self._merges_flat:
            arrays, error = merge_flat(arrays, axes_of(images), self.grid.spacing, self.options.tolerance, merging)
            saved = total - len(arrays["positions"])
        more, small_parts = [], int(missed[1].max(initial=-1)) + 1
        for edge, of_edge in of_large.items():
            more.append(of_edge)
            saved += (edge**2 - 1) * len(of_edge["positions"])
        if gaps:
            more.append(gaps | {"triangle": gap_triangles.astype(np.int32)})
        if small_parts:
            more.append(self._small_parts(missed))
        if more:
            arrays = joined(arrays, *more)
        triangles = self._kept.take(arrays["triangle"]).astype(np.int32)
        surfels = Surfels(origin=self.grid.surfel_origin, **_fields(check_table(arrays)))
        keeps_both_sides = self._chosen.merge is None and not small_parts
        report(1.0)
        return Sampling(surfels, small_parts, keeps_both_sides, saved, error, len(gap_triangles), triangles)

    def _small_parts(self, missed: tuple) -> SampleTable:
        """A surfel for each part that no ray hits."""
        return component_surfels(
            self.mesh,
            self._coordinates,
            self.grid,
            missed,
            largest_radius=self.options.splat_size,
            sampler=self._sampler,
            tangents=self._tangents,
            texture_mapped=bool(self._uv_fields),
        )

    @property
    def _may_have_cards(self) -> bool:
        """Without blend depths, fronts hide backs. Of a solid, no back is seen."""
        return self._bends is not None and self._chosen.merge is None and not is_solid(self.mesh)

    @property
    def _fits_planes(self) -> bool:
        return self.options.fits_planes and self._chosen.merge is None

    @property
    def _merges_flat(self) -> bool:
        return self.options.tolerance is not None and self.options.tolerance.distance > 0

    def _stages(self, report: Callable[[float], None]) -> list[Callable[[float], None]]:
        """Reports for the steps that `_TIMES` lists, of which only some are taken."""
        taken = self.options.crease_angle is not None, self._fits_planes, self._merges_flat
        ends = np.cumsum([0.0, *np.multiply(_TIMES, taken)])
        ends /= ends[-1] or 1.0
        return [stage(report, first, last) for first, last in zip(ends[:-1].tolist(), ends[1:].tolist(), strict=True)]

    def _clipped(self, arrays: SampleTable, images: tuple[Spans, ...], report: Callable[[float], None]):
        """The samples with their clip lines; and the arrays and triangles of additional surfels on what these
        leave bare.
        """
        borders, bends = self._edges.borders.followed_by(self._contacts), self._bends
        seen = rows_of(images) if self.options.reduction == "normal" else by_facing(arrays)
        places = BorderPlaces(borders, self.grid)

        def parts():
            for part in clippings(arrays, seen, borders, self.grid):
                report(0.7 * part.met.seen.axis / len(seen))
                places.cover(part)
                yield part

        fields = clip_fields(parts(), len(arrays["positions"]))
        size, sampler = self.options.splat_size, self._sampler
        gaps, triangles = gap_surfels(self.mesh, borders, places, self.grid, size, sampler, self._tangents)
        if bends is not None and gaps:
            gaps["blend_depth"] = blend_depths(*(of[triangles] for of in bends), gaps["scales"].max(axis=1))
        if self._bulges is not None and gaps:
            places = gaps["positions"] + self.grid.surfel_origin
            rises = lifts(barycentric(self.mesh, triangles, places).T, self._bulges[:, triangles])
            gaps["rise"] = rises.astype(np.float32)
        if NORMAL_FIELDS[0] in arrays and gaps:
            gaps |= fields_on_triangles(self.mesh, triangles, gaps)
        report(1.0)
        return arrays | fields, gaps, triangles


def _fields(arrays: SampleTable) -> dict[str, np.ndarray]:
    """The fields of `Surfels`, once all half-axes are final."""
    fields = {name: array for name, array in arrays.items() if name not in NORMAL_FIELDS or array.any()}
    del fields["triangle"]
    if "rise" in fields:
        fields["lift"] = fields.pop("rise") / np.maximum(*arrays["scales"].T)
    return fields


def _fill(filler: SampleFiller, images: tuple[Spans, ...], report: Callable[[float], None]):
    """Write the samples of all images, one after another."""
    total = sum(int(spans.counts.sum(dtype=np.int64)) for spans in images)
    # Temporaries of a batch should be small beside the result, but numpy is slow on small batches.
    limit = min(BATCH, max(BATCH // 4, total // 8))
    jobs, done = [], 0
    for axis, spans in enumerate(images):
        order = filler.order(spans)
        first = None if order is None else (done + np.cumsum(spans.counts, dtype=np.intp) - spans.counts)[order]
        spans = spans if order is None else spans[order]
        # a span costs about as much as a sample
        for part in batches(spans.counts + 1, limit):
            count = int(spans.counts[part].sum(dtype=np.int64))
            rows = slice(done, done + count) if first is None else ranges(first[part], spans.counts[part])
            done += count
            jobs.append(partial(_filled, filler, spans[part], axis, rows, done))
    for filled in in_order(jobs):
        report(filled / total)


def _filled(filler: SampleFiller, spans: Spans, axis: int, rows: slice | np.ndarray, done: int) -> int:
    filler.fill(spans, axis, rows)
    return done
