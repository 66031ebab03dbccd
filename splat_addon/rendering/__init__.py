# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfels, camera and lights become a frame: `plan` decides the passes, `Renderer` runs them on a device.

scene, camera, settings -> plan -> view -> passes on a device -> Frame
"""

from .camera import Camera, look_at
from .cryptomatte import Cryptomatte
from .device import open_device
from .environment import Environment
from .frame import EMPTY_DEPTH, Frame
from .lens import Lens
from .light import Light
from .lines import Lines
from .matcap import Matcap
from .panorama import EquidistantFisheye, Equirectangular, EquisolidFisheye, Panorama
from .plan import plan
from .plan.frame_plan import FramePlan
from .polygons import Polygons, make_polygons
from .presets import PRESETS, Preset
from .refinement import Refinement
from .renderer import RenderCancelled, Renderer, Shown
from .scene import Instance, Material, PolygonInstance, Scene, SurfaceTexture
from .settings import Settings

__all__ = (
    "EMPTY_DEPTH",
    "PRESETS",
    "Camera",
    "Cryptomatte",
    "Environment",
    "EquidistantFisheye",
    "Equirectangular",
    "EquisolidFisheye",
    "Frame",
    "FramePlan",
    "Instance",
    "Lens",
    "Light",
    "Lines",
    "Matcap",
    "Material",
    "Panorama",
    "PolygonInstance",
    "Polygons",
    "Preset",
    "Refinement",
    "RenderCancelled",
    "Renderer",
    "Scene",
    "Settings",
    "Shown",
    "SurfaceTexture",
    "look_at",
    "make_polygons",
    "open_device",
    "plan",
)
