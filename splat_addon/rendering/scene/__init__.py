# SPDX-License-Identifier: GPL-3.0-or-later
"""The scene and the camera as plain values, independent of passes and devices."""

from .finish import Finish
from .material import GlossTexture, Material, NormalTexture, SurfaceTexture
from .placed import Instance, Paint, Placed, PolygonInstance
from .placements import placed_at
from .scene import Scene
from .style import LineStyle, Style

__all__ = (
    "Finish",
    "GlossTexture",
    "Instance",
    "LineStyle",
    "Material",
    "NormalTexture",
    "Paint",
    "Placed",
    "PolygonInstance",
    "Scene",
    "Style",
    "SurfaceTexture",
    "placed_at",
)
