# SPDX-License-Identifier: GPL-3.0-or-later
"""How much finer than the settings an object is sampled: `object.surfel_splatting.detail`."""

from __future__ import annotations

import bpy

from .ids import OBJECT_SETTINGS

#: kind of density -> the power of the detail by which its number changes
_POWERS = {"resolution": 1, "spacing": -1, "pixels": -1, "automatic": -1, "count": 2}


def detail_of(source: bpy.types.Object) -> float:
    """How many times closer together the object's surfels are."""
    return getattr(source, OBJECT_SETTINGS).detail


def finer(density: dict[str, float], detail: float) -> dict[str, float]:
    """The same kind of density for surfels that are `detail` times closer together."""
    return {kind: value * detail ** _POWERS[kind] for kind, value in density.items()}
