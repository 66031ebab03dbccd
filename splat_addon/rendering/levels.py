# SPDX-License-Identifier: GPL-3.0-or-later
"""Levels of detail: which surfels of an instance a view draws, or which merged surfels instead.

The view is transformed into the object's space and passed to the object's hierarchy; the result is a list of indices,
of surfels first and then of merged nodes, in storage order.
"""

from __future__ import annotations

from dataclasses import replace
from weakref import WeakKeyDictionary

import numpy as np

from ..hierarchy import Hierarchy, Sight, Split, build_hierarchy
from ..hierarchy.merging import OVERLAP
from ..surfels import Surfels
from .scene import Instance
from .scene.camera import Camera
from .stand_in import STAND_INS

#: For fewer surfels than this a cut saves less than it costs.
LEAST_SURFELS = 4096

#: A method's filter may show splats that are less than this many pixels outside the picture.
_BESIDE = 8.0

#: The error of the finest merged surfels that are worth a hierarchy, in spacings, at most.
_FINEST_ERROR = 2.0

_BUILT: WeakKeyDictionary[Surfels, Hierarchy] = WeakKeyDictionary()


def hierarchy_of(surfels: Surfels) -> Hierarchy:
    """The hierarchy of a set of surfels, built on first use and kept as long as the set."""
    if surfels not in _BUILT:
        _BUILT[surfels] = build_hierarchy(surfels)
    return _BUILT[surfels]


def built_hierarchy(surfels: Surfels) -> Hierarchy | None:
    """Their hierarchy if it has been built."""
    return _BUILT.get(surfels)


def keep_hierarchy(surfels: Surfels, hierarchy: Hierarchy) -> None:
    """Keep a hierarchy that was built elsewhere."""
    _BUILT[surfels] = hierarchy


def has_levels(instance: Instance) -> bool:
    """Whether an instance may be drawn as merged surfels: it needs many, opaque surfels, not merged already, that
    stay where they are."""
    is_cut = instance.is_cut or instance.surfels in STAND_INS
    is_excluded = is_cut or instance.deforms or instance.is_transparent
    return len(instance.surfels) >= LEAST_SURFELS and not is_excluded


def may_merge(instance: Instance, camera: Camera, tolerance: float) -> bool:
    """Whether, seen from its farthest corner, merged surfels may be within the tolerance, judged from a sample."""
    if not tolerance or not has_levels(instance):
        return False
    if instance.surfels in _BUILT:
        return True
    linear = instance.model_view(camera)[:3, :3]
    some = instance.surfels.scales[:: max(len(instance.surfels) // LEAST_SURFELS, 1)]
    spacing = float(np.median(some.min(axis=1))) / OVERLAP
    farthest = float(-instance.corners(camera)[:, 2].min())
    pixels = camera.pixels_per_unit() * float(np.linalg.norm(linear, 2))
    return _FINEST_ERROR * spacing * pixels <= tolerance * (1 if camera.is_orthographic else max(farthest, camera.near))


def sight(
    instance: Instance,
    camera: Camera,
    hides_backs: bool,
    tolerance: float,
    split_distances: tuple[float, float] | None = None,
) -> Sight:
    """A camera's view of an instance. tolerance: in pixels of the camera's picture. split_distances: where the surfels
    of a split object begin, and where its polygons end, world units."""
    matrix = instance.model_view(camera)
    x, y, depth = matrix[0], matrix[1], -matrix[2]
    left, right, bottom, top = camera.whole_pixels()
    across, up = _BESIDE * (right - left) / camera.size[0], _BESIDE * (top - bottom) / camera.size[1]
    one = np.array([0, 0, 0, 1.0])
    spread = one if camera.is_orthographic else depth
    planes = (
        x - (left - across) * spread,
        (right + across) * spread - x,
        y - (bottom - up) * spread,
        (top + up) * spread - y,
        depth - camera.near * one,
        camera.far * one - depth,
    )
    inverse = np.linalg.inv(matrix[:3, :3])
    if camera.is_orthographic:
        eye = np.append(inverse[:, 2] / np.linalg.norm(inverse[:, 2]), 0.0)
    else:
        eye = np.append(-inverse @ matrix[:3, 3], 1.0)
    pixels = camera.pixels_per_unit() * float(np.linalg.norm(matrix[:3, :3], 2))
    seen = Sight(np.array(planes), depth, pixels, camera.near, eye, hides_backs, tolerance)
    return replace(seen, split=Split(matrix[:3], *split_distances)) if split_distances else seen
