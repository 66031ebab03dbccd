# SPDX-License-Identifier: GPL-3.0-or-later
"""Colour ramps as tables, and the one for the ramp shading.

That is the ramp of a texture, because Blender offers add-ons no ramp of their own.
"""

from __future__ import annotations

import bpy
import numpy as np

from ...rendering import Ramp, Settings
from ..working_space import luminance

#: Places at which it is read; more than a curve in the interface has pixels.
PLACES = 256

_kept = Settings.ramp


def table(ramp: bpy.types.ColorRamp) -> np.ndarray:
    """(PLACES, 4) float32 colours and alphas of a ramp, from 0 to 1."""
    return np.array([ramp.evaluate(place) for place in np.linspace(0, 1, PLACES).tolist()], np.float32)


def ramp_of(texture: bpy.types.Texture | None) -> Ramp:
    """The ramp of a texture; three even steps without a texture or if its ramp is switched off.

    Until the colours change it is the same object, so that a view can refine.
    """
    global _kept
    has_ramp = texture is not None and texture.use_color_ramp
    colors = table(texture.color_ramp)[:, :3].clip(0) if has_ramp else Settings.ramp.colors
    weights = luminance()[:3]
    if weights != _kept.luminance or not np.array_equal(_kept.colors, colors):
        _kept = Ramp(colors, weights)
    return _kept
