# SPDX-License-Identifier: GPL-3.0-or-later
"""How much finer than the settings an object is sampled: `object.surfel_splatting.detail`."""

from __future__ import annotations

import bpy

from .ids import OBJECT_SETTINGS


def detail_of(source: bpy.types.Object) -> float:
    """How many times closer together the object's surfels are."""
    return getattr(source, OBJECT_SETTINGS).detail
