# SPDX-License-Identifier: GPL-3.0-or-later
"""Renders surfels with a camera and lights to a frame: `plan` decides the passes, `Renderer` runs them on a device.

scene, camera, settings -> plan -> view -> passes on a device -> Frame
"""

from .cryptomatte import Cryptomatte
from .device import open_device
from .frame import EMPTY_DEPTH, Frame
from .plan.build import plan
from .plan.frame_plan import FramePlan
from .presets import PRESETS, SCAN_LOOK, Preset
from .renderer import Renderer, Shown
from .scene import (
    Finish,
    GlossTexture,
    Instance,
    LineStyle,
    Material,
    NormalTexture,
    PolygonInstance,
    Scene,
    Style,
    SurfaceTexture,
)
from .scene.camera import Camera, look_at
from .scene.environment import Environment
from .scene.eye_dome import EyeDome
from .scene.lens import Lens
from .scene.light import Light
from .scene.lines import Lines
from .scene.matcap import Matcap
from .scene.panorama import EquidistantFisheye, Equirectangular, EquisolidFisheye, Panorama
from .scene.polygons import Polygons, make_polygons
from .scene.ramp import Ramp
from .settings import Settings
from .tile_drawing import RenderCancelled
from .viewport.arrival import Arrival
from .viewport.pace import Pace
from .viewport.refinement import Refinement

__all__ = (
    "EMPTY_DEPTH",
    "PRESETS",
    "SCAN_LOOK",
    "Arrival",
    "Camera",
    "Cryptomatte",
    "Environment",
    "EquidistantFisheye",
    "Equirectangular",
    "EquisolidFisheye",
    "EyeDome",
    "Finish",
    "Frame",
    "FramePlan",
    "GlossTexture",
    "Instance",
    "Lens",
    "Light",
    "LineStyle",
    "Lines",
    "Matcap",
    "Material",
    "NormalTexture",
    "Pace",
    "Panorama",
    "PolygonInstance",
    "Polygons",
    "Preset",
    "Ramp",
    "Refinement",
    "RenderCancelled",
    "Renderer",
    "Scene",
    "Settings",
    "Shown",
    "Style",
    "SurfaceTexture",
    "look_at",
    "make_polygons",
    "open_device",
    "plan",
)
