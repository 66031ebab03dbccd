# SPDX-License-Identifier: GPL-3.0-or-later
"""How much 16-bit storage loses beside half floats, as Botsch et al. 2005, section 6, store positions and normals.

PSNR in sRGB to the picture of float32 surfels. Half floats are rounded in each object's own space, and everything else
keeps float32, as in the paper; 16-bit storage rounds everything.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from bench.trade.cases import CASES, FULL, View
from measuring.drawing import holes
from splat_addon.reference.metrics import psnr
from splat_addon.rendering import Renderer, Scene, Settings, open_device

DEVICES = ("standalone",)
QUICK = {"size": 64, "scenes": ["torus"]}
METHODS = "quad", "mip"
COLUMNS = "scene", "method", "half floats", "16-bit storage", "bare pixels of half floats"


def arguments(parser) -> None:
    parser.add_argument("--scenes", nargs="+", choices=CASES, default=["checker", "torus", "armadillo"], metavar="NAME")
    parser.add_argument("--size", type=int, default=FULL, help="pixels along each side; splats keep theirs")


def run(options, report) -> None:
    renderer = Renderer(open_device(options.device))
    report.header(renderer.device, f"{options.size} x {options.size} pixels, one sample a pixel")

    def rows():
        for name in options.scenes:
            case = CASES[name]
            scene, camera = case.build(View(options.size, options.models))
            for method in METHODS:
                settings = Settings(method=method, shading=case.shading, supersampling=1, detail_tolerance=0.0)
                whole = renderer.render(scene, camera, settings)
                half = renderer.render(in_half_floats(scene), camera, settings)
                stored = renderer.render(scene, camera, replace(settings, storage="16-bit"))
                decibels = (f"{psnr(frame.color, whole.color):.1f}" for frame in (half, stored))
                yield name, method, *decibels, holes(half, whole)

    report.table(COLUMNS, rows())


def in_half_floats(scene: Scene) -> Scene:
    """The scene with positions, in objects' spaces, and normals rounded to 16-bit floats."""
    return replace(scene, surfels=tuple(replace(i, shape=_rounded(i.surfels)) for i in scene.surfels))


def _rounded(surfels):
    places = (surfels.origin + surfels.positions).astype(np.float16).astype(np.float64)
    normals = surfels.normals.astype(np.float16).astype(np.float32)
    return replace(surfels, positions=(places - surfels.origin).astype(np.float32), normals=normals)
