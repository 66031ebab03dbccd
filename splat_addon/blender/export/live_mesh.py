# SPDX-License-Identifier: GPL-3.0-or-later
"""A mesh that is rendered without a conversion, at all its places, and what was made of it for earlier frames."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import NamedTuple

import numpy as np

from ...rendering import Polygons
from ...rendering.scene import Placed, placed_at
from ...rendering.scene.placements import Placements, placements
from ...sampling import DeformingSurfels, TriangleMesh
from ...surfels import Surfels
from ..density import Density
from ..materials.surface_textures import kept_maps
from ..mesh_sampling_settings import Form
from .holdouts import with_holes
from .mesh_reading import MeshReading
from .styles import OF_MATERIALS, ObjectStyle
from .traits import Traits


class Manner(NamedTuple):
    """What is the same at many places of a mesh. traits: of its instances. form: how it is rendered, see `form_of`.
    detail: of its object. style: what replaces that of its materials."""

    traits: Traits
    form: Form
    detail: float
    style: ObjectStyle = OF_MATERIALS


class Place(NamedTuple):
    """One place of a mesh. matrix: (4, 4) float64."""

    matrix: np.ndarray
    manner: Manner


@dataclass(eq=False)
class LiveMesh:
    """One evaluated mesh, with all its places. read: what it is now; None before the first reading. owner: name of the
    object that shows it. maps: result of `kept_maps` by field.

    Of its sampling: `deforming`; `spacing`, in its own units; `looks` and `density`, the options that it was made with,
    see `looks_of_meshes` and `density_of_meshes`. settled: for which mesh, and what else, the spacing was found. shown:
    the sampling, and the surfels drawn from it. drawn: a mesh, and its polygons.
    """

    read: MeshReading | None = None
    owner: str = ""
    places: list[Place] = field(default_factory=list)
    maps: dict[str, tuple] = field(default_factory=dict)
    deforming: DeformingSurfels | None = None
    spacing: float = 0.0
    looks: dict[str, bool] = field(default_factory=dict)
    density: Density | None = None
    settled: tuple[TriangleMesh | None, tuple] = (None, ())
    shown: tuple[Surfels, Surfels] | None = None
    drawn: tuple[TriangleMesh, tuple[Polygons, ...]] | None = None

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

    def placed(self, made: Callable[..., Placed], places: list[Place]) -> Placements:
        """Instances at places. made: makes one of them from its fields, once for each manner."""
        parts, pixels, rows, of, matrices = [], [], {}, [], []
        for matrix, manner in places:
            if id(manner) not in rows:
                materials, distance = manner.style.on(self.read.materials), manner.form.split_distance
                instance = made(materials=materials, split_distance=distance, **manner.traits._asdict())
                own = with_holes(instance, self.read.held)
                rows[id(manner)] = range(len(parts), len(parts) + len(own))
                parts += own
                pixels += [manner.form.split_pixels] * len(own)
            for row in rows[id(manner)]:
                of.append(row)
                matrices.append(matrix)
        instances = placed_at(parts, np.array(matrices), np.array(of, int))
        if not any(pixels):
            return instances
        return placements(self._split(one, pixels[row]) for one, row in zip(instances, of, strict=True))

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
