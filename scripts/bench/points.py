# SPDX-License-Identifier: GPL-3.0-or-later
"""Processor time and memory of making surfels from bare points.

All of it runs in one thread, so its processor time is about what a quiet machine takes. The picture shows the range
map: its points, and its surfels lit.
"""

from __future__ import annotations

from functools import partial

import numpy as np

from measuring.models import load_any
from measuring.timing import in_turn, peak_bytes, processor
from splat_addon.rendering import Camera, Light, Renderer, Scene, Settings, open_device
from splat_addon.sampling import surfels_from_points

DEVICES = ("standalone",)
QUICK = {"points": 2_000, "every": 50}
COLUMNS = "cloud", "points", "surfels", "CPU s", "points/CPU s", "peak bytes a point"


def arguments(parser) -> None:
    parser.add_argument("--points", type=int, default=1_000_000, help="random points of a sphere")
    parser.add_argument("--every", type=int, default=1, help="take each n-th point of the range map")


def run(options, report) -> None:
    report.header(how=f"median (least to most) of {options.turns} turns")
    scan = load_any(options.models / "rangemap_lato315.ply.gz").vertices[:: options.every]
    clouds = {"range map": np.asarray(scan), "random points of a sphere": sphere(options.points)}
    jobs = {name: partial(surfels_from_points, points) for name, points in clouds.items()}
    taken = in_turn(jobs, options.turns, processor, steps=report.steps)

    def rows():
        for name, job in jobs.items():
            count, seconds, (peak, made) = len(clouds[name]), taken.spread(name), peak_bytes(job)
            rate = f"{count / seconds.median:,.0f}"
            yield name, f"{count:,}", f"{len(made[0]):,}", f"{seconds:.2f}", rate, f"{peak / count:.0f}"

    report.table(COLUMNS, rows())
    report.picture("range_map", halves(clouds["range map"], Renderer(open_device(options.device))))


def sphere(count: int) -> np.ndarray:
    """Random points in random order, the worst that a memory cache can meet."""
    points = np.random.default_rng(0).normal(size=(count, 3))
    return points / np.linalg.norm(points, axis=1, keepdims=True)


def halves(points: np.ndarray, renderer: Renderer):
    """The points as they come, and as surfels; the camera stands where the scanner stood, nearer."""
    matrix = np.eye(4)
    matrix[:3, 3] = 0, -10, -200
    camera = Camera.perspective(matrix, np.radians(13), (640, 560), 1, 2000)
    facing = np.tile((0.0, 0.0, 1.0), (len(points), 1)), np.full(len(points), 0.08)
    lights = [Light("sun", direction=(0.5, -0.6, -0.8), energy=3.0)]
    bare, whole = surfels_from_points(points, *facing), surfels_from_points(points, viewpoint=(0, 0, 0))
    for (surfels, *_), shading in ((bare, "flat"), (whole, "principled")):
        settings = Settings(method="quad", supersampling=2, shading=shading)
        yield renderer.render(Scene([surfels], lights, (0.02, 0.02, 0.02)), camera, settings).color
