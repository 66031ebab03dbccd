# SPDX-License-Identifier: GPL-3.0-or-later
"""A picture of each method and of the reference.

Each shows crops of a checker plane at 6 degrees, a torus and a sphere of large splats, enlarged three times, with one
sample per pixel; `exact` is the float64 reference under the pixel's Gaussian. `facing`: discs that face the viewer, one
exactly on the axis, by Homogeneous and as printed.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from splat_addon.reference import render_exact, scenes
from splat_addon.reference.extremes import discs
from splat_addon.reference.kept import remembered
from splat_addon.rendering import Camera, Renderer, Scene, Settings, open_device
from splat_addon.rendering.methods import METHODS

DEVICES = ("standalone",)
QUICK = {"samples": 1}
SIZE = (256, 256)
FLAT = Settings(shading="flat", supersampling=1)
PART, ENLARGED = 56, 3


def arguments(parser) -> None:
    parser.add_argument("--samples", type=int, default=6, help="N of the truth's N x N samples a pixel")


def shots():
    """Scene, camera, and the corner (column, row from the bottom) of the crop."""
    yield scenes.checker_plane(40, 40_000, 6, SIZE), (96, 94)
    yield scenes.torus(60_000, SIZE), (40, 128)
    yield scenes.sphere(2_000, SIZE), (20, 150)


def run(options, report) -> None:
    renderer, exact, seen = Renderer(open_device(options.device)), remembered(render_exact), list(shots())
    report.header(renderer.device)
    truth = [part(exact(*s, FLAT, samples=options.samples, pixel_filter="gaussian"), at) for s, at in seen]
    report.picture("exact", beside(truth), enlarged=ENLARGED)
    for name in METHODS:
        settings = replace(FLAT, method=name)
        shown = [part(renderer.render(*shot, settings), corner) for shot, corner in seen]
        report.picture(name, beside(shown), enlarged=ENLARGED)
    homogeneous = (replace(FLAT, method=method) for method in ("homogeneous", "homogeneous_printed"))
    facing = [part(renderer.render(*facing_discs(), settings), (0, 0)) for settings in homogeneous]
    report.picture("facing", beside(facing), enlarged=ENLARGED)


def part(frame, corner) -> np.ndarray:
    x, y = corner
    return frame.color[y : y + PART, x : x + PART, :3]


def beside(parts: list[np.ndarray]) -> list[np.ndarray]:
    """Pictures side by side, separated by white lines."""
    line = np.ones((PART, 1, 3))
    return [shown for one in parts for shown in (one, line)][:-1]


def facing_discs() -> tuple[Scene, Camera]:
    x, y = (a.ravel() for a in np.meshgrid([-0.6, 0, 0.6], [-0.6, 0, 0.6]))
    surfels = discs(np.stack([x, y, np.full(9, -2.0)], axis=1), (0.25, 0, 0), (0, 0.25, 0))
    return Scene((surfels,), world=(0.05, 0.05, 0.05)), Camera.orthographic(np.eye(4), 2.0, (PART, PART), 0.1, 10)
