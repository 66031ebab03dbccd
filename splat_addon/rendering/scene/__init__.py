# SPDX-License-Identifier: GPL-3.0-or-later
"""What is to be seen, and from where: plain values that neither passes nor devices know of."""

from .scene import Instance, Material, Placed, PolygonInstance, Scene, SurfaceTexture

__all__ = ("Instance", "Material", "Placed", "PolygonInstance", "Scene", "SurfaceTexture")
