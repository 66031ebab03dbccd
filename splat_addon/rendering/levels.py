# SPDX-License-Identifier: GPL-3.0-or-later
"""Levels of detail: which surfels of an instance a view draws, or which merged surfels instead.

The view is transformed into the object's space and passed to the object's hierarchy; the result is a list of indices,
of surfels first and then of merged nodes, in storage order.
"""

from __future__ import annotations

from weakref import WeakKeyDictionary

import numpy as np

from ..hierarchy import Hierarchy, Sight, build_hierarchy
from ..hierarchy.merging import OVERLAP
from ..surfels import Surfels
from .scene import Instance
from .scene.camera import Camera

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
    stay where they are. Objects that are split by distance from the camera are excluded, because their surfels are
    selected by position."""
    is_excluded = instance.is_cut or instance.deforms or instance.is_transparent or instance.split_distance is not None
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
    pixels = _pixels(camera) * float(np.linalg.norm(linear, 2))
    return _FINEST_ERROR * spacing * pixels <= tolerance * (1 if camera.is_orthographic else max(farthest, camera.near))


def sight(instance: Instance, camera: Camera, hides_backs: bool, tolerance: float) -> Sight:
    """A camera's view of an instance. tolerance: in pixels of the camera's picture."""
    matrix = instance.model_view(camera)
    x, y, depth = matrix[0], matrix[1], -matrix[2]
    left, right, bottom, top = _whole_pixels(camera)
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
    pixels = _pixels(camera) * float(np.linalg.norm(matrix[:3, :3], 2))
    return Sight(np.array(planes), depth, pixels, camera.near, eye, hides_backs, tolerance)


def _whole_pixels(camera: Camera) -> tuple[float, float, float, float]:
    """The camera's window moved by less than a pixel, so that all samples of a picture have one cut."""
    (left, right, bottom, top), edges = camera.window, []
    for first, last, count in ((left, right, camera.size[0]), (bottom, top, camera.size[1])):
        step = float(f"{(last - first) / count:.11g}")  # without the last digits, which moving changes
        middle = round((first + last) / 2 / step) * step
        edges += [middle - count / 2 * step, middle + count / 2 * step]
    return tuple(edges)


def _pixels(camera: Camera) -> float:
    """Pixels per world unit at distance 1, or anywhere for a parallel view."""
    left, right, bottom, top = _whole_pixels(camera)
    return max(camera.size[0] / (right - left), camera.size[1] / (top - bottom))
