# SPDX-License-Identifier: GPL-3.0-or-later
"""Tells whether a mesh bounds a solid, so that no viewer outside ever sees the back of its surface.

If so, `Surfels.is_solid` lets the renderer skip splats that face away: half of the splats, and no rim of them along
silhouettes.
"""

from __future__ import annotations

import numpy as np

from .connectivity import connectivity
from .survey import signed_volumes, survey
from .triangle_mesh import TriangleMesh


def is_solid(mesh: TriangleMesh) -> bool:
    """Whether every edge is shared with a triangle that traverses it the other way, and every part faces outwards.

    Vertices at the same position count as one, because importers repeat them at seams. A ray from outside then always
    hits a front face first. Parts are connected by vertices; a part with negative or no volume (inside out, or a
    cavity) makes the answer False, which costs speed but is never wrong in the picture.
    """
    return SolidShape(mesh).is_solid_at(mesh.positions)


class SolidShape:
    """The topology that `is_solid` needs, computed once for a mesh whose vertices move."""

    def __init__(self, mesh: TriangleMesh):
        self._mesh = mesh
        self._is_closed = bool(len(mesh)) and bool(np.isfinite(mesh.bounds()).all()) and survey(mesh).is_closed
        if self._is_closed:
            connected = connectivity(mesh)
            self._twins, self._parts = connected.twins, connected.parts

    def is_solid_at(self, positions: np.ndarray) -> bool:
        """Whether the mesh is solid with these (V, 3) positions of the same vertices. False also if vertices that
        coincided have moved apart."""
        if not self._is_closed or not np.isfinite(positions).all():
            return False
        if positions is self._mesh.positions:
            volumes = survey(self._mesh).volumes
        elif self._twins is not None and not np.array_equal(positions[self._twins], positions):
            return False
        else:
            volumes = signed_volumes(positions, self._mesh.triangles)
        return bool((np.bincount(self._parts, volumes).take(self._parts) > 0).all())
