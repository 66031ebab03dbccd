# SPDX-License-Identifier: GPL-3.0-or-later
"""Which instances show their backs to a camera, judged from some of their surfels."""

from __future__ import annotations

import numpy as np

from ...quaternions import quaternion_axes
from ..scene.camera import Camera
from ..scene.table import InstanceTable

#: Surfels of an instance that are looked at, and of all together.
_SOME, _MOST = 256, 1 << 20


def show_backs(table: InstanceTable, camera: Camera) -> np.ndarray:
    """(n,) bool: whether some surfels of instances of surfels face away from the camera and are drawn."""
    from_eye, found = table.from_eye(camera), np.zeros(len(table), bool)
    are_hidden = table.of_kinds(lambda i: i.is_closed) & (-from_eye.corners[..., 2] >= camera.near).all(axis=1)
    rows = np.flatnonzero(~are_hidden & ~table.are_flattened)
    # an affine map keeps the sides of a plane, so they are told in the object's own space
    matrices = from_eye.model_views[rows]
    to_eye = np.tile((0.0, 0.0, 1.0), (len(rows), 1)) if camera.is_orthographic else -matrices[:, :3, 3]
    eyes = np.linalg.solve(matrices[:, :3, :3], to_eye[..., None])[..., 0]
    some = max(min(_SOME, _MOST // max(len(rows), 1)), 1)
    for shape in np.unique(table.shape_of[rows]).tolist():
        surfels, own = table.shapes[shape], table.shape_of[rows] == shape
        step = slice(None, None, max(-(-len(surfels) // some), 1))
        normals = quaternion_axes(surfels.rotations[step])[2]
        heights = 0.0 if camera.is_orthographic else np.sum(normals * surfels.positions[step], axis=1)
        found[rows[own]] = (eyes[own] @ normals.T - heights < 0).any(axis=1)
    return found
