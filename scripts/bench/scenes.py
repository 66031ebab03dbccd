# SPDX-License-Identifier: GPL-3.0-or-later
"""What a small picture of a scene costs by the number of its instances, objects, samples and lights.

*ms* is the processor time of a frame; *times* is that time over the one of the same scene with one object, in the same
turn. Instances share one set of surfels or polygons, objects have one each. *Planned* is the processor time of a frame
whose draw calls are left out.
"""

from __future__ import annotations

import math
from dataclasses import replace
from functools import partial

import numpy as np

from measuring.timing import Spread, Turns, in_turn, processor
from splat_addon.rendering import Camera, Light, Renderer, Scene, Settings, look_at, make_polygons, open_device
from splat_addon.rendering.scene import Instance, PolygonInstance
from splat_addon.sampling import TriangleMesh, sample_mesh

DEVICES = ("standalone", "blender")
QUICK = {"size": 16, "instances": [20], "objects": 10, "samples": 4}
PLACED = {"surfels": Instance, "polygons": PolygonInstance}
LIGHTS = {"no shadows": 0, "a sun's shadows": 1, "two suns' shadows": 2}


def arguments(parser) -> None:
    parser.add_argument("--size", type=int, default=64, help="pixels along each side")
    parser.add_argument("--instances", type=int, nargs="+", default=[100, 1000, 4000])
    parser.add_argument("--objects", type=int, default=1000, help="different objects of 100 triangles")
    parser.add_argument("--samples", type=int, default=16)


def run(options, report) -> None:
    device = open_device(options.device)
    report.header(device, f"{options.size} x {options.size} pixels, medians of {options.turns} turns")
    report.table(["scene", "lights", "objects", "ms", "times"], list(by_number(device, options)))
    report.table(["scene, instances", "lights", "samples", "planned, ms", "times"], list(by_samples(device, options)))


def by_number(device, options):
    for kind in PLACED:
        for lights, suns in LIGHTS.items():
            numbers = [1, *options.instances] if suns < 2 else [1, options.instances[-1]]
            made = {(n, "instances"): field(kind, n, suns, is_shared=True) for n in numbers}
            made[options.objects, "different"] = field(kind, options.objects, suns, is_shared=False)
            drawn = timed(device, made, options, Settings())
            for name in made:
                times = drawn.ratio(name, (1, "instances"))
                yield f"{kind}, {name[1]}", lights, f"{name[0]:,}", *cells(drawn, name, times)


def by_samples(device, options):
    for kind in PLACED:
        for lights, suns in list(LIGHTS.items())[:2]:
            for number in (1, options.instances[0]):
                scene = field(kind, number, suns, is_shared=True)
                jobs = {
                    n: partial(Renderer(Undrawn(device)).render, scene, view(options.size), Settings(samples=n))
                    for n in (1, options.samples)
                }
                drawn = in_turn(jobs, options.turns, processor, warm=2)
                for n in jobs:
                    yield f"{kind}, {number:,}", lights, n, *cells(drawn, n, drawn.ratio(n, 1))


def timed(device, scenes: dict, options, settings: Settings) -> Turns:
    """Each scene as its own renderer draws it."""
    camera = view(options.size)
    jobs = {name: partial(Renderer(device).render, scene, camera, settings) for name, scene in scenes.items()}
    return in_turn(jobs, options.turns, processor, warm=2)


def cells(drawn: Turns, name, times: Spread) -> tuple[str, str]:
    return f"{1e3 * drawn.spread(name).median:.1f}", f"{times.median:.2f}"


class Undrawn:
    """A device whose draw calls do nothing: what is left of a frame is what it takes to plan and prepare it."""

    def __init__(self, device):
        self._device = device

    def __getattr__(self, name: str):
        return getattr(self._device, name)

    def draw_triangles(self, *call) -> None:
        pass

    def draw_fullscreen(self, *call, **options) -> None:
        pass


def view(size: int) -> Camera:
    return Camera.perspective(look_at((0, -14, 7), (0, 0, 0)), 0.7, (size, size))


def field(kind: str, count: int, suns: int, is_shared: bool) -> Scene:
    """Objects that stand on a square of 16 units, turned at random: tufts of 5 triangles, or if not shared, balls of
    100."""
    random = np.random.default_rng(0)
    shapes = [tuft(kind)] if is_shared else [ball(kind, random) for _ in range(count)]
    placed = tuple(
        PLACED[kind](shapes[number % len(shapes)], standing(random), name=f"{number}") for number in range(count)
    )
    directions = [(0.3, 0.2, -1.0), (-0.4, 0.3, -1.0)]
    lights = [Light("sun", energy=3, direction=d, casts_shadow=number < suns) for number, d in enumerate(directions)]
    return replace(Scene(lights=lights[: max(suns, 1)], world=(0.1,) * 3), **{kind: placed})


def standing(random) -> np.ndarray:
    matrix, angle = np.eye(4), random.uniform(0, 2 * math.pi)
    matrix[:2, :2] = (math.cos(angle), -math.sin(angle)), (math.sin(angle), math.cos(angle))
    matrix[:2, 3] = random.uniform(-8, 8, 2)
    return matrix


def tuft(kind: str):
    sides = (0.3, 0.3, 0.5), (-0.3, 0.3, 0.4)
    places = [(-0.2, 0, 0), (0.2, 0, 0), (0.15, 0, 0.6), (-0.15, 0, 0.6), (0, 0.1, 1), *sides]
    return made_of(kind, places, [(0, 1, 2), (0, 2, 3), (3, 2, 4), (1, 5, 2), (0, 3, 6)], 24)


def ball(kind: str, random):
    """A rough ball of 5 x 10 quads."""
    up, around = np.meshgrid(np.linspace(0, math.pi, 6), np.arange(10) * math.pi / 5, indexing="ij")
    radius = random.uniform(0.3, 0.5, up.shape)
    places = np.stack([np.sin(up) * np.cos(around), np.sin(up) * np.sin(around), 1 + np.cos(up)], axis=-1)
    corner = np.arange(50).reshape(5, 10)
    beside = np.roll(corner, -1, axis=1)
    faces = np.stack([corner, corner + 10, beside + 10, corner, beside + 10, beside], axis=-1).reshape(-1, 3)
    return made_of(kind, (radius[..., None] * places).reshape(-1, 3), faces, 10)


def made_of(kind: str, places, faces, resolution: int):
    if kind == "polygons":
        return make_polygons(places, faces)
    return sample_mesh(TriangleMesh(np.asarray(places, float), np.asarray(faces)), resolution=resolution)
