# SPDX-License-Identifier: GPL-3.0-or-later
"""Which objects may cast a shadow on what a camera sees: those that touch the convex hull of the light and of the
visible part of space.
"""

from __future__ import annotations

import numpy as np

from ..depth_range import are_outside
from ..scene.boxes import corners_times
from ..scene.camera import Camera
from ..scene.light import Light
from .hexahedra import EDGES, face_planes, planes
from .receivers import FILTER_REACH, Receivers

#: For fewer objects, looking costs more than it may save.
_LEAST_OBJECTS = 4


def in_the_way(light: Light, texel: float, seen: list[Receivers], spread: float, corners: np.ndarray) -> np.ndarray:
    """(n,) whether boxes with these (n, 8, 3) world corners may block the light on its way to what cameras see.

    texel: length of one of its map's, world units; of a lamp's at distance 1. spread: as in `looked_up`.
    """
    if len(corners) < _LEAST_OBJECTS:
        return np.ones(len(corners), bool)
    found = np.zeros(len(corners), bool)
    for one in seen:
        middle, lamp, distance = one.space.mean(axis=0), np.append(-np.asarray(light.direction, np.float64), 0.0), 1.0
        if light.kind != "sun":
            lamp = np.append(light.position - middle, 1.0)
            distance = np.linalg.norm(one.space - light.position, axis=1).max()
        reach = one.outside + spread + FILTER_REACH * texel * distance
        hull = hull_planes(one.space - middle, lamp)
        inward = corners_times(corners - middle, hull[:, :3].T) + hull[:, 3]
        found |= (inward > -reach).any(axis=1).all(axis=1)
    return found


def hull_planes(space: np.ndarray, lamp: np.ndarray) -> np.ndarray:
    """(m, 4) planes around the convex hull of (8, 3) corners and a lamp (4,), which is a place with 1 or a direction
    with 0; their unit normals point inward.

    These are the faces that the lamp is not in front of, and the planes through the lamp and each edge between such a
    face and another one. A face without an area has a plane of zeros, on both sides of which everything is.
    """
    faces = face_planes(space)
    is_kept = faces @ lamp >= 0
    start, end, _, _ = EDGES[is_kept[EDGES[:, 2]] != is_kept[EDGES[:, 3]]].T
    normals = np.cross(space[end] - space[start], lamp[:3] - lamp[3] * space[start])
    return np.concatenate([faces[is_kept], planes(normals, space[start], space.mean(axis=0))])


def sees(camera: Camera, corners: np.ndarray) -> np.ndarray:
    """(n,) whether the boxes with these (n, 8, 3) world corners may be in the camera's picture."""
    return ~are_outside(corners_times(corners - camera.matrix_world[:3, 3], camera.matrix_world[:3, :3]), camera)
