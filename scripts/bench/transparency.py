# SPDX-License-Identifier: GPL-3.0-or-later
"""27 transparent spheres, as in figure 6 of Guennebaud et al. 2006: layers, accuracy, time and a picture.

PSNR is of sRGB, from `render_exact`, which peels every layer that a ray meets, with 4 x 4 rays a pixel under the
method's own filter; times are ratios to the same spheres opaque, in turn. The picture: the exact one, then Mip's.
"""

from __future__ import annotations

from dataclasses import replace

from measuring.timing import frame, in_turn
from splat_addon.reference import render_exact, scenes
from splat_addon.reference.metrics import psnr
from splat_addon.rendering import Renderer, Scene, Settings, open_device

DEVICES = ("standalone",)
QUICK = {"size": 12}
#: layers, and whether the last one blends all that is left
CHOICES = {
    "6 layers": (6, False),
    "3 layers, the rest lost": (3, False),
    "3 layers, the rest blended": (3, True),
    "2 layers, the rest blended": (2, True),
    "8 layers, the rest blended": (8, True),
}
#: method -> its settings, and the pixel filter that it approximates
METHODS = {"quad": ({"supersampling": 2}, "box"), "mip": ({}, "gaussian")}


def arguments(parser) -> None:
    parser.add_argument("--size", type=int, default=192, help="pixels along each side")


def run(options, report) -> None:
    renderer = Renderer(open_device(options.device))
    report.header(renderer.device, f"{options.size} x {options.size} pixels, medians of {options.turns} turns")
    scene, camera = scenes.transparent_spheres(size=(options.size, options.size))

    def rows():
        for method, (choices, pixel_filter) in METHODS.items():
            exact = render_exact(scene, camera, Settings(), samples=4, pixel_filter=pixel_filter).color
            shots = {"opaque": (opaque(scene), Settings(method=method, layers=6, outputs=("color",), **choices))}
            for name, (layers, blends) in CHOICES.items():
                shots[name] = scene, replace(shots["opaque"][1], layers=layers, blends_rest=blends)
            jobs = {name: lambda shot=shot: renderer.render(shot[0], camera, shot[1]) for name, shot in shots.items()}
            drawn = in_turn(jobs, options.turns, frame)
            for name in CHOICES:
                last, ratio = drawn.results[name], drawn.ratio(name, "opaque")
                yield method, name, f"{psnr(last.color, exact):.1f}", last.stats["layers"], f"{ratio:.1f}"
        report.picture("transparency", [exact, *(drawn.results[name].color for name in list(CHOICES)[:3])])

    report.table(("method", "layers", "PSNR", "layers made", "time"), rows())


def opaque(scene: Scene) -> Scene:
    """The same surfels, and nothing shows through them."""
    kinds = {instance.surfels: None for instance in scene.surfels}
    made = {surfels: replace(surfels, colors=surfels.colors * (1, 1, 1, 0) + (0, 0, 0, 1)) for surfels in kinds}
    return replace(scene, surfels=tuple(replace(i, surfels=made[i.surfels]) for i in scene.surfels))
