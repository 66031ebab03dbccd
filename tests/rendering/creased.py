# SPDX-License-Identifier: GPL-3.0-or-later
"""An angle iron for tests of edges: a solid of flat faces with convex, concave and reflex corners.

Each face has one colour, and none is parallel to an axis.
"""

from __future__ import annotations

import numpy as np

from splat_addon.rendering import Camera, Scene, look_at
from splat_addon.sampling import DEFAULT_CREASE_ANGLE, Channel, Surface, TriangleMesh, VertexColors, is_solid
from tests.plain import sample_surface

_OUTLINE = np.array(((0, 0), (2, 0), (2, 1), (1, 1), (1, 2), (0, 2)), np.float64) - 0.8


def angle_iron() -> TriangleMesh:
    """The angle iron, coloured by the normals of its faces."""
    flat = np.concatenate([np.column_stack([_OUTLINE, np.full(6, z)]) for z in (-0.5, 0.5)])
    below = [(0, k + 1, k) for k in range(1, 5)]
    above = [(6, 6 + k, 7 + k) for k in range(1, 5)]
    walls = [t for k in range(6) for t in ((k, (k + 1) % 6, 6 + k), ((k + 1) % 6, 6 + (k + 1) % 6, 6 + k))]
    triangles = np.array([*below, *above, *walls])
    first, second, third = (flat[triangles[:, k]] for k in range(3))
    normals = np.cross(second - first, third - first)
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    normals = np.repeat(normals[:, None], 3, axis=1)
    colors = np.concatenate([normals / 2 + 0.5, np.ones((*normals.shape[:2], 1))], axis=2).astype(np.float32)
    turn = look_at((1.0, 0.55, 0.4), (0, 0, 0))[:3, :3]
    surface = Surface(Channel((1, 1, 1, 1), VertexColors()))
    return TriangleMesh(
        flat @ turn.T, triangles, corner_normals=normals @ turn.T, corner_colors=colors, surfaces=(surface,)
    )


def clipped_iron(size: tuple[int, int], resolution: float = 48, **changes) -> tuple[Scene, Camera]:
    """The scene and camera of the angle iron's surfels, which end at its edges and have blend depths.

    changes: options of `sample_surface` that differ.
    """
    mesh, options = angle_iron(), {"crease_angle": DEFAULT_CREASE_ANGLE, "fits_blending": True} | changes
    surfels = sample_surface(mesh, resolution=resolution, **options).surfels
    camera = Camera.perspective(look_at((1.5, -5, 2.5), (0.1, 0, 0)), 0.7, size, near=0.1, far=100)
    return Scene((surfels.as_solid() if is_solid(mesh) else surfels,)), camera
