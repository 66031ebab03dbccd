# SPDX-License-Identifier: GPL-3.0-or-later
"""The scene and the camera as plain values, independent of passes and devices."""

from .scene import Instance, Material, Placed, PolygonInstance, Scene, SurfaceTexture

__all__ = ("Instance", "Material", "Placed", "PolygonInstance", "Scene", "SurfaceTexture")
