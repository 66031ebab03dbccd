# SPDX-License-Identifier: GPL-3.0-or-later
"""The picture at the extremes of arithmetic, for every method: numbers, and the plots of docs/numerics.md.

    PYTHON scripts/measure_numerics.py [--out docs/numerics]

PYTHON must have moderngl and matplotlib (the environment that scripts/test.py makes). Scenes are 64 x 64 pixels of
2 x 2 samples; the truth is `render_exact` with the same samples, PSNR is of sRGB, 160 dB stands for equal.
"""

from __future__ import annotations

import argparse
import datetime
import math
import subprocess
import sys
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from importlib import import_module
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT))

import matplotlib  # noqa: E402

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402

from splat_addon.reference import render_exact, scenes  # noqa: E402
from splat_addon.reference.extremes import discs, sheet, speck, transformed  # noqa: E402
from splat_addon.reference.metrics import psnr  # noqa: E402
from splat_addon.rendering import Camera, Light, Renderer, Scene, Settings, open_device  # noqa: E402
from splat_addon.rendering.methods import METHODS  # noqa: E402

SIZE = (64, 64)
EQUAL = 160.0
LIGHTS, WORLD = (Light("sun", energy=2.0, direction=(0.3, 0.2, -1.0)),), (0.1, 0.1, 0.1)
PLAN = import_module("splat_addon.rendering.plan")

#: (x, dB) of one series.
Rows = Iterator[tuple[float, float]]


@dataclass(frozen=True)
class Panel:
    """name: of its CSV columns. x: the axis's label, logarithmic. rows: of one method.
    least: what tests/extremes hold.
    """

    name: str
    x: str
    rows: Callable[[Renderer, Settings], Rows]
    least: float


def shown(decibels: float) -> float:
    return min(decibels, EQUAL)


def against_truth(renderer, settings, scene, camera) -> float:
    truth = render_exact(scene, camera, settings, samples=settings.supersampling)
    return shown(psnr(renderer.render(scene, camera, settings).color, truth.color))


def origin_camera(size=SIZE, near=0.01) -> Camera:
    return Camera.perspective(np.eye(4), math.radians(60), size, near, 1000)


def scale(renderer, settings) -> Rows:
    scene, camera = scenes.torus(6000, SIZE)
    base = renderer.render(scene, camera, settings).color
    for exponent in range(-18, 19, 3):
        s = 10.0**exponent
        frame = renderer.render(*transformed(scene, camera, np.diag([s, s, s, 1])), settings)
        yield s, shown(psnr(frame.color, base))


def offset(renderer, settings) -> Rows:
    scene, camera = scenes.torus(6000, SIZE)
    base = renderer.render(scene, camera, settings).color
    for exponent in range(0, 15):
        matrix = np.eye(4)
        matrix[:3, 3] = 10.0**exponent * np.array((1, -1, 0.5))
        yield 10.0**exponent, shown(psnr(renderer.render(*transformed(scene, camera, matrix), settings).color, base))


def near(renderer, settings) -> Rows:
    scene, camera = scenes.torus(6000, SIZE)
    for exponent in np.arange(-6, -0.9, 0.5):
        moved = replace(camera, near=10.0**exponent, far=1e6)
        world = replace(scene, surfels=(*scene.surfels, speck(moved, 1.5 * moved.near)))
        yield moved.near, against_truth(renderer, settings, world, moved)


def near_with_hardware_depth(renderer, settings) -> Rows:
    """What the plan avoids."""
    limits = PLAN.MAX_HARDWARE_DEPTH_RATIO, PLAN.MAX_HARDWARE_DEPTH_RADIUS
    PLAN.MAX_HARDWARE_DEPTH_RATIO = PLAN.MAX_HARDWARE_DEPTH_RADIUS = math.inf
    yield from list(near(renderer, settings))
    PLAN.MAX_HARDWARE_DEPTH_RATIO, PLAN.MAX_HARDWARE_DEPTH_RADIUS = limits


def grazing(renderer, settings) -> Rows:
    for flatness in (30, 20, 15, 10, 7, 5, 3, 2, 1.5, 1, 0.8, 0.6, 0.4, 0.2):
        scene = Scene((sheet(30, 1.0, 90 - flatness, 2.0),), LIGHTS, WORLD)
        yield flatness, against_truth(renderer, settings, scene, origin_camera())


def overdraw(renderer, settings) -> Rows:
    for layers in (1, 2, 5, 10, 20, 50, 100, 200, 500, 1000, 2000, 5000):
        random = np.random.default_rng(1)
        centers = np.concatenate([random.normal(0, 0.02, (layers, 2)), -3 - 1e-3 * random.random((layers, 1))], axis=1)
        scene = Scene((discs(centers, (1.5, 0, 0), (0, 1.5, 0)),), LIGHTS, WORLD)
        yield layers, against_truth(renderer, settings, scene, origin_camera((12, 12)))


def giants(renderer, settings) -> Rows:
    for exponent in np.arange(2, 10.1, 0.5):
        radius = 10.0**exponent * 0.01
        floor = discs((0.1, -1.03, -5), (radius, 0, 0), (0, 0.1 * radius, -radius), (0.2, 0.5, 0.9))
        yield 10.0**exponent, against_truth(renderer, settings, Scene((floor,), LIGHTS, WORLD), origin_camera())


def sub_pixel(renderer, settings) -> Rows:
    camera = origin_camera((4, 4))
    pixel = 3 * (camera.window[1] - camera.window[0]) / 4
    centers = np.random.default_rng(1).random((200_000, 3)) * (pixel, pixel, 1e-3) - (0, 0, 3)
    for radius in (1, 0.5, 0.2, 0.1, 0.05, 0.02, 0.01, 0.005, 0.002, 0.001):
        scene = Scene((discs(centers, (radius * pixel, 0, 0), (0, radius * pixel, 0)),))
        yield radius, against_truth(renderer, replace(settings, shading="flat"), scene, camera)


#: file -> its panels
FIGURES = {
    "invariance": (
        Panel("scale", "scale of the world", scale, 60),
        Panel("offset", "distance from the world's origin, in torus radii", offset, 60),
    ),
    "depth": (
        Panel("near", "near plane, something right behind it", near, 60),
        Panel("near_hardware", "the same with the hardware's depth", near_with_hardware_depth, 60),
    ),
    "grazing": (
        Panel("grazing", "degrees left to edge-on", grazing, 50),
        Panel("overdraw", "splats over every sample", overdraw, 80),
    ),
    "sizes": (
        Panel("giants", "radius of one splat in near distances", giants, 50),
        Panel("sub_pixel", "radius in pixels of 200,000 splats on a pixel", sub_pixel, 50),
    ),
}


def draw_figure(path: Path, panels: tuple[Panel, ...], results: dict) -> None:
    """One picture of panels side by side, every method a line."""
    figure, axes = plt.subplots(1, len(panels), figsize=(9, 3), sharey=True, layout="constrained")
    for axis, panel in zip(axes, panels, strict=True):
        for method in METHODS:
            axis.plot(*zip(*results[panel.name, method], strict=True), marker="o", markersize=3, label=method)
        axis.axhline(panel.least, color="gray", linestyle="--", linewidth=1, label="held by tests")
        axis.set(xscale="log", xlabel=panel.x, ylim=(0, EQUAL + 10))
        axis.grid(alpha=0.3)
    axes[0].set_ylabel("PSNR, dB")
    axes[-1].legend(loc="lower right", fontsize=8)
    figure.savefig(path, dpi=90)
    plt.close(figure)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--out", type=Path, default=ROOT / "docs" / "numerics")
    out = parser.parse_args().out
    out.mkdir(parents=True, exist_ok=True)
    device = open_device("standalone")
    commit = subprocess.run(["git", "rev-parse", "--short", "HEAD"], cwd=ROOT, capture_output=True, text=True).stdout
    print(f"{device.renderer}, {device.backend}, {datetime.date.today()}, commit {commit.strip()}")
    results = {}
    for file, panels in FIGURES.items():
        for panel in panels:
            for method in METHODS:
                rows = list(panel.rows(Renderer(device), Settings(supersampling=2, method=method)))
                results[panel.name, method] = rows
                print(f"{panel.name}, {method}: " + ", ".join(f"{x:.3g} {y:.1f}" for x, y in rows), flush=True)
        draw_figure(out / f"{file}.png", panels, results)


if __name__ == "__main__":
    main()
