# SPDX-License-Identifier: GPL-3.0-or-later
"""Few triangles that reach hundreds of times as far as all others: at a density that suits these, they alone would be
more surfels than any memory holds.
"""

from __future__ import annotations

import numpy as np

from .cleaning import drop_unusable
from .triangle_mesh import TriangleMesh

#: They reach this many times as far as the nearest quarter of the corners around one in their midst, judged from so
#: many of them, and are at most this share of all triangles.
REACH, _SOME, _FEW = 512, 64, 1 / 64


def drop_strays(mesh: TriangleMesh) -> tuple[TriangleMesh, int]:
    """The mesh without its strays, and their number; the mesh itself if there are none, or they are many."""
    if len(mesh) < 1 / _FEW:
        return mesh, 0
    corners = mesh.positions[mesh.triangles[:, 0]]
    some = corners[:: -(-len(corners) // _SOME)]
    distances = np.sort(np.abs(some[:, None] - some).max(axis=2), axis=1)[:, -(-(len(some) - 1) // 4)]
    midst, extent = some[distances.argmin()], float(distances.min())
    # NaN is no place
    low, high = np.fmin.reduce(mesh.positions), np.fmax.reduce(mesh.positions)
    if not np.maximum(high - midst, midst - low).max() > REACH * extent > 0:
        return mesh, 0
    is_far = np.abs(mesh.positions - midst).max(axis=1) > REACH * extent
    are_strays = is_far[mesh.triangles].any(axis=1)
    count = int(np.count_nonzero(are_strays))
    if not 0 < count <= _FEW * len(mesh):
        return mesh, 0
    return drop_unusable(mesh.with_triangles(np.flatnonzero(~are_strays)))[0], count
