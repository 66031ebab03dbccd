# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfels that follow a deforming mesh: the same surfels in the same order as long as the mesh keeps its triangles.

The mesh is sampled once; afterwards each surfel moves with its triangle (`binding`). Covered areas stay covered, except
that coverage can thin out at edges between triangles that stretch differently.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ...surfels import Surfels
from ..mesh.joining import have_same_values
from ..mesh.solid import SolidShape
from ..mesh.triangle_mesh import TriangleMesh
from ..sample import sample_surface
from .binding import Binding

#: If more than this share of the surfels is stretched too far, the mesh should be sampled again.
STRETCHED_SHARE = 0.01


class DeformingSurfels:
    """The surfels of one sampling, and their current positions.

    mesh: the mesh as sampled. options: those of `sample_surface`; without a tolerance, all surfels have the same size.
        `mesh` and `sampling` hold the current state.
    """

    def __init__(self, mesh: TriangleMesh, **options):
        self.mesh, self._options = mesh, {"tolerance": None} | options
        self.sampling = sample_surface(mesh, **self._options)
        self._shape = SolidShape(mesh) if self.sampling.keeps_both_sides else None
        self._surfels = self._as_solid_as(mesh, self.sampling.surfels)
        self._last = mesh, (self._surfels, 0.0)
        self._binding = None

    def has_triangles_of(self, mesh: TriangleMesh) -> bool:
        """Whether the mesh has the same number of vertices and the same triangles."""
        has_as_many = len(mesh.positions) == len(self.mesh.positions)
        return has_as_many and np.array_equal(mesh.triangles, self.mesh.triangles)

    def at(self, mesh: TriangleMesh) -> tuple[Surfels, float]:
        """The surfels on the mesh in its current shape, and the share of surfels or of area that grew too far
        (`binding`).

        mesh: must have the same triangles and number of vertices. Changed colours or other corner values cost a second
            sampling. Raises ValueError for another topology; surfels at non-finite vertices stay where they were,
            shrunk to dots.
        """
        if not self.has_triangles_of(mesh):
            raise ValueError("The mesh has other triangles than the one that was sampled; sample it again.")
        if not have_same_values(_appearance(mesh), _appearance(self.mesh)):
            self._repaint(mesh)
        elif have_same_values(_shape(mesh), _shape(self._last[0])):
            return self._last[1]
        if have_same_values(_shape(mesh), _shape(self.mesh)):
            self._last = mesh, (self._surfels, 0.0)
            return self._last[1]
        if self._binding is None:
            self._binding = Binding(self.mesh, self.sampling)
        arrays, origin, stretched = self._binding.arrays_on(mesh)
        surfels = Surfels(origin=origin, **(self.sampling.surfels.arrays() | arrays))
        self._last = mesh, (self._as_solid_as(mesh, surfels), stretched)
        return self._last[1]

    def _repaint(self, mesh: TriangleMesh):
        """Sample again with the corner values of `mesh`; the positions depend on the shape alone and stay."""
        self.mesh = replace(mesh, positions=self.mesh.positions, corner_normals=self.mesh.corner_normals)
        self.sampling = sample_surface(self.mesh, **self._options)
        self._surfels = replace(self.sampling.surfels, is_solid=self._surfels.is_solid)
        if self._binding is not None and len(self.sampling.surfels) != self._binding.count:
            self._binding = None  # other colours make other borders, and other gaps beside them
        if self._binding is not None:
            self._binding.repaint(self.mesh, self.sampling.surfels)

    def _as_solid_as(self, mesh: TriangleMesh, surfels: Surfels) -> Surfels:
        is_solid = self._shape is not None and self._shape.is_solid_at(mesh.positions)
        return surfels.as_solid() if is_solid else surfels


def _shape(mesh: TriangleMesh) -> tuple:
    return mesh.positions, mesh.corner_normals


def _appearance(mesh: TriangleMesh) -> tuple:
    return mesh.corner_colors, mesh.corner_uvs, mesh.materials, mesh.surfaces
