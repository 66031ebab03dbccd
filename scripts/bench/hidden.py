# SPDX-License-Identifier: GPL-3.0-or-later
"""What leaving out hidden parts of one large object saves: a street among 576 buildings, all one set of surfels.

*drawn* counts splats, with and without looking for hidden ones; *time* is a frame's with looking, divided by one
without; both draw their shadow maps. The pictures must be the same to the bit.
"""

from __future__ import annotations

import math
from functools import partial
from unittest import mock

import numpy as np
import trimesh

from environment import Problem
from measuring.timing import Spread, in_turn, wall
from splat_addon.rendering import Camera, Instance, Light, Renderer, Scene, Settings, look_at, open_device
from splat_addon.rendering.features import hidden_objects
from splat_addon.sampling import PLAIN, TriangleMesh, sample_mesh

DEVICES = ("standalone",)
QUICK = {"size": (96, 54), "resolutions": [300], "along": 8}
COLUMNS = "surfels", "shadow", "drawn, all", "drawn", "time"
#: kind of frame -> the least surfels for which it looks
KINDS = {"all": math.inf, "seen": hidden_objects.LEAST_SURFELS}


def arguments(parser) -> None:
    parser.add_argument("--size", type=int, nargs=2, default=(960, 540), help="pixels")
    parser.add_argument("--resolutions", type=int, nargs="+", default=[1500], help="surfels along the city")
    parser.add_argument("--along", type=int, default=24, help="buildings along each side")


def run(options, report) -> None:
    device = open_device(options.device)
    width, height = options.size
    report.header(device, f"{width} x {height} pixels, medians of {options.turns} turns")
    report.table(COLUMNS, (row for n in options.resolutions for row in rows(device, n, options)))


def rows(device, resolution: int, options):
    surfels = sample_mesh(city(options.along), resolution=resolution, **PLAIN)
    middle = options.along / 2
    pose = look_at((middle - 0.5, -1.5, 1.2), (middle - 0.1, 8, 1.0))
    camera = Camera.perspective(pose, 0.8, tuple(options.size), 0.05, 100)
    for shadow in (False, True):
        sun = Light("sun", energy=3, direction=(0.4, 0.5, -0.7), casts_shadow=shadow)
        scene = Scene((Instance(surfels, np.eye(4)),), (sun,), (0.2,) * 3)
        jobs = {kind: partial(frame, Renderer(device), scene, camera, least) for kind, least in KINDS.items()}
        drawn = in_turn(jobs, options.turns, wall)
        one, every = drawn.results["seen"], drawn.results["all"]
        if not np.array_equal(one.color, every.color):
            raise Problem("Leaving out hidden splats changed the picture.")
        ratio = Spread.of(drawn.ratios("seen", "all"))
        counts = (f"{shown.stats['splats_drawn']:,}" for shown in (every, one))
        yield f"{len(surfels):,}", "sun's" if shadow else "none", *counts, f"{ratio.median:.2f}"


def frame(renderer: Renderer, scene: Scene, camera: Camera, least: float):
    """A frame that draws its shadow maps. least: surfels for which hidden ones are looked for."""
    renderer.resources.made_from.clear()
    with mock.patch.object(hidden_objects, "LEAST_SURFELS", least):
        return renderer.render(scene, camera, Settings(outputs=("color",)))


def city(along: int) -> TriangleMesh:
    """Rough boxes and balls of different heights, a unit apart."""
    random, parts = np.random.default_rng(1), []
    for place in np.ndindex(along, along):
        height, width = random.uniform(0.5, 3), random.uniform(0.6, 0.8)
        if random.random() < 0.25:
            made = trimesh.creation.icosphere(3, width / 2)
        else:
            made = trimesh.creation.box((width, width, height)).subdivide().subdivide().subdivide()
            made.vertices += random.normal(0, 0.004, made.vertices.shape)
        made.apply_translation((*place, height / 2))
        parts.append(made)
    whole = trimesh.util.concatenate(parts)
    return TriangleMesh(whole.vertices, whole.faces)
