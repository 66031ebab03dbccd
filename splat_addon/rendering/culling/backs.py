# SPDX-License-Identifier: GPL-3.0-or-later
"""Which instances show their backs to a camera, judged from some of their surfels."""

from __future__ import annotations

from weakref import WeakKeyDictionary

import numpy as np

from ...quaternions import quaternion_axes
from ...surfels import Surfels
from ..scene.camera import Camera
from ..scene.table import InstanceTable

#: Surfels of an instance that are looked at, and of all together.
_SOME, _MOST = 256, 1 << 16

#: Instances of a set that are looked at together with those of other sets.
_FEW = 4


def show_backs(table: InstanceTable, camera: Camera) -> np.ndarray:
    """(n,) bool: whether some surfels of instances of surfels face away from the camera and are drawn."""
    from_eye, found = table.from_eye(camera), np.zeros(len(table), bool)
    are_hidden = table.of_kinds(lambda i: i.is_closed) & (-from_eye.corners[..., 2] >= camera.near).all(axis=1)
    rows = np.flatnonzero(~are_hidden & ~table.are_flattened)
    # an affine map keeps the sides of a plane, so they are told in the object's own space
    eyes = from_eye.eyes[rows]
    some = max(min(_SOME, _MOST // max(len(rows), 1)), 1)
    shapes, shape_of = table.shapes, table.shape_of[rows]
    instances = np.bincount(shape_of, minlength=len(shapes))
    for shape in np.flatnonzero(instances > _FEW).tolist():
        normals, heights = _planes(shapes[shape], some)
        own = shape_of == shape
        found[rows[own]] = (eyes[own] @ normals.T - _at(heights, camera) < 0).any(axis=1)
    # thousands of small arrays are looked at as one
    own = np.flatnonzero((instances <= _FEW)[shape_of])
    if len(own):
        each = [_planes(shapes[shape], some) for shape in shape_of[own].tolist()]
        counts = np.array([len(heights) for _, heights in each])
        normals, heights = (np.concatenate(parts) for parts in zip(*each, strict=True))
        owner = np.repeat(np.arange(len(own)), counts)
        are_away = np.einsum("ij,ij->i", eyes[own][owner], normals) - _at(heights, camera) < 0
        found[rows[own]] = np.bincount(owner[are_away], minlength=len(own)) > 0
    return found


def _at(heights: np.ndarray, camera: Camera) -> np.ndarray | float:
    """How high planes lie that are compared with where a camera is, or for a parallel one with where it looks."""
    return 0.0 if camera.is_orthographic else heights


#: Sets of surfels -> what was found of them, and of how many at most.
_KNOWN: WeakKeyDictionary[Surfels, tuple[int, np.ndarray, np.ndarray]] = WeakKeyDictionary()


def _planes(surfels: Surfels, some: int) -> tuple[np.ndarray, np.ndarray]:
    """(k, 3) normals and (k,) heights of the planes of some surfels; kept as long as these are."""
    known = _KNOWN.get(surfels)
    if known is None or known[0] != some:
        step = slice(None, None, max(-(-len(surfels) // some), 1))
        normals = quaternion_axes(surfels.rotations[step])[2]
        known = _KNOWN[surfels] = some, normals, np.sum(normals * surfels.positions[step], axis=1)
    return known[1:]
