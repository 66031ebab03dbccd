# SPDX-License-Identifier: GPL-3.0-or-later
"""Converts the points of an object to a surfel object: the counterpart of `mesh_conversion` for objects without a
surface. Points that are Gaussian splats already have all that surfels need; others are completed by their
neighbours."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass

import bpy
import numpy as np
from mathutils import Matrix, Vector

from ...doubts import doubts
from ...interchange import DEFAULT_FLATNESS, Gaussians, transformed
from ...sampling import PointsReport, surfels_from_points
from ...surfels import Surfels
from ..geometry.gaussian_clouds import is_gaussian_cloud, read_gaussians
from ..geometry.points_extraction import ExtractedPoints, extract_points, materials_of, sheared
from ..working_space import surfels_from_rec709
from .batch import Batch
from .placement import without_shear
from .points_settings import is_mild
from .surfel_objects import active_collection, add_surfel_object, collections_of, render_like


class _OfOneObject:
    """A conversion whose only source is one object."""

    source: bpy.types.Object

    @property
    def name(self) -> str:
        return self.source.name

    @property
    def sources(self) -> list[bpy.types.Object]:
        return [self.source]


@dataclass(eq=False)
class PointsConversion(_OfOneObject):
    """One source, the points read from it, and what will be reported.

    viewpoint: (3,) point that normals face, in the space of the points, or None.
    """

    source: bpy.types.Object
    points: ExtractedPoints
    matrix_world: Matrix
    viewpoint: np.ndarray | None
    seconds: float
    surfels: Surfels | None = None
    report: PointsReport | None = None

    @property
    def materials(self) -> tuple[bpy.types.Material | None, ...]:
        return self.points.materials

    @property
    def notes(self) -> list[str]:
        return [*self.report.notes(), *doubts(self.surfels)]

    def is_warning(self, note: str) -> bool:
        """Whether anything was left out or is doubtful."""
        return not is_mild(note)

    def summary(self) -> str:
        """A one-line summary of what was made."""
        return f"{self.report.points:,} points -> {len(self.surfels):,} surfels in {self.seconds:.1f} s"

    def sample(self, options: dict, progress) -> None:
        """options: for `surfels_from_points`, without the viewpoint."""
        start, points = time.perf_counter(), self.points
        self.surfels, self.report = surfels_from_points(
            points.positions,
            points.normals,
            points.radii,
            points.colors,
            viewpoint=self.viewpoint,
            progress=progress,
            **options,
        )
        self.seconds += time.perf_counter() - start


@dataclass(eq=False)
class GaussiansConversion(_OfOneObject):
    """One point cloud of Gaussian splats; reading it already gives the surfels."""

    source: bpy.types.Object
    gaussians: Gaussians
    surfels: Surfels
    matrix_world: Matrix
    materials: tuple[bpy.types.Material | None, ...]
    seconds: float

    @property
    def notes(self) -> list[str]:
        return [*self.gaussians.notes(), *doubts(self.surfels)]

    def is_warning(self, note: str) -> bool:
        return True

    def summary(self) -> str:
        """A one-line summary of what was made."""
        return f"{self.gaussians.total:,} Gaussians -> {len(self.surfels):,} surfels in {self.seconds:.1f} s"

    def sample(self, options: dict, progress) -> None:
        """Nothing is left to do."""


class PointsBatch(Batch):
    """A batch of point objects.

    options: for `surfels_from_points`, without the viewpoint.
    viewpoint: returns the viewpoint in world space or None, or raises a ValueError.
    flatness: for `flat_gaussians`.
    """

    def __init__(
        self,
        sources: list[bpy.types.Object],
        options: dict,
        viewpoint: Callable[[], Vector | None],
        flatness: float = DEFAULT_FLATNESS,
    ):
        super().__init__([[source] for source in sources])
        self._options, self._viewpoint, self._flatness = options, viewpoint, flatness

    def _prepare(self, sources, depsgraph) -> PointsConversion | GaussiansConversion:
        start, [source] = time.perf_counter(), sources
        evaluated = source.evaluated_get(depsgraph)
        matrix_world, shear = without_shear(evaluated.matrix_world)
        if evaluated.type == "POINTCLOUD" and is_gaussian_cloud(evaluated.data):
            return self._prepare_gaussians(source, evaluated, matrix_world, shear, start)
        points = extract_points(source, depsgraph)
        if not len(points.positions):
            raise ValueError("It has no points to convert; give it vertices or points.")
        points = points if shear is None else sheared(points, shear)
        eye = self._viewpoint()
        eye = None if eye is None else np.array(matrix_world.inverted() @ eye)
        return PointsConversion(source, points, matrix_world, eye, time.perf_counter() - start)

    def _prepare_gaussians(self, source, evaluated, matrix_world, shear, start: float) -> GaussiansConversion:
        gaussians = read_gaussians(evaluated.data, self._flatness)
        if not len(gaussians.surfels):
            raise ValueError(
                f"None of its {gaussians.total:,} Gaussians gives a surfel at a flatness of {self._flatness:g}: "
                f"{'; '.join(gaussians.notes()) or 'it is empty'}."
            )
        surfels = surfels_from_rec709(gaussians.surfels)
        if shear is not None:
            affine = np.eye(4)
            affine[:3, :3] = shear
            surfels = transformed(surfels, affine)
        seconds = time.perf_counter() - start
        return GaussiansConversion(source, gaussians, surfels, matrix_world, materials_of(evaluated), seconds)

    def _sample(self, conversion: PointsConversion | GaussiansConversion, progress) -> None:
        conversion.sample(self._options, progress)

    def _place(self, conversion: PointsConversion | GaussiansConversion, context) -> bpy.types.Object:
        source = conversion.source
        collections, name = collections_of(source, active_collection(context)), f"{source.name} surfels"
        made = add_surfel_object(name, conversion.surfels, conversion.matrix_world, collections, conversion.materials)
        render_like(made, source)
        return made
