# SPDX-License-Identifier: GPL-3.0-or-later
"""The hierarchies of sets of surfels, which are kept as long as the sets, and what the sets replaced.

What is kept here changes no picture by itself: `history` tells a plan what is there.
"""

from __future__ import annotations

from weakref import WeakKeyDictionary

import numpy as np

from ...hierarchy import Hierarchy, Told, build_hierarchy, has_extremes, refit_hierarchy, without_lines
from ...surfels import Surfels
from ..scene import Scene

#: For fewer surfels than this a cut saves less than it costs.
LEAST_SURFELS = 4096

#: The most by which errors of a refitted hierarchy may have grown, relative to the surfels; beyond, another is built.
_WORN = 2.0

_BUILT: WeakKeyDictionary[Surfels, Hierarchy] = WeakKeyDictionary()
#: The hierarchies of what sets were in the frame before; None if they had none.
_BEFORE: WeakKeyDictionary[Surfels, Hierarchy | None] = WeakKeyDictionary()


def hierarchy_of(surfels: Surfels) -> Hierarchy:
    """The hierarchy of a set of surfels, made on first use and kept as long as the set."""
    if surfels not in _BUILT:
        keep_hierarchy(surfels, make_hierarchy(surfels, hierarchy_before(surfels)))
    return _BUILT[surfels]


def make_hierarchy(surfels: Surfels, before: Hierarchy | None, told: Told | None = None) -> Hierarchy:
    """A hierarchy fitted from the one that the surfels had before they moved, or built if there is none or it fits
    badly. Small sets only have one if many instances are drawn together. told: as in `build_hierarchy`."""
    made = _fitted(before, surfels)
    made = build_hierarchy(surfels, told) if made is None else made
    return without_lines(made, surfels) if len(surfels) < LEAST_SURFELS else made


def _fitted(before: Hierarchy | None, surfels: Surfels) -> Hierarchy | None:
    """The hierarchy that surfels had before they moved, fitted to them; None if it does not fit."""
    if before is None or has_extremes(surfels):
        return None
    fitted = refit_hierarchy(before, surfels)
    return fitted if fitted.looseness(surfels) <= _WORN * fitted.built_looseness else None


def built_hierarchy(surfels: Surfels) -> Hierarchy | None:
    """Their hierarchy if it has been built."""
    return _BUILT.get(surfels)


def keep_hierarchy(surfels: Surfels, hierarchy: Hierarchy) -> None:
    """Keep a hierarchy that was made elsewhere."""
    _BUILT[surfels] = hierarchy
    _BEFORE.pop(surfels, None)


def hierarchy_before(surfels: Surfels) -> Hierarchy | None:
    """The hierarchy that a set had in the frame before, which can be fitted to it."""
    return _BEFORE.get(surfels)


def replaced(before: Surfels, now: Surfels) -> None:
    """The set of an object was replaced by another in a new frame. If that has as many surfels of the same materials,
    they are taken to be the same ones, moved."""
    if now is not before:
        is_moved = len(before) == len(now) and np.array_equal(before.materials, now.materials)
        _BEFORE[now] = _BUILT.get(before, _BEFORE.get(before)) if is_moved else None


def forget_before(scene: Scene) -> None:
    """Have the hierarchies of this frame built, not fitted from those of the frame before, which merge others."""
    for shape in scene.table.shapes:
        _BEFORE.pop(shape, None)


def was_replaced(surfels: Surfels) -> bool:
    """Whether a set has just taken the place of another, and no hierarchy has been made for it."""
    return surfels in _BEFORE
