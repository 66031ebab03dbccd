# SPDX-License-Identifier: GPL-3.0-or-later
"""The Material Override of a view layer: everything is drawn with that one material."""

from __future__ import annotations

from dataclasses import replace

import bpy
import numpy as np

from ...surfels import Surfels
from ..geometry.derived import Derived
from .material_surfaces import plain_color

#: The fields of surfels that come from their own materials; the others belong to their form.
_OF_MATERIALS = ("roughness", "metallic", "emission", "uvs", "uv_along_x", "uv_along_y", "uv_border")


def override_of(depsgraph: bpy.types.Depsgraph) -> bpy.types.Material | None:
    """The override material of a view layer."""
    return depsgraph.view_layer_eval.material_override


def overridden(surfels: Surfels, material: bpy.types.Material, derived: Derived, notes) -> Surfels:
    """The surfels in the plain colour and opacity of the override, without the fields of their own materials. derived:
    keeps them."""
    color, is_textured = plain_color(material)
    if is_textured:
        notes.add(f"The overriding material {material.name!r} is textured; surfels have its socket's plain colour")

    def made() -> Surfels:
        colors = np.tile(np.float32(color), (len(surfels), 1))
        return replace(surfels, colors=colors, **dict.fromkeys(_OF_MATERIALS))

    return derived.get(surfels, color, made)
