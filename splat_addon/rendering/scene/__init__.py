# SPDX-License-Identifier: GPL-3.0-or-later
"""The scene and the camera as plain values, independent of passes and devices."""

from .finish import Finish
from .material import Material, SurfaceTexture
from .scene import Instance, Placed, PolygonInstance, Scene

__all__ = ("Finish", "Instance", "Material", "Placed", "PolygonInstance", "Scene", "SurfaceTexture")
