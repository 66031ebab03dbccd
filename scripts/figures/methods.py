# SPDX-License-Identifier: GPL-3.0-or-later
"""A picture of each method, with what it measures on three scenes.

Each picture shows a part of a checker plane at 6 degrees, a torus and a sphere of large splats, three times enlarged,
one sample a pixel; `exact` is the float64 reference under the pixel's Gaussian. `facing`: discs that face the viewer,
one on the axis exactly, by Homogeneous and as printed. The table: PSNR of sRGB, holes, time over that of Quads.
"""

from __future__ import annotations

from dataclasses import replace
from functools import partial

import numpy as np

from measuring.drawing import draw_in_turn, holes
from splat_addon.reference import render_exact, scenes
from splat_addon.reference.extremes import discs
from splat_addon.reference.metrics import psnr
from splat_addon.rendering import Camera, Renderer, Scene, Settings, open_device
from splat_addon.rendering.methods import METHODS

DEVICES = ("standalone",)
QUICK = {"samples": 1}
SIZE = (256, 256)
FLAT = Settings(shading="flat", supersampling=1)
#: name -> scene and camera, and the corner (column, row from the bottom) of the part that is shown.
SCENES = {
    "checker": (lambda: scenes.checker_plane(40, 40_000, 6, SIZE), (96, 94)),
    "torus": (lambda: scenes.torus(60_000, SIZE), (40, 128)),
    "sphere": (lambda: scenes.sphere(2_000, SIZE), (20, 150)),
}
PART, ENLARGED = 56, 3


def arguments(parser) -> None:
    parser.add_argument("--samples", type=int, default=6, help="N of the truth's N x N samples a pixel")


def run(options, report) -> None:
    renderer = Renderer(open_device(options.device))
    report.header(renderer.device, f"{SIZE[0]} x {SIZE[1]} pixels, medians of {options.turns} turns")
    parts, cells = {name: [] for name in ("exact", *METHODS)}, {name: [] for name in METHODS}
    choices = {method: replace(FLAT, method=method) for method in METHODS}
    for name, (build, corner) in SCENES.items():
        shot = build()
        exact = render_exact(*shot, FLAT, samples=options.samples, pixel_filter="gaussian")
        steps = partial(report.steps, doing=name)
        drawn = draw_in_turn(partial(renderer.render, *shot), choices, options.turns, steps=steps)
        for method, frame in {"exact": exact, **drawn.results}.items():
            parts[method].append(part(frame, corner))
        for method, frame in drawn.results.items():
            ratio = drawn.ratio(method, "quad").median
            cells[method].append(f"{psnr(frame.color, exact.color):.1f} dB, {holes(frame, exact)}, {ratio:.2f}")
    for method, shown in parts.items():
        report.picture(method, beside(shown), enlarged=ENLARGED)
    homogeneous = (choices[method] for method in ("homogeneous", "homogeneous_printed"))
    facing = [part(renderer.render(*facing_discs(), settings), (0, 0)) for settings in homogeneous]
    report.picture("facing", beside(facing), enlarged=ENLARGED)
    report.table(["method", *SCENES], ([METHODS[method].label, *row] for method, row in cells.items()))


def part(frame, corner) -> np.ndarray:
    x, y = corner
    return frame.color[y : y + PART, x : x + PART, :3]


def beside(parts: list[np.ndarray]) -> list[np.ndarray]:
    """With a white line between them."""
    line = np.ones((PART, 1, 3))
    return [shown for one in parts for shown in (one, line)][:-1]


def facing_discs() -> tuple[Scene, Camera]:
    x, y = (a.ravel() for a in np.meshgrid([-0.6, 0, 0.6], [-0.6, 0, 0.6]))
    surfels = discs(np.stack([x, y, np.full(9, -2.0)], axis=1), (0.25, 0, 0), (0, 0.25, 0))
    return Scene((surfels,), world=(0.05, 0.05, 0.05)), Camera.orthographic(np.eye(4), 2.0, (PART, PART), 0.1, 10)
