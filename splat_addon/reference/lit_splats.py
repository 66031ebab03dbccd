# SPDX-License-Identifier: GPL-3.0-or-later
"""Splats that are lit individually at their own position (Botsch and Kobbelt 2003, section 4), and polygons that are
lit before they are blended with them (Guennebaud et al. 2006, section 5.1).
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ..rendering.scene import Scene
from ..rendering.scene.camera import Camera
from ..rendering.settings import Settings
from .polygons import Hits
from .rays import RayGrid, Surface
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
    surface = _surface(before, splats, -splats.center[:, 2])
    colors = splats.color.copy()
    grid = _RaysThroughCentres(splats, camera)
    colors[before] = SHADERS[settings.shading](surface, grid, scene, camera, settings)
    return replace(splats, color=colors)


def lit_polygons(hits: Hits, grid: RayGrid, scene: Scene, camera: Camera, settings: Settings) -> Hits:
    """What rays see of polygons, in the colours that `settings.shading` gives it there."""
    met = np.flatnonzero(np.isfinite(hits.depth))
    colors = hits.color.copy()
    colors[met] = SHADERS[settings.shading](_surface(met, hits, hits.depth), grid, scene, camera, settings)
    return replace(hits, color=colors)


def _surface(rows: np.ndarray, seen: Splats | Hits, depth: np.ndarray) -> Surface:
    """Rows of splats, or of what rays hit, as the surfaces that are shaded."""
    roughness, metallic, f0, emission, light_set, finish = np.split(seen.surface[rows], (1, 2, 3, 6, 10), axis=1)
    return Surface(
        rays=rows,
        color=seen.color[rows],
        normal=seen.normal[rows],
        depth=depth[rows],
        roughness=roughness[:, 0],
        metallic=metallic[:, 0],
        f0=f0[:, 0],
        emission=emission,
        light_set=light_set,
        finish=finish,
        weight=np.ones(len(rows)),
        count=np.ones(len(rows)),
        opacity=np.ones(len(rows)),
    )
