# SPDX-License-Identifier: GPL-3.0-or-later
"""The colour ramp that a user draws in a texture, which Blender gives add-ons no ramp of their own for."""

from __future__ import annotations

import bpy
import numpy as np

from ...rendering import Ramp, Settings

#: Places at which it is read; more than a curve in the interface has pixels.
PLACES = 256

_kept = Settings.ramp


def ramp_of(texture: bpy.types.Texture | None) -> Ramp:
    """Three even steps without a texture, or where its ramp is switched off; the same object until it changes, with
    which a view refines.
    """
    global _kept
    if texture is None or not texture.use_color_ramp:
        return Settings.ramp
    evaluate = texture.color_ramp.evaluate
    colors = np.array([evaluate(place)[:3] for place in np.linspace(0, 1, PLACES).tolist()], np.float32).clip(0)
    if not np.array_equal(_kept.colors, colors):
        _kept = Ramp(colors)
    return _kept
