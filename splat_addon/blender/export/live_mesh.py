# SPDX-License-Identifier: GPL-3.0-or-later
"""A mesh that is rendered without a conversion, at all its places, and what was made of it for earlier frames."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace

import numpy as np

from ...rendering import Polygons
from ...rendering.scene import Placed, placed_at
from ...rendering.scene.placements import Placements, placements
from ...sampling import DeformingSurfels, TriangleMesh
from ...surfels import Surfels
from ..density import Density
from ..materials.surface_textures import kept_maps
from .holdouts import with_holes
from .mesh_reading import MeshReading
from .places import Manner, Places, parts_at


@dataclass(eq=False)
class LiveMesh:
    """One evaluated mesh, with all its places. read: what it is now; None before the first reading. owner: name of the
    object that shows it. maps: result of `kept_maps` by field.

    places: where it is while a frame is read; None otherwise.

    Of its sampling: `deforming`; `spacing`, in its own units; `looks` and `density`, the options that it was made with,
    see `looks_of_meshes` and `density_of_meshes`. settled: for which mesh, and what else, the spacing was found. shown:
    the sampling, and the surfels drawn from it. drawn: a mesh, and its polygons.
    """

    read: MeshReading | None = None
    owner: str = ""
    places: Places | None = None
    maps: dict[str, tuple] = field(default_factory=dict)
    deforming: DeformingSurfels | None = None
    spacing: float = 0.0
    looks: dict[str, bool] = field(default_factory=dict)
    density: Density | None = None
    settled: tuple[TriangleMesh | None, tuple] = (None, ())
    shown: tuple[Surfels, Surfels] | None = None
    drawn: tuple[TriangleMesh, tuple[Polygons, ...]] | None = None

    @property
    def sampled_at(self) -> Places:
        return self.places.where(lambda form: form.has_surfels)

    @property
    def drawn_at(self) -> Places:
        return self.places.where(lambda form: form.has_polygons)

    @property
    def matrices(self) -> np.ndarray:
        """(n, 4, 4) float64 matrices of the places where it is sampled."""
        return self.sampled_at.matrices.astype(np.float64)

    @property
    def detail(self) -> float:
        """The highest detail that any of its places requests."""
        return max(manner.detail for manner in self.sampled_at.manners)

    def be_surfels(self) -> None:
        """Let places of a mesh that polygons cannot show be in the form that it needs."""
        self.places = self.places.with_manners(lambda manner: manner._replace(form=manner.form.of_surfels))

    def placed(self, made: Callable[..., Placed], places: Places) -> Placements:
        """Instances at places. made: makes one of them from its fields, once for each manner."""
        parts = [self._in_manner(made, manner) for manner in places.manners]
        rows, of = parts_at(places.of, list(map(len, parts)))
        instances = placed_at([part for own in parts for part in own], places.matrices[rows], of)
        pixels = [manner.form.split_pixels for manner in places.manners]
        if not any(pixels):
            return instances
        each = zip(instances, places.of[rows].tolist(), strict=True)
        return placements(self._split(one, pixels[number]) for one, number in each)

    def _in_manner(self, made: Callable[..., Placed], manner: Manner) -> list[Placed]:
        materials, distance = manner.style.on(self.read.materials), manner.form.split_distance
        instance = made(materials=materials, split_distance=distance, **manner.traits._asdict())
        return with_holes(instance, self.read.held)

    def _split(self, placed: Placed, pixels: float | None) -> Placed:
        if pixels is None:
            return placed
        # None: a matrix of zeros leaves nothing to see
        return replace(placed, split_length=self.spacing * _stretch(placed.matrix_world) / pixels or None)

    def looked_up(self, field: str) -> tuple:
        """What is looked up of its surfaces, for one field of `MAPS`."""
        self.maps[field] = kept_maps(self.maps.get(field, ()), self.read.content.triangles.surfaces, field)
        return self.maps[field]


def _stretch(matrix: np.ndarray) -> float:
    """The largest factor by which a matrix lengthens."""
    return float(np.linalg.norm(matrix[:3, :3], 2))
