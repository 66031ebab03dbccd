# SPDX-License-Identifier: GPL-3.0-or-later
"""Colour ramps as tables, and the one for the ramp shading.

That is the ramp of a texture, because Blender offers add-ons no ramp of their own.
"""

from __future__ import annotations

from weakref import WeakValueDictionary

import bpy
import numpy as np

from ...rendering import Ramp, Settings
from ..working_space import luminance

#: Places at which it is read; more than a curve in the interface has pixels.
PLACES = 256

#: Contents -> the ramp that has them: the same object for the same colours, so that a view can refine.
_known: WeakValueDictionary[tuple, Ramp] = WeakValueDictionary()


def kept_ramp(colors: np.ndarray, weights: tuple[float, float, float] | None = None) -> Ramp:
    """The ramp of (n, 3) colours. weights: of the luminance that it is looked up by; None: of the working space."""
    weights = tuple(luminance()[:3] if weights is None else weights)
    colors = np.ascontiguousarray(colors, np.float32)
    made = Ramp(colors, weights)
    return _known.setdefault((colors.tobytes(), weights), made)


def table(ramp: bpy.types.ColorRamp) -> np.ndarray:
    """(PLACES, 4) float32 colours and alphas of a ramp, from 0 to 1."""
    return np.array([ramp.evaluate(place) for place in np.linspace(0, 1, PLACES).tolist()], np.float32)


def ramp_of(texture: bpy.types.Texture | None) -> Ramp:
    """The ramp of a texture; three even steps without a texture or if its ramp is switched off."""
    has_ramp = texture is not None and texture.use_color_ramp
    colors = table(texture.color_ramp)[:, :3].clip(0) if has_ramp else Settings.ramp.colors
    return kept_ramp(colors)
