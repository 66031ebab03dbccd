# SPDX-License-Identifier: GPL-3.0-or-later
"""A scene in which every pass of a picture has something to show."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from ..rendering.scene import Instance, Material, Scene
from ..rendering.scene.camera import Camera, look_at
from ..rendering.scene.light import Light
from .extremes import sheet
from .scenes import sphere, torus


def still_life(size: tuple[int, int]) -> tuple[Scene, Camera]:
    """Two tori, a glowing ball and a floor under a sun that casts shadows, each thing with its name and numbers."""
    outer, inner = torus(60_000)[0].surfels
    (ball,) = sphere(8_000)[0].surfels
    floor = sheet(160, 2.6, 0.0, 0.0)
    checks = (np.floor(floor.positions[:, 0] * 2) + np.floor(floor.positions[:, 1] * 2)) % 2
    shades = np.where(checks[:, None] > 0, (0.55, 0.55, 0.6), (0.3, 0.32, 0.36))
    floor = replace(floor, colors=np.column_stack([shades, np.ones(len(shades))]), materials=checks.astype(np.int32))
    glowing = Material(roughness=0.6, emission=(0.5, 0.15, 0.02), index=3)
    instances = (
        replace(outer, materials=(Material(roughness=0.5, index=1),), name="outer", index=1),
        replace(inner, materials=(Material(roughness=0.35, metallic=1.0, index=2),), name="inner", index=2),
        Instance(ball.surfels, _placed(0.45, (1.15, -1.25, -0.05)), (glowing,), name="ball", index=3),
        Instance(floor, _placed(1.0, (0, 0, -0.5)), (Material(index=4), Material(index=5)), name="floor", index=4),
    )
    sun = Light("sun", (1, 0.95, 0.85), 2.6, direction=(0.7, 0.5, -1), size=0.05, casts_shadow=True)
    camera = Camera.perspective(look_at((0.6, -4.6, 2.7), (0.05, -0.1, -0.2)), math.radians(38), size, 0.1, 100)
    return Scene(instances, (sun,), (0.12, 0.15, 0.2)), camera


def _placed(scale: float, place) -> np.ndarray:
    matrix = np.diag((scale, scale, scale, 1.0))
    matrix[:3, 3] = place
    return matrix
