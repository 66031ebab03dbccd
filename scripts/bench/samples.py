# SPDX-License-Identifier: GPL-3.0-or-later
"""How fast a picture converges with the number of samples, and figures of multi-sample effects.

PSNR is measured in sRGB. The reference for still pictures is `render_exact` with 16 x 16 rays per pixel, for motion
blur the mean of 1024 samples, for panoramas the means of 8 x 8 pixels of a larger panorama drawn with Quads. Figures:
turning tori at rest, with 4 shutter steps and with one for each of 8 samples; balls all around the camera as
equirectangular, equidistant and equisolid panoramas.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from splat_addon import rendering
from splat_addon.reference import render_exact, scenes
from splat_addon.reference.metrics import psnr
from splat_addon.rendering import Lens, Panorama, Renderer, Settings, look_at, open_device
from splat_addon.rendering.assembly.accumulation import moment_places

DEVICES = ("standalone",)
QUICK = {"size": 8, "splats": 500, "many": 16}
COUNTS = (1, 4, 16, 64)
METHODS = ("quad", "mip")


def arguments(parser) -> None:
    parser.add_argument("--size", type=int, default=64, help="pixels along each side; four times that in pictures")
    parser.add_argument("--splats", type=int, default=10_000)
    parser.add_argument("--many", type=int, default=1024, help="samples that stand for all of them")


def run(options, report) -> None:
    renderer = Renderer(open_device(options.device))
    report.header(renderer.device, f"{options.size} x {options.size} pixels, {options.splats:,} splats")
    report.table(["dB", "method", *map(str, COUNTS)], quality(renderer, options))
    shot = scenes.torus(6 * options.splats, (4 * options.size,) * 2)
    moments = ((0.5,), moment_places(8, 4), moment_places(8, 8))
    report.picture("motion_blur", [turning(renderer, *shot, places, 8) for places in moments])
    balls, _ = scenes.transparent_spheres(count=4000, opacity=1.0)
    balls = replace(balls, lights=tuple(replace(light, casts_shadow=not options.quick) for light in balls.lights))
    cameras = panoramas(4 * options.size)
    report.picture("panoramas", [renderer.render(balls, camera, chosen("mip", 8, True)).color for camera in cameras])


def chosen(method: str, count: int, lit: bool = False) -> Settings:
    return Settings(method=method, shading="principled" if lit else "flat", samples=count, outputs=("color",))


def quality(renderer: Renderer, options):
    size, count = options.size, options.splats
    shots = {name: getattr(scenes, name)(count=count, size=(size, size)) for name in ("checker_plane", "torus")}
    board, camera = shots["checker_plane"]
    through = replace(camera, lens=Lens(0.02, float(np.linalg.norm(camera.matrix_world[:3, 3])), blades=6))
    pose = look_at((0.0, 0.0, 0.3), (1.0, 0.3, 0.2))
    within = Panorama(pose, rendering.Equirectangular(), (2 * size, size), near=0.01)
    tori, large = shots["torus"][0], replace(within, size=(16 * size, 8 * size))
    fine = renderer.render(tori, large, chosen("quad", 1)).color.reshape(size, 8, 2 * size, 8, 4).mean(axis=(1, 3))
    truths = {
        (name, kind): render_exact(*shot, samples=16, pixel_filter=kind).color
        for name, shot in shots.items()
        for kind in ("box", "gaussian")
    }
    for m in METHODS:
        draws = {
            "depth of field": lambda n, m=m: renderer.render(board, through, chosen(m, n)).color,
            "motion blur": lambda n, m=m: turning(renderer, *shots["torus"], moment_places(n, n), n, m),
            "panorama": lambda n, m=m: renderer.render(tori, within, chosen(m, n)).color,
        }
        for (name, kind), truth in truths.items():
            colors = (renderer.render(*shots[name], chosen(m, n, lit=True)).color for n in COUNTS)
            yield f"{name}, {kind}", m, *(f"{psnr(color, truth):.1f}" for color in colors)
        for name, draw in draws.items():
            truth = fine if name == "panorama" else draw(options.many)
            yield name, m, *(f"{psnr(draw(n), truth):.1f}" for n in COUNTS)


def turning(renderer: Renderer, scene, camera, places, count: int, method: str = "mip") -> np.ndarray:
    """The mean of this many samples while the scene turns a twelfth around z, with one moment at each of the given
    times."""

    def moments():
        for place in places:
            angle, turn = (place - 0.5) * math.pi / 6, np.eye(4)
            turn[:2, :2] = (math.cos(angle), -math.sin(angle)), (math.sin(angle), math.cos(angle))
            moved = (replace(instance, matrix_world=turn @ instance.matrix_world) for instance in scene.surfels)
            yield replace(scene, surfels=tuple(moved)), camera

    return renderer.render_moments(moments(), len(places), chosen(method, count, lit=True)).color


def panoramas(height: int):
    pose, square = look_at((0.45, -0.5, 0.55), (-0.2, 1.0, 0.3)), (height, height)
    yield Panorama(pose, rendering.Equirectangular(), (2 * height, height), near=0.01)
    yield Panorama(pose, rendering.EquidistantFisheye(math.pi), square, near=0.01)
    yield Panorama(pose, rendering.EquisolidFisheye(math.pi, 12.0, (36.0, 36.0)), square, near=0.01)
