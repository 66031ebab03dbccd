# SPDX-License-Identifier: GPL-3.0-or-later
"""What large surfels inside flat faces save: a box and a ball on a wide floor, each with and without.

Times are ratios of processor time to that of surfels of the same size, of conversion and of frames with a sun and
shadows. PSNR is measured in sRGB against the same engine's polygons. The pictures: polygons, surfels of the same size,
and with large ones.
"""

from __future__ import annotations

from functools import partial

import numpy as np
import trimesh

from measuring.timing import Spread, in_turn, processor
from splat_addon.reference.metrics import psnr
from splat_addon.rendering import (
    Camera,
    Instance,
    Light,
    Material,
    PolygonInstance,
    Renderer,
    Scene,
    Settings,
    look_at,
    make_polygons,
    open_device,
)
from splat_addon.sampling import TriangleMesh, sample_surface

DEVICES = ("standalone",)
QUICK = {"size": 48, "cells": [40]}
#: name -> options of `sample_surface`, as the operator gives them
KINDS = {"same": {"tolerance": None}, "large": {}}
CHALK = (Material(roughness=1.0, ior=1.0),)
COLUMNS = "cells", "surfels", "surfels, large", "conversion", "frame", "dB", "dB, large"


def arguments(parser) -> None:
    parser.add_argument("--size", type=int, default=512, help="pixels along each side")
    parser.add_argument("--cells", type=int, nargs="+", default=[500, 1000, 2000], help="along the floor's edge")


def run(options, report) -> None:
    renderer = Renderer(open_device(options.device))
    report.header(renderer.device, f"{options.size} x {options.size} pixels, medians of {options.turns} turns")
    report.table(COLUMNS, rows(renderer, options, report))


def rows(renderer: Renderer, options, report):
    camera = Camera.perspective(look_at((0, -8, 3.2), (0, 0, 1)), 0.7, (options.size, options.size), near=0.1, far=100)
    settings = Settings(outputs=("color",))
    polygons = [
        PolygonInstance(make_polygons(m.positions, m.triangles, m.corner_normals), materials=CHALK) for m in meshes()
    ]
    truth = renderer.render(lit(polygons=polygons), camera, settings).color
    for cells in options.cells:
        jobs = {kind: partial(converted, 20 / cells, how) for kind, how in KINDS.items()}
        made = in_turn(jobs, options.turns, processor)
        scenes = {kind: lit(surfels=[Instance(s, materials=CHALK) for s in made.results[kind]]) for kind in KINDS}
        drawn = in_turn(
            {k: partial(renderer.render, s, camera, settings) for k, s in scenes.items()}, options.turns, processor
        )
        counts = (f"{sum(map(len, made.results[kind])):,}" for kind in KINDS)
        times = (f"{Spread.of(turns.ratios('large', 'same')).median:.2f}" for turns in (made, drawn))
        report.picture(f"flat_{cells}", [truth, *(drawn.results[kind].color for kind in KINDS)])
        yield cells, *counts, *times, *(f"{psnr(drawn.results[kind].color, truth):.1f}" for kind in KINDS)


def meshes() -> list[TriangleMesh]:
    ball = trimesh.creation.icosphere(subdivisions=4, radius=0.9).apply_translation((1.2, 0, 0.9))
    box = trimesh.creation.box((1.6, 1.6, 1.6)).apply_translation((-1.2, 0, 0.6))
    corners = np.array([(-10, -10, 0), (10, -10, 0), (10, 10, 0), (-10, 10, 0.0)])
    return [
        TriangleMesh(corners, np.array([(0, 1, 2), (0, 2, 3)])),
        TriangleMesh(box.vertices, box.faces),
        TriangleMesh(ball.vertices, ball.faces, corner_normals=ball.vertex_normals[ball.faces]),
    ]


def converted(spacing: float, how: dict) -> list:
    """The surfels of all meshes. how: one of `KINDS`."""
    made = [sample_surface(mesh, spacing=spacing, **how).surfels for mesh in meshes()]
    return [made[0], *(surfels.as_solid() for surfels in made[1:])]


def lit(**shown) -> Scene:
    sun = Light("sun", energy=3, direction=(-0.5, 0.6, -1), size=0.009, casts_shadow=True)
    return Scene(shown.pop("surfels", ()), (sun,), (0.3, 0.35, 0.4), **shown)
