# SPDX-License-Identifier: GPL-3.0-or-later
"""The Material Override of a view layer: everything is drawn with that one material."""

from __future__ import annotations

from dataclasses import replace

import bpy
import numpy as np

from ...surfels import Surfels
from .material_surfaces import plain_color

#: The fields of surfels that come from their own materials; the others belong to their form.
_OF_MATERIALS = ("roughness", "metallic", "emission", "uvs", "uv_along_x", "uv_along_y", "uv_border")


def override_of(depsgraph: bpy.types.Depsgraph) -> bpy.types.Material | None:
    """The override material of a view layer."""
    return depsgraph.view_layer_eval.material_override


class Overridden:
    """Surfels painted by the override: the same object for the same surfels and colour, so that they stay on the
    device."""

    def __init__(self):
        self._made: dict[int, tuple[Surfels, tuple[float, ...], Surfels]] = {}
        self._used: set[int] = set()

    def get(self, surfels: Surfels, material: bpy.types.Material, notes) -> Surfels:
        """The surfels in the plain colour and opacity of the material, without the fields of their own materials."""
        color, is_textured = plain_color(material)
        if is_textured:
            notes.add(f"The overriding material {material.name!r} is textured; surfels have its socket's plain colour")
        key = id(surfels)
        self._used.add(key)
        if key not in self._made or self._made[key][:2] != (surfels, color):
            bare = dict.fromkeys(_OF_MATERIALS)
            colors = np.tile(np.float32(color), (len(surfels), 1))
            self._made[key] = surfels, color, replace(surfels, colors=colors, **bare)
        return self._made[key][2]

    def begin_frame(self) -> None:
        """Drop what the last frame did not use."""
        self._made = {key: made for key, made in self._made.items() if key in self._used}
        self._used.clear()
