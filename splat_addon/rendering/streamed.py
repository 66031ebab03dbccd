# SPDX-License-Identifier: GPL-3.0-or-later
"""Replaces the instances whose surfels are streamed from a file by what a view draws of them, before it is planned.

One set of surfels serves the camera and the shadow maps, at the camera's tolerance: blocks outside the picture are
taken too, coarser, if they may cast shadows into it. Nothing after this knows of files.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from time import perf_counter

import numpy as np

from ..hierarchy import Sight
from ..surfels import Surfels, portions
from .levels import sight
from .panorama_faces import DENSITY
from .scene import Instance, Scene
from .scene.camera import Camera
from .scene.panorama import Panorama
from .settings import Settings
from .upload.packing import LARGEST_SET

#: How many times the tolerance blocks outside the picture may be off, which are seen by their shadows alone.
BESIDE = 4.0


class Streamed:
    """The streamed instances of the scenes that one renderer draws.

    is_waiting: whether blocks of the last view are still to be read. short: names of instances that the memory sufficed
    to draw coarser only.
    """

    def __init__(self):
        self.is_waiting = False
        self.short: tuple[str, ...] = ()
        self._from: Scene | None = None
        self._scene: Scene | None = None
        self._made: dict[Instance, tuple[Surfels, tuple[Instance, ...]]] = {}

    def resolved(
        self,
        scene: Scene,
        camera: Camera | Panorama,
        settings: Settings,
        seconds: float | None = None,
        told: Callable[[], None] | None = None,
    ) -> Scene:
        """The scene as this view draws it; the same object as long as nothing changes.

        seconds: time for reading, as in `Stream.seen`. told: called between reads; it may raise.
        Raises OSError if a file cannot be read.
        """
        self.is_waiting, self.short = False, ()
        streams = {instance.stream for instance in scene.surfels} - {None}
        if not streams:
            return scene
        for stream in streams:
            stream.begin_frame()
        until, made, short = None if seconds is None else perf_counter() + seconds, {}, {}
        shadows = settings.shadow_resolution > 0 and any(light.casts_shadow for light in scene.lights)
        for instance in scene.surfels:
            if instance.stream is None or instance.is_flattened:
                continue
            view, beside = _view(instance, camera, shadows, settings.detail_tolerance)
            left = None if until is None else max(until - perf_counter(), 0.0)
            seen = instance.stream.seen(view, beside, left, told)
            self.is_waiting |= not seen.is_whole
            short |= {instance.name: None} if seen.is_short else {}
            known = self._made.get(instance)
            is_known = known is not None and known[0] is seen.surfels
            made[instance] = known if is_known else (seen.surfels, _instances(instance, seen.surfels))
        is_same = scene is self._from and all(made[i] is self._made.get(i) for i in made)
        self._made, self.short = made, tuple(short)
        if not is_same:
            parts = ((instance,) if instance not in made else made[instance][1] for instance in scene.surfels)
            self._from, self._scene = scene, replace(scene, surfels=tuple(part for some in parts for part in some))
        return self._scene


def _instances(instance: Instance, surfels: Surfels) -> tuple[Instance, ...]:
    """Ordinary instances of surfels that are a cut already, as many as the device needs to hold them."""
    return tuple(replace(instance, shape=part, stream=None, is_cut=True) for part in portions(surfels, LARGEST_SET))


def _view(instance: Instance, camera: Camera | Panorama, shadows: bool, tolerance: float) -> tuple[Sight, float | None]:
    """The arguments of `Stream.seen`. With shadows, backs are drawn, which a light may see."""
    if isinstance(camera, Panorama):
        return _all_round(instance, camera, tolerance), 1.0
    if shadows and instance.casts_shadow:
        return sight(instance, camera, False, tolerance), BESIDE
    return sight(instance, camera, instance.hides_backs(camera), tolerance), None


def _all_round(instance: Instance, panorama: Panorama, tolerance: float) -> Sight:
    """A view in which nothing is inside the picture, so that only the distance from the eye counts."""
    linear = instance.matrix_world[:3, :3]
    eye = np.linalg.solve(linear, panorama.matrix_world[:3, 3] - instance.matrix_world[:3, 3]) - instance.shape.origin
    pixels = DENSITY / panorama.pixel_angle() * float(instance.stretches[0])
    nowhere, depth = np.array([[0, 0, 0, -1.0]]), np.array([float(instance.stretches[2]), 0, 0, 0])
    return Sight(nowhere, depth, pixels, panorama.near, np.append(eye, 1.0), False, tolerance)
