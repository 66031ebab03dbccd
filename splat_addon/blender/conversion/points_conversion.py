# SPDX-License-Identifier: GPL-3.0-or-later
"""Converts the points of an object to a surfel object: the counterpart of `mesh_conversion` for objects without a
surface."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass

import bpy
import numpy as np
from mathutils import Matrix, Vector

from ...sampling import PointsReport, surfels_from_points
from ...surfels import Surfels
from ..geometry.points_extraction import ExtractedPoints, extract_points, sheared
from .batch import Batch
from .placement import without_shear
from .surfel_objects import add_surfel_object, collections_of


@dataclass(eq=False)
class PointsConversion:
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
    def name(self) -> str:
        return self.source.name

    @property
    def sources(self) -> list[bpy.types.Object]:
        return [self.source]

    @property
    def materials(self) -> tuple[bpy.types.Material | None, ...]:
        return self.points.materials

    @property
    def notes(self) -> list[str]:
        return list(self.report.notes())

    def is_warning(self, note: str) -> bool:
        """Whether anything was left out."""
        return note.startswith("Skipped")

    def summary(self) -> str:
        """A one-line summary of what was made."""
        return f"{self.report.points:,} points -> {len(self.surfels):,} surfels in {self.seconds:.1f} s"


class PointsBatch(Batch):
    """A batch of point objects.

    options: for `surfels_from_points`, without the viewpoint.
    viewpoint: returns the viewpoint in world space or None, or raises a ValueError.
    """

    def __init__(self, sources: list[bpy.types.Object], options: dict, viewpoint: Callable[[], Vector | None]):
        super().__init__([[source] for source in sources])
        self._options, self._viewpoint = options, viewpoint

    def _prepare(self, sources, depsgraph) -> PointsConversion:
        start, [source] = time.perf_counter(), sources
        matrix_world, shear = without_shear(source.evaluated_get(depsgraph).matrix_world)
        points = extract_points(source, depsgraph)
        if not len(points.positions):
            raise ValueError("It has no points to convert; give it vertices or points.")
        points = points if shear is None else sheared(points, shear)
        eye = self._viewpoint()
        eye = None if eye is None else np.array(matrix_world.inverted() @ eye)
        return PointsConversion(source, points, matrix_world, eye, time.perf_counter() - start)

    def _sample(self, conversion: PointsConversion, progress) -> None:
        start, points = time.perf_counter(), conversion.points
        conversion.surfels, conversion.report = surfels_from_points(
            points.positions,
            points.normals,
            points.radii,
            points.colors,
            viewpoint=conversion.viewpoint,
            progress=progress,
            **self._options,
        )
        conversion.seconds += time.perf_counter() - start

    def _place(self, conversion: PointsConversion, context) -> bpy.types.Object:
        source = conversion.source
        collections, name = collections_of(source, context.collection), f"{source.name} surfels"
        made = add_surfel_object(name, conversion.surfels, conversion.matrix_world, collections, conversion.materials)
        made.pass_index = source.pass_index
        return made
