# SPDX-License-Identifier: GPL-3.0-or-later
"""Scenes for cases that the random ones never show, for `equal_pictures.py`."""

from dataclasses import replace

import numpy as np
from random_pictures import SIZE


def rare_cases() -> dict:
    """Name -> scene, camera, settings. The camera is at the origin and looks along -Z."""
    from splat_addon.reference import extremes, scenes
    from splat_addon.rendering import Camera, Instance, Light, Scene, Settings

    camera = Camera.perspective(np.eye(4), 0.8, SIZE, 0.5, 30.0)
    settings = Settings(method="ewa", supersampling=1, layers=2, outputs=("color", "object_index"))
    lights = [Light("sun", energy=2.0, direction=(1, 0.6, -1))]

    line = np.array([[1000, 9000]], np.int16)
    lone = replace(extremes.discs((0, 0, -3), (0.5, 0, 0), (0, 0.8, 0)), clip_line=line)

    places = [(0.05 * k - 0.1, 0.02 * k, -0.55 - 0.05 * k) for k in range(6)]
    through = np.array([(0.2, 0.1 * k - 0.2, 0.4 - 0.15 * k) for k in range(6)])
    glass = extremes.discs(places, through, np.cross(through, (0.3, -0.8, 0.1)))
    glass = replace(glass, colors=glass.colors * (1, 1, 1, 0.5))

    before = Instance(extremes.sheet(8, 0.5, 0.0, 2.2), index=4)
    grazing = Instance(extremes.sheet(30, 2.0, 80.0, 3.0), index=5)
    curtain = Instance(extremes.sheet(4, 2.0, 0.0, 1.5), is_holdout=True, split_distance=9.0)
    place = np.diag((0.6, 0.6, 0.6, 1.0))
    place[2, 3] = -2.5
    torus = Instance(scenes.torus(8000)[0].surfels[0].surfels, place, index=6)
    hidden = Instance(extremes.sheet(4, 0.6, 0.0, 1.5), split_distance=9.0, index=7)

    def shown(*instances, **changed):
        return Scene(instances, lights), camera, replace(settings, **changed)

    return {
        "a lone disc that ends at a line": shown(Instance(lone, index=2)),
        "glass across the near plane": shown(Instance(glass), method="homogeneous", blends_rest=True, epsilon=0.01),
        "a hole that its distance leaves out": shown(curtain, before, grazing),
        "a hole at coarser levels": shown(replace(torus, is_holdout=True), before, grazing, detail_tolerance=8.0),
        "rims that distance leaves out": shown(hidden, Instance(lone, index=2), method="ewa_object"),
        "rims at coarser levels": shown(torus, method="ewa_object", detail_tolerance=8.0),
    }
