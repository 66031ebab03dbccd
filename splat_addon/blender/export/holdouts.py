# SPDX-License-Identifier: GPL-3.0-or-later
"""Materials that are a Holdout: what has them becomes an instance of its own that is held out, as whole objects are."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from weakref import WeakKeyDictionary

import bpy
import numpy as np

from ...rendering import Instance, PolygonInstance
from ...surfels import Shape
from ..materials.surface_shaders import is_holdout

#: shape -> the slots that are holdouts, and its parts without them and with them: the same objects as long as these are
#: the same, so that they stay on the device
_PARTS: WeakKeyDictionary[Shape, tuple[list[int], Shape, Shape]] = WeakKeyDictionary()


def held_slots(slots: Sequence[bpy.types.Material | None]) -> list[int]:
    """The slots whose material is a Holdout."""
    return [k for k, material in enumerate(slots) if material is not None and is_holdout(material)]


def with_holes(instance: Instance | PolygonInstance, held: list[int]) -> list[Instance | PolygonInstance]:
    """The instance, in two if only some of its materials are holdouts. held: result of `held_slots`."""
    if not held or instance.is_holdout:
        return [instance]
    if len(held) == len(instance.materials):
        return [replace(instance, is_holdout=True)]
    if instance.shape not in _PARTS or _PARTS[instance.shape][0] != held:
        are_held = np.isin(np.minimum(instance.shape.materials, len(instance.materials) - 1), held)
        _PARTS[instance.shape] = held, *(instance.shape.take(np.flatnonzero(some)) for some in (~are_held, are_held))
    _, seen, holes = _PARTS[instance.shape]
    parts = replace(instance, shape=seen), replace(instance, shape=holes, is_holdout=True)
    return [part for part in parts if len(part.shape)]
