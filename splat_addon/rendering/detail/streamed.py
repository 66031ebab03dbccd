# SPDX-License-Identifier: GPL-3.0-or-later
"""Replaces the instances whose surfels are streamed from a file by what a view draws of them, before it is planned.

One set of surfels serves the camera and the shadow maps, at the camera's tolerance: blocks outside the picture are
taken too, coarser, if they may cast shadows into it. Nothing after this knows of files.
"""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import Future, wait
from dataclasses import replace
from functools import partial
from time import perf_counter

import numpy as np

from ...hierarchy import Sight
from ...streaming import Stream, Unreadable
from ...streaming.stream import Gathered, Seen
from ...surfels import Surfels
from ..assembly.panorama_faces import DENSITY
from ..scene import Instance, Paint, Scene
from ..scene.camera import Camera
from ..scene.panorama import Panorama
from ..settings import Settings
from .levels import sight

#: Seconds of reading for the first set of a view.
_READING = 0.03

#: How many times the tolerance blocks outside the picture may be off: only their shadows, or a view that moves on, show
#: them.
BESIDE = 4.0


class Streamed:
    """The streamed instances of the scenes that one renderer draws.

    is_waiting: whether a finer set than the last view drew is on its way. short: names of instances that the memory
    sufficed to draw coarser only. unread: sentences on instances that are coarser because files cannot be read.
    """

    def __init__(self):
        self.is_waiting = False
        self.short: tuple[str, ...] = ()
        self.unread: tuple[str, ...] = ()
        self._from: Scene | None = None
        self._scene: Scene | None = None
        self._made: dict[Instance, tuple[Gathered, tuple[Instance, ...]]] = {}
        self._painted: dict[tuple, tuple[Surfels, ...]] = {}
        self._coming: dict[tuple, _Coming] = {}

    def resolved(
        self,
        scene: Scene,
        camera: Camera | Panorama,
        settings: Settings,
        seconds: float | None = None,
        told: Callable[[], None] | None = None,
        most: int | None = None,
        needs_whole: bool = False,
    ) -> Scene:
        """The scene as this view draws it; the same object as long as nothing changes.

        seconds: time to wait. Reading and choosing go on in other threads then, and until they are done the sets of
        earlier views are drawn, which cover everything too, or the coarsest ones. None: wait for everything. told:
        called between reads; it may raise. most: surfels that all sets together may have when there is no time to wait
        for everything. needs_whole: the sets of earlier views stay until all that this one needs is read.
        """
        self.is_waiting, self.short, self.unread = False, (), ()
        streams = {one.stream: 0 for one in scene.surfels.different if one.stream is not None}
        if not streams:
            self._coming.clear()
            return scene
        if seconds is None:
            for stream in streams:
                stream.begin_frame()
        share = most and most // sum(instance.stream is not None for instance in scene.surfels)
        until, made, painted, short, unread = perf_counter() + (seconds or 0.0), {}, {}, {}, {}
        shadows = settings.shadow_resolution > 0 and any(light.casts_shadow for light in scene.lights)
        for instance in scene.surfels:
            if (stream := instance.stream) is None or instance.is_flattened:
                continue
            view, beside = _view(instance, camera, shadows, seconds is not None, settings.detail_tolerance)
            if seconds is None:
                seen, why = _seen(partial(stream.seen, view, beside, told))
            else:
                # instances are made again with every change of the scene, but their order stays
                streams[stream] += 1
                coming = self._coming.setdefault((stream, streams[stream]), _Coming(stream))
                seen = coming.latest(view, beside, max(until - perf_counter(), 0.0), share, needs_whole)
                self.is_waiting, why = self.is_waiting | coming.is_waiting, coming.why
            if why:
                unread[f"{instance.name} is coarser than it should be. {why}"] = None
            short |= {instance.name: None} if seen.is_short else {}
            known = self._made.get(instance)
            is_known = known is not None and known[0] is seen.gathered
            parts = self._parts(instance, seen.gathered, painted)
            made[instance] = known if is_known else (seen.gathered, _instances(instance, seen.gathered, parts))
        self._coming = {key: own for key, own in self._coming.items() if key[1] <= streams.get(key[0], 0)}
        is_same = scene is self._from and all(made[i] is self._made.get(i) for i in made)
        self._made, self._painted, self.short, self.unread = made, painted, tuple(short), tuple(unread)
        if not is_same:
            parts = ((instance,) if instance not in made else made[instance][1] for instance in scene.surfels)
            self._from, self._scene = scene, replace(scene, surfels=tuple(part for some in parts for part in some))
        return self._scene

    def _parts(self, instance: Instance, gathered: Gathered, painted: dict) -> tuple[Surfels, ...]:
        """What was gathered, in the instance's colours; the same objects as in the last view. painted: of this view."""
        if instance.paint is None:
            return gathered.parts
        key = gathered, instance.paint.key
        if key not in painted:
            parts = zip(gathered.parts, gathered.scan_of_parts(), strict=True)
            painted[key] = self._painted.get(key) or tuple(_painted(instance.paint, *part) for part in parts)
        return painted[key]


def _painted(paint: Paint, part: Surfels, scan: dict[str, np.ndarray]) -> Surfels:
    made = paint.of(part, scan)
    return made.as_transparent() if part.is_transparent else made


def _seen(asked: Callable[[], Seen]) -> tuple[Seen, str]:
    """What a view draws, and why it is coarser than it asked for, if its file cannot be read."""
    try:
        return asked(), ""
    except Unreadable as error:
        return error.seen, str(error)


class _Coming:
    """The set of one instance in a view that does not wait: the last that was finished, while another thread prepares
    the next. Time to read doubles with each, so that sets that are soon replaced cost little.

    is_waiting: whether a better set for the view is on its way. why: why the last set is coarser than it should be.
    """

    def __init__(self, stream: Stream):
        self._stream, self.why = stream, ""
        self._key, self._seen = None, Seen(stream.roots, False, False)
        self._next: tuple[tuple, Future[Seen]] | None = None
        self._seconds = _READING
        self.is_waiting = True

    def latest(self, view: Sight, beside: float | None, seconds: float, most: int | None, needs_whole: bool) -> Seen:
        """What is there after waiting at most `seconds`. most, needs_whole: as in `Stream.ahead`."""
        key, until = (view.key, beside, most is None), perf_counter() + seconds
        while True:
            self._take(max(until - perf_counter(), 0.0))
            self.is_waiting = self._key != key or not self._seen.is_whole
            if self.is_waiting and self._next is None:
                self._seconds = 2 * self._seconds if self._key == key else _READING
                self._next = key, self._stream.ahead(view, beside, self._seconds, most, needs_whole)
            if not self.is_waiting or perf_counter() >= until:
                return self._seen

    def _take(self, seconds: float) -> None:
        if self._next is not None:
            key, future = self._next
            if wait([future], seconds).done:
                (seen, self.why), self._key, self._next = _seen(future.result), key, None
                self._seen = self._seen._replace(is_whole=False) if seen.gathered is None else seen


def _instances(instance: Instance, gathered: Gathered, parts: tuple[Surfels, ...]) -> tuple[Instance, ...]:
    """Ordinary instances of surfels that are a cut already. parts: the gathered ones in the instance's colours."""
    given = replace(instance, stream=None, paint=None, is_cut=True)
    return tuple(replace(given, shape=p, is_merged=k >= gathered.unmerged) for k, p in enumerate(parts))


def _view(
    instance: Instance, camera: Camera | Panorama, shadows: bool, is_early: bool, tolerance: float
) -> tuple[Sight, float | None]:
    """The arguments of `Stream.seen`. is_early: whether later views may draw the set as well, so that it must cover
    everything; it must also for lights that cast shadows."""
    if isinstance(camera, Panorama):
        return _all_round(instance, camera, tolerance), 1.0
    if is_early or (shadows and instance.casts_shadow):
        return sight(instance, camera, False, tolerance), BESIDE
    return sight(instance, camera, instance.hides_backs(camera), tolerance), None


def _all_round(instance: Instance, panorama: Panorama, tolerance: float) -> Sight:
    """A view in which nothing is inside the picture, so that only the distance from the eye counts."""
    linear = instance.matrix_world[:3, :3]
    eye = np.linalg.solve(linear, panorama.matrix_world[:3, 3] - instance.matrix_world[:3, 3]) - instance.shape.origin
    pixels = DENSITY / panorama.pixel_angle() * float(instance.stretches[0])
    nowhere, depth = np.array([[0, 0, 0, -1.0]]), np.array([float(instance.stretches[2]), 0, 0, 0])
    return Sight(nowhere, depth, pixels, panorama.near, np.append(eye, 1.0), False, tolerance)
