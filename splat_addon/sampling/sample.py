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

from ..surfels import LAYOUT, OPTIONAL_LAYOUT, Surfels, empty_surfels
from .attributes.blend_depths import blend_depths
from .attributes.material_sampler import MaterialSampler
from .attributes.sample_attributes import SampleFiller
from .attributes.tangents import layered_tangents
from .attributes.texture_mapping import BORDER, UV_FIELDS, is_texture_mapped
from .attributes.texture_seams import seam_edges
from .density import check_fineness, grid_spacing
from .edges.borders import DEFAULT_CREASE_ANGLE, survey_edges
from .edges.clipping import clip
from .edges.gaps import gap_surfels
from .edges.meetings import by_facing
from .ldc.depth_cube import depth_cube
from .ldc.grid import make_grid
from .ldc.reductions import DEFAULT_GRAZING_ANGLE, check_grazing_angle, find_reduction
from .ldc.scan_conversion import BATCH, Spans, batches
from .mesh.cleaning import drop_unusable
from .mesh.triangle_mesh import TriangleMesh
from .progress import Progress, stage
from .refine.adaptive import Tolerance, merge_flat
from .refine.component_surfels import component_surfels
from .refine.missed_components import SampledSurface, missed_components

#: Half-axis of a splat in H. At 1, seams between the regions of two axes leave 0.025 % of the armadillo uncovered at
#: resolution 256, visible as single dark specks; at 1.25 none of 200,000 points on it was uncovered.
DEFAULT_SPLAT_SIZE = 1.25


@dataclass(frozen=True, eq=False)
class Sampling:
    """The result of sampling a mesh.

    small_parts: number of parts that lay between all rays; each has one surfel, and these come last.
    keeps_both_sides: whether surfels of a solid mesh are solid. They are not if two sides were merged, or if a part has
        a single disc.
    gap_triangles: (k,) triangles of the surfels that were added to cover gaps left by others that end at clip lines;
        these come before those of small parts.
    saved: how many fewer surfels there are than without a tolerance.
    error: the largest distance of a merged surfel's plane from the surfels it replaces, object units.
    """

    surfels: Surfels
    small_parts: int = 0
    keeps_both_sides: bool = True
    saved: int = 0
    error: float = 0.0
    gap_triangles: np.ndarray = field(default_factory=lambda: np.empty(0, np.intp))


def sample_mesh(mesh: TriangleMesh, **options) -> Surfels:
    """The surfels of `sample_surface`, with the same options."""
    return sample_surface(mesh, **options).surfels


def sample_surface(
    mesh: TriangleMesh,
    *,
    spacing: float | None = None,
    resolution: float | None = None,
    count: float | None = None,
    reduction: str = "normal",
    grazing_angle: float = DEFAULT_GRAZING_ANGLE,
    splat_size: float = DEFAULT_SPLAT_SIZE,
    tolerance: Tolerance | None = None,
    texture_mapped: bool = False,
    crease_angle: float | None = None,
    fits_blending: bool = False,
    progress: Progress | None = None,
) -> Sampling:
    """Sample a mesh on a grid of exact rays; surfels are ordered by axis, triangle, row, column.

    spacing: cell size H, object units; or resolution: cells along the longest edge of the mesh's box; or
    count: surfels wanted, met within the accuracy of `predict_count`.
    reduction: a name in `REDUCTIONS`. grazing_angle: radians between a normal and the axis beyond which the reduction
    "grazing" refuses a sample. splat_size: smaller half-axis of a splat, in H.
    tolerance: how far from flat the surface may be where a larger surfel replaces several; None: all have the same
        size.
    texture_mapped: surfels whose colour is a single image also store their texture coordinates, so that the image is
        looked up at render time.
    crease_angle: radians; splats end at clip lines (`edges.clipping`) where the surface turns by more than this, and at
        borders of materials, colours and the surface itself; None: no clip lines. fits_blending: each surfel gets its
        own blend depth from the surface (`attributes.blend_depths`).
    progress: called between chunks with the finished share, 0 to 1; if it returns False, `SamplingCancelled` is raised.
        Unusable triangles are left out; `drop_unusable` counts them. Positions are relative to the middle.
    A connected part between the rays gets one surfel. A mesh without usable triangles gives no surfels.

    Raises ValueError with one sentence for an unusable option.
    """
    run = SamplingRun(
        mesh,
        spacing=spacing,
        resolution=resolution,
        count=count,
        reduction=reduction,
        grazing_angle=grazing_angle,
        splat_size=splat_size,
        tolerance=tolerance,
        texture_mapped=texture_mapped,
        crease_angle=crease_angle,
        fits_blending=fits_blending,
    )
    if run.is_empty:
        return Sampling(empty_surfels())
    surface = SampledSurface(len(run.mesh.positions))
    images = run.images(surface, stage(progress, 0.0, 0.5))
    missed = missed_components(run.mesh, surface)
    filled = 1.0 if crease_angle is None else 0.6
    arrays = run.filled(images, stage(progress, 0.5, filled))
    return run.finished(arrays, images, missed, stage(progress, filled, 1.0))


class SamplingRun:
    """The steps of `sample_surface`, with the same options; several machines can share them (`blocks`).

    mesh: the usable triangles; if there are none, `is_empty` is True and the other attributes do not exist. grid: the
        grid of the samples.
    """

    def __init__(
        self,
        mesh: TriangleMesh,
        *,
        spacing: float | None = None,
        resolution: float | None = None,
        count: float | None = None,
        reduction: str = "normal",
        grazing_angle: float = DEFAULT_GRAZING_ANGLE,
        splat_size: float = DEFAULT_SPLAT_SIZE,
        tolerance: Tolerance | None = None,
        texture_mapped: bool = False,
        crease_angle: float | None = None,
        fits_blending: bool = False,
    ):
        chosen = find_reduction(reduction)
        check_fineness(spacing, resolution, count)
        check_grazing_angle(grazing_angle)
        if crease_angle is not None and not 0 < crease_angle <= math.pi:
            raise ValueError(f"A crease's angle must be above 0 and up to pi radians, not {crease_angle}.")
        if not (math.isfinite(splat_size) and splat_size > 0):
            raise ValueError(f"The splat size must be a finite number above 0, not {splat_size}.")
        if tolerance is not None and chosen.merge is not None:
            raise ValueError(
                f"The reduction {reduction!r} leaves nothing flat to merge; choose another, or no tolerance."
            )
        mesh, _ = drop_unusable(mesh)
        self.mesh, self._chosen, self._splat_size, self._tolerance = mesh, chosen, splat_size, tolerance
        self._clips, self._is_by_normal = crease_angle is not None, reduction == "normal"
        if self.is_empty:
            return
        how = {"reduction": reduction, "grazing_angle": grazing_angle}
        self.grid = make_grid(mesh, grid_spacing(mesh, spacing=spacing, resolution=resolution, count=count, **how))
        self._keeps = partial(chosen.keeps, grazing_angle=grazing_angle)
        self._coordinates = self.grid.coordinates(mesh.positions)
        self._sampler = MaterialSampler(mesh.surfaces)
        is_mapped = texture_mapped and is_texture_mapped(mesh.surfaces)
        self._uv_fields = (*UV_FIELDS, BORDER) if is_mapped else ()
        self._seams = seam_edges(mesh) if is_mapped and mesh.corner_uvs is not None else None
        self._tangents = layered_tangents(mesh) if self._sampler.needs_tangents else None
        angle = DEFAULT_CREASE_ANGLE if crease_angle is None else crease_angle
        self._edges = survey_edges(mesh, angle) if self._clips or fits_blending else None
        self._bends = (self._edges.bends, self._edges.sizes) if fits_blending else None

    @property
    def is_empty(self) -> bool:
        return not len(self.mesh)

    def images(self, surface: SampledSurface, report: Callable, share: tuple[int, int] = (0, 1)) -> tuple[Spans, ...]:
        """The spans of all samples, or of one block: share is the block's number, from 0, and the number of blocks.

        surface: is told which triangles are sampled.
        """
        return depth_cube(self._coordinates, self.mesh.triangles, self.grid, self._keeps, surface, report, share)

    def filled(self, images: tuple[Spans, ...], report: Callable[[float], None]) -> dict[str, np.ndarray]:
        """Field of `Surfels` -> values at the samples of these spans, as plain sampling gives them."""
        total = sum(int(spans.counts.sum(dtype=np.int64)) for spans in images)
        layouts = LAYOUT | {name: OPTIONAL_LAYOUT[name] for name in (*self._sampler.optional, *self._uv_fields)}
        arrays = {n: np.empty((total, c) if c > 1 else total, dtype) for n, (c, dtype, *_) in layouts.items()}
        if self._bends is not None:
            arrays["blend_depth"] = np.empty(total, np.float32)
        half_size = self._splat_size * self.grid.spacing
        of_mesh = self._sampler, self._tangents, self._seams, self._bends
        _fill(SampleFiller(self.mesh, self._coordinates, self.grid, half_size, *of_mesh, arrays), images, report)
        return arrays

    def finished(
        self, arrays: dict[str, np.ndarray], images: tuple[Spans, ...], missed: tuple, report: Callable[[float], None]
    ) -> Sampling:
        """The result after the steps that need neighbouring samples. missed: result of `missed_components` for all
        samples."""
        mesh, grid, tangents, bends = self.mesh, self.grid, self._tangents, self._bends
        about = grid, self._splat_size, self._sampler, tangents
        total = len(arrays["positions"])
        if self._chosen.merge is not None:
            arrays = self._chosen.merge(arrays, grid.spacing)
        gaps, gap_triangles = {}, np.empty(0, np.intp)
        if self._clips:
            seen = _rows_of(images) if self._is_by_normal else by_facing(arrays)
            clipping = clip(arrays, seen, self._edges.borders, grid)
            report(0.7)
            gaps, gap_triangles = gap_surfels(mesh, self._edges.borders, clipping, *about)
            if bends is not None and gaps:
                gaps["blend_depth"] = blend_depths(*(of[gap_triangles] for of in bends), gaps["scales"].max(axis=1))
            arrays = arrays | clipping.fields
            report(1.0)
        saved, error = 0, 0.0
        if self._tolerance is not None:
            axes = np.repeat(np.arange(3), [int(spans.counts.sum(dtype=np.int64)) for spans in images])
            arrays, error = merge_flat(arrays, axes, grid.spacing, self._tolerance)
            saved = total - len(arrays["positions"])
        if gaps:
            arrays = _appended(arrays, gaps)
        small_parts = int(missed[1].max(initial=-1)) + 1
        if small_parts:
            sampler, is_mapped = self._sampler, bool(self._uv_fields)
            extra = component_surfels(
                mesh, self._coordinates, grid, missed, self._splat_size, sampler, tangents, is_mapped
            )
            arrays = _appended(arrays, extra)
        surfels = Surfels(origin=grid.surfel_origin, **arrays)
        keeps_both_sides = self._chosen.merge is None and not small_parts
        return Sampling(surfels, small_parts, keeps_both_sides, saved, error, gap_triangles)


def _rows_of(images: tuple[Spans, ...]) -> list[tuple[int, slice]]:
    """Slices of the samples of the image along each axis."""
    ends = np.cumsum([int(spans.counts.sum(dtype=np.int64)) for spans in images]).tolist()
    return [(axis, slice(start, end)) for axis, (start, end) in enumerate(zip((0, *ends), ends, strict=False))]


def _appended(arrays: dict[str, np.ndarray], more: dict[str, np.ndarray]) -> dict[str, np.ndarray]:
    """Both sets concatenated by field; a field that one of them lacks is filled with its default."""
    both = {}
    for name in arrays | more:
        parts = []
        for part in (arrays, more):
            if name in part:
                parts.append(part[name])
            else:
                columns, dtype, value = OPTIONAL_LAYOUT[name]
                count = len(part["positions"])
                parts.append(np.full((count, columns) if columns > 1 else count, value, dtype))
        both[name] = np.concatenate(parts)
    return both


def _fill(filler: SampleFiller, images: tuple[Spans, ...], report: Callable[[float], None]):
    """Write the samples of all images, one after another."""
    total = sum(int(spans.counts.sum(dtype=np.int64)) for spans in images)
    # Temporaries of a batch should be small beside the result, but numpy is slow on small batches.
    limit = min(BATCH, max(BATCH // 4, total // 8))
    done = 0
    for axis, spans in enumerate(images):
        # a span costs about as much as a sample
        for part in batches(spans.counts + 1, limit):
            count = int(spans.counts[part].sum(dtype=np.int64))
            filler.fill(spans[part], axis, slice(done, done + count))
            done += count
            report(done / total)
