# SPDX-License-Identifier: GPL-3.0-or-later
"""Scenes for methods whose printed splats are smaller than their surfels, so that they have no gaps as other methods
have none."""

from dataclasses import replace

import numpy as np

from splat_addon.rendering.scene import Instance, Scene

#: Botsch and Kobbelt 2003, equation 1: a sprite's side, and not half of it, is the projected radius.
HALVED = {"sprites_printed"}


def for_method(scene: Scene, method: str) -> Scene:
    """The scene; for methods that halve splats, with surfels of twice the size."""
    if method not in HALVED:
        return scene
    return replace(scene, surfels=[_doubled(instance) for instance in scene.surfels])


def _doubled(instance: Instance) -> Instance:
    surfels = instance.surfels
    along = {
        name: 2 * values for name in ("uv_along_x", "uv_along_y") if (values := getattr(surfels, name)) is not None
    }
    return replace(instance, shape=replace(surfels, scales=np.float32(2) * surfels.scales, **along))
