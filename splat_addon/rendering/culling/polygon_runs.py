# SPDX-License-Identifier: GPL-3.0-or-later
"""Which triangles of an object a view draws: blocks of them that are outside the picture, or beyond the distance at
which a split object goes over to surfels, are left out, and nothing differs.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ...hierarchy.cuts import Boxes, Split, distances
from ..detail.levels import sight
from ..scene.camera import Camera
from ..scene.polygons import BLOCK
from ..view import DrawItem

#: For fewer triangles, looking costs more than it may save.
_LEAST_TRIANGLES = 4 * BLOCK


def triangle_runs(placed: DrawItem, camera: Camera) -> list[range]:
    """The numbers of the triangles to draw, in order. Their order in the mesh decides how well blocks tell what is
    seen."""
    polygons = placed.instance.polygons
    if polygons.triangles < _LEAST_TRIANGLES:
        return [range(polygons.triangles)]
    low, high = polygons.block_bounds
    boxes = Boxes((low + high) / 2, (high - low) / 2)
    seen = sight(placed.instance, camera, False, 0.0)
    # the sides of the picture, and before the eye: what is drawn may be moved back, along its ray
    planes = seen.planes[:4] if camera.is_orthographic else np.vstack([seen.planes[:4], seen.depth])
    is_drawn = (planes[:, :3] @ boxes.middle + planes[:, 3:] + np.abs(planes[:, :3]) @ boxes.half >= 0).all(axis=0)
    if placed.split_distance:
        end = placed.split_distance / placed.items.scale * (1 + 1e-5)
        split = Split(placed.instance.model_view(camera)[:3], 0.0, end)
        nearest, _ = distances(boxes, replace(seen, split=split))
        is_drawn &= nearest <= end
    edges = np.flatnonzero(np.diff(np.concatenate([[False], is_drawn, [False]]).astype(np.int8))) * BLOCK
    return [range(a, min(b, polygons.triangles)) for a, b in edges.reshape(-1, 2).tolist()]
