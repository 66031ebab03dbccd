# SPDX-License-Identifier: GPL-3.0-or-later
"""Takes the sun out of a scene's environment and makes it a light, so that it casts shadows."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from .light import MAX_IRRADIANCE, Light
from .scene import Scene


def sun_apart(scene: Scene, threshold: float) -> Scene:
    """The scene with the sun of its environment as a last light, or the same scene if the environment has none.

    threshold: radiance, with that of `Scene.world`, above which the environment is a sun; 0 for no sun.
    """
    tint = np.array(scene.world)
    if scene.environment is None or not threshold > 0 or not tint.max() > 0:
        return scene
    sun = scene.environment.sun_above(threshold / float(tint.max()))
    irradiance = np.zeros(3) if sun is None else np.clip(sun.irradiance * tint, -MAX_IRRADIANCE, MAX_IRRADIANCE)
    if not irradiance.max() > 0:
        return scene
    light = Light(
        "sun",
        color=tuple((irradiance / irradiance.max()).tolist()),
        energy=float(irradiance.max()),
        direction=tuple((-scene.environment.rotation.T @ sun.toward).tolist()),
        size=sun.angle,
        casts_shadow=True,
    )
    return replace(scene, lights=(*scene.lights, light), picture_sun=sun)
