# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether a mesh bounds a solid, so that no viewer outside it ever sees the back of its surface.

Where that holds, `Surfels.is_solid` lets the renderer leave backs out: half the splats, and silhouettes without
the rim of those that stick out from behind.
"""

from __future__ import annotations

import numpy as np

from .connectivity import part_labels, twins
from .survey import signed_volumes, survey
from .triangle_mesh import TriangleMesh


def is_solid(mesh: TriangleMesh) -> bool:
    """Whether every triangle's edges are met by others running the other way, and every part turns outwards.

    Vertices at one place count as one, as importers split them at seams. Then a ray from outside enters before it
    leaves: first hits are always fronts. Parts are joined by vertices; one with a negative or no volume (turned
    inside out, a cavity) makes the answer False, which costs speed and never a picture.
    """
    return SolidShape(mesh).is_solid_at(mesh.positions)


class SolidShape:
    """What `is_solid` looks at, for a mesh whose vertices move: what hangs together is found once."""

    def __init__(self, mesh: TriangleMesh):
        self._mesh = mesh
        self._is_closed = bool(len(mesh)) and bool(np.isfinite(mesh.bounds()).all()) and survey(mesh).is_closed
        if self._is_closed:
            #: For each vertex, the first at its place; None: no place has several.
            self._twins = twins(mesh.places)
            self._parts = part_labels(mesh.triangles, self._twins).take(mesh.triangles[:, 0])

    def is_solid_at(self, positions: np.ndarray) -> bool:
        """positions: (V, 3) of the same vertices. False too where vertices that were at one place have parted."""
        if not self._is_closed or not np.isfinite(positions).all():
            return False
        if positions is self._mesh.positions:
            volumes = survey(self._mesh).volumes
        elif self._twins is not None and not np.array_equal(positions[self._twins], positions):
            return False
        else:
            volumes = signed_volumes(positions, self._mesh.triangles)
        return bool((np.bincount(self._parts, volumes).take(self._parts) > 0).all())
