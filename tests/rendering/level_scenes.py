# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfels that many merge in each pixel, for tests of levels of detail."""

from dataclasses import replace

import numpy as np

from splat_addon.reference import scenes
from splat_addon.rendering import Light, Settings
from splat_addon.rendering.detail.hierarchies import hierarchy_of, replaced

SIZE = (32, 26)
EVERY = Settings(detail_tolerance=0.0, outputs=("color", "depth", "normal", "coverage"))
SOME = replace(EVERY, detail_tolerance=0.8)


def far_torus(count=32_000, size=SIZE):
    """Some twenty surfels per pixel, under a sun and a lamp that cast shadows."""
    scene, camera = scenes.torus(count, size)
    return replace(scene, lights=tuple(replace(light, casts_shadow=True) for light in scene.lights)), camera


def with_surfels(scene, **fields):
    """The scene with other fields for all surfels. fields: name -> function from a number of surfels to an array."""
    changed = (
        replace(i, shape=replace(i.surfels, **{n: of(len(i.surfels)) for n, of in fields.items()}))
        for i in scene.surfels
    )
    return replace(scene, surfels=tuple(changed))


LAMPS = {
    "sun": (Light("sun", direction=(-0.5, 0.6, -0.8), casts_shadow=True), 1),
    "lamp amid": (Light("point", energy=100, position=(0.9, -0.7, 0.9), casts_shadow=True), None),
}


def next_frame(scene):
    """The scene in the next frame, in which its surfels have moved by different lengths."""
    moved = []
    for instance in scene.surfels:
        x, y, z = instance.surfels.positions.T
        bent = replace(instance.surfels, positions=np.stack([x + 0.1 * z, y, z], axis=1))
        replaced(instance.surfels, bent)
        moved.append(replace(instance, shape=bent))
    return replace(scene, surfels=tuple(moved))


def built(scene):
    return [hierarchy_of(instance.surfels) for instance in scene.surfels]
