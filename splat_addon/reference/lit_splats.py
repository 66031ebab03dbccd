# SPDX-License-Identifier: GPL-3.0-or-later
"""Splats that are lit individually at their own position (Botsch and Kobbelt 2003, section 4)."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ..rendering.scene import Scene
from ..rendering.scene.camera import Camera
from ..rendering.settings import Settings
from .rays import Surface
from .shading_models import SHADERS
from .splats import Splats


@dataclass(frozen=True, eq=False)
class _RaysThroughCentres:
    """Stands in for a `RayGrid` in shading: the rays from the eye through the splats' centres."""

    splats: Splats
    camera: Camera

    def rays(self, rays: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        center = self.splats.center[rays]
        if self.camera.is_orthographic:
            return center * (1, 1, 0), np.broadcast_to((0.0, 0.0, -1.0), center.shape)
        return np.zeros_like(center), -center / center[:, 2:]


def lit_splats(splats: Splats, scene: Scene, camera: Camera, settings: Settings) -> Splats:
    """The splats with the colours that `settings.shading` gives each one at its centre.

    Splats beside the eye's plane have no such ray and keep their colours.
    """
    before = np.flatnonzero(-splats.center[:, 2] > 0)
    roughness, metallic, f0, emission, light_set, finish = np.split(splats.surface[before], (1, 2, 3, 6, 10), axis=1)
    surface = Surface(
        rays=before,
        color=splats.color[before],
        normal=splats.normal[before],
        depth=-splats.center[before, 2],
        roughness=roughness[:, 0],
        metallic=metallic[:, 0],
        f0=f0[:, 0],
        emission=emission,
        light_set=light_set,
        finish=finish,
        weight=np.ones(len(before)),
        count=np.ones(len(before)),
        opacity=np.ones(len(before)),
    )
    colors = splats.color.copy()
    grid = _RaysThroughCentres(splats, camera)
    colors[before] = SHADERS[settings.shading](surface, grid, scene, camera, settings)
    return replace(splats, color=colors)
