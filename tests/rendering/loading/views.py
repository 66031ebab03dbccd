# SPDX-License-Identifier: GPL-3.0-or-later
"""Views of tori whose surfels are late, with threads and clocks that a test drives."""

from concurrent.futures import Future
from dataclasses import replace

import numpy as np

from splat_addon.reference import scenes
from splat_addon.rendering import Arrival, Refinement, Renderer, Settings
from splat_addon.rendering.upload.loading import Loading

SIZE = (64, 48)
SETTINGS = Settings(outputs=("color",), detail_tolerance=1.5, shadow_resolution=256)


class Thread:
    """Jobs that run when a test says so."""

    def __init__(self):
        self.jobs = []

    def __call__(self, job):
        self.jobs.append((Future(), job))
        return self.jobs[-1][0]

    def work(self, count=None):
        """Run the next jobs, or all of them."""
        for future, job in self.jobs[:count]:
            if future.set_running_or_notify_cancel():
                try:
                    future.set_result(job())
                except Exception as error:
                    future.set_exception(error)
        del self.jobs[:count]


class Clock:
    """A clock that each look moves on."""

    def __init__(self, step=0.0):
        self.now, self.step = 0.0, step

    def __call__(self):
        self.now += self.step
        return self.now


def shown(device, view, scene, camera, settings):
    """(h, w, 4) of what a view shows at its next redraw."""
    (part,) = view.draw(scene, camera, settings)
    return shown_texels(device, part)


def shown_texels(device, part):
    texels, (left, bottom, width, height) = device.target([part.texture]).read(0), part.part
    return texels[bottom : bottom + height, left : left + width] * part.scale


def begun(device, clock=None):
    thread = Thread()
    view = Arrival(Refinement(Renderer(device)), Loading(device, thread, clock or Clock()))
    return view, thread


#: The surfels of a torus's larger set, and of that of a smaller torus.
COUNT, FEWER = 35_101, 23_401


def torus(count=60_000, **fields):
    scene, camera = scenes.torus(count, SIZE)
    lights = tuple(replace(light, casts_shadow=True) for light in scene.lights)
    surfels = tuple(
        replace(i, shape=replace(i.surfels, **{n: of(len(i.surfels)) for n, of in fields.items()}))
        for i in scene.surfels[:1]
    )
    return replace(scene, lights=lights, surfels=surfels), camera


def rough():
    return torus(roughness=lambda n: np.linspace(0.2, 0.8, n), metallic=lambda n: np.zeros(n))


def clipped():
    def lines(n):
        return np.stack([np.arange(n) * 7 % 65536 - 32768, np.arange(n) % 2 * 9000], axis=1).astype(np.int16)

    return torus(clip_line=lines)


def two():
    """Two sets, the second of which lies behind the first."""
    (first, camera), (second, _) = torus(), torus(40_000)
    moved = np.array(second.surfels[0].matrix_world)
    moved[:3, 3] += 0.5
    return replace(first, surfels=(first.surfels[0], replace(second.surfels[0], matrix_world=moved))), camera
