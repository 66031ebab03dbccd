# SPDX-License-Identifier: GPL-3.0-or-later
"""The picture at the extremes of arithmetic, for every method: numbers, and the plots of docs/numerics.md.

    PYTHON scripts/measure_numerics.py [--out docs/numerics] [--only FIGURE]

PYTHON must have moderngl and matplotlib (the environment that scripts/test.py makes). Scenes are 64 x 64 pixels of
2 x 2 samples; the truth is `render_exact` with the same samples, PSNR is of sRGB, 160 dB stands for equal. A method
that filters is not that truth's picture: its line shows by being level that the extreme changes nothing. An empty
pixel is one that the truth covers whole and the method not at all.
"""

from __future__ import annotations

import argparse
import datetime
import math
import subprocess
import sys
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field, replace
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
from splat_addon.reference.metrics import psnr, srgb  # noqa: E402
from splat_addon.rendering import Camera, Instance, Light, Renderer, Scene, Settings, look_at, open_device  # noqa: E402
from splat_addon.rendering.methods import METHODS  # noqa: E402

SIZE, SAMPLES = (64, 64), 2
EQUAL = 160.0
LIGHTS, WORLD = (Light("sun", energy=2.0, direction=(0.3, 0.2, -1.0)),), (0.1, 0.1, 0.1)
PLAN = import_module("splat_addon.rendering.plan")

#: x, scene, camera and what differs from the default settings.
Shots = Iterator[tuple[float, Scene, Camera, dict]]


@dataclass(frozen=True)
class Panel:
    """name: of its column. x: the axis's label. shots: what is rendered, the same for every method.
    least: what tests/extremes hold quads to. against: "truth", or "itself" where the first shot is what the others must
    equal. is_log: of the x axis. limits: constants of the plan that are changed, to show what it avoids.
    """

    name: str
    x: str
    shots: Callable[[], Shots]
    least: float
    against: str = "truth"
    is_log: bool = True
    limits: Mapping[str, float] = field(default_factory=dict)


def origin_camera(size=SIZE, near=0.01, fov=60.0, shift=(0.0, 0.0)) -> Camera:
    return Camera.perspective(np.eye(4), math.radians(fov), size, near, 1000, shift)


def lit(*surfels) -> Scene:
    return Scene(surfels, LIGHTS, WORLD)


def scale() -> Shots:
    world = scenes.torus(6000, SIZE)
    for exponent in (0, *range(-18, 19, 3)):
        s = 10.0**exponent
        yield s, *transformed(*world, np.diag([s, s, s, 1])), {}


def offset() -> Shots:
    world = scenes.torus(6000, SIZE)
    for exponent in range(0, 15):
        matrix = np.eye(4)
        matrix[:3, 3] = 10.0**exponent * np.array((1, -1, 0.5))
        yield 10.0**exponent, *transformed(*world, matrix), {}


def near() -> Shots:
    scene, camera = scenes.torus(6000, SIZE)
    for exponent in np.arange(-6, -0.9, 0.5):
        moved = replace(camera, near=10.0**exponent, far=1e6)
        yield moved.near, replace(scene, surfels=(*scene.surfels, speck(moved, 1.5 * moved.near))), moved, {}


def span() -> Shots:
    """A parallel camera, and one disc far behind the rest."""
    scene, _ = scenes.torus(6000, SIZE)
    matrix = look_at((0.3, -3.6, 2.2), (0, 0, 0))
    for exponent in np.arange(1, 6.1, 0.5):
        far = 10.0**exponent
        camera = Camera.orthographic(matrix, 3.2, SIZE, 0.1, far)
        behind = matrix.copy()
        behind[:3, 3] += 0.5 * matrix[:3, 0] - 0.9 * far * matrix[:3, 2]
        disc = Instance(discs((0, 0, 0), (0.1, 0, 0), (0, 0.1, 0), (1, 0, 0)), behind)
        yield far, replace(scene, surfels=(*scene.surfels, disc)), camera, {}


def grazing() -> Shots:
    for flatness in (30, 20, 15, 10, 7, 5, 3, 2, 1.5, 1, 0.8, 0.6, 0.4, 0.2, 0.1, 0.01, 0.001):
        yield flatness, lit(sheet(30, 1.0, 90 - flatness, 2.0)), origin_camera(), {}


def floor_below() -> Shots:
    """A floor of 24 x 24 discs that passes under the eye: the nearest reach behind it."""
    for height in (0.3, 0.2, 0.1, 0.05, 0.03, 0.02, 0.01, 0.005, 0.002, 0.001):
        floor = replace(sheet(24, 2.0, 90.0, 0.0), origin=(0.0, -height, 0.0))
        yield height, lit(floor), origin_camera(near=1e-4), {}


def field_of_view() -> Shots:
    scene, _ = scenes.sphere(6000, SIZE)
    for angle in (1, 5, 10, 30, 60, 90, 120, 140, 150, 160, 165, 170):
        distance = max(1.1 / math.sin(math.radians(angle / 2)), 1.3)
        matrix = look_at(distance * np.array((0, -1, 0.1)), (0, 0, 0))
        yield angle, scene, Camera.perspective(matrix, math.radians(angle), SIZE, distance / 100, 10 * distance), {}


def off_axis() -> Shots:
    scene, _ = scenes.sphere(6000, SIZE)
    width = 4 * 2 * math.tan(math.radians(30))
    for shift in (0.2, 0.5, 1, 2, 5, 10, 20, 50, 100):
        matrix = look_at((0, -4, 0), (0, 0, 0))
        matrix[:3, 3] -= shift * width * matrix[:3, 0]
        yield shift, scene, Camera.perspective(matrix, math.radians(60), SIZE, 0.1, 100, shift=(shift, 0)), {}


def ratio() -> Shots:
    """21 parallel ellipses side by side, longer and longer, at an angle."""
    u, v = np.array(((math.cos(1), math.sin(1), 0), (-math.sin(1), math.cos(1), 0)))
    for exponent in np.arange(0, 6.1, 0.5):
        centers = np.linspace(-1, 1, 21)[:, None] * v + (0, 0, -3)
        yield 10.0**exponent, lit(discs(centers, 0.08 * 10.0**exponent * u, 0.08 * v)), origin_camera(), {}


def giants() -> Shots:
    for exponent in np.arange(2, 10.1, 0.5):
        radius = 10.0**exponent * 0.01
        floor = discs((0.1, -1.03, -5), (radius, 0, 0), (0, 0.1 * radius, -radius), (0.2, 0.5, 0.9))
        yield 10.0**exponent, lit(floor), origin_camera(), {}


def overdraw() -> Shots:
    for layers in (1, 2, 5, 10, 20, 50, 100, 200, 500, 1000, 2000, 5000):
        random = np.random.default_rng(1)
        centers = np.concatenate([random.normal(0, 0.02, (layers, 2)), -3 - 1e-3 * random.random((layers, 1))], axis=1)
        yield layers, lit(discs(centers, (1.5, 0, 0), (0, 1.5, 0))), origin_camera((12, 12)), {}


def overdraw_in_float16() -> Shots:
    for layers, scene, camera, _ in overdraw():
        yield layers, scene, camera, {"accumulation": "float16"}


def sub_pixel() -> Shots:
    camera = origin_camera((4, 4))
    pixel = 3 * (camera.window[1] - camera.window[0]) / 4
    centers = np.random.default_rng(1).random((100_000, 3)) * (pixel, pixel, 1e-3) - (0, 0, 3)
    for radius in (0.5, 0.2, 0.1, 0.05, 0.02, 0.01, 0.005, 0.002, 0.001):
        splats = discs(centers, (radius * pixel, 0, 0), (0, radius * pixel, 0))
        yield radius, Scene((splats,)), camera, {"shading": "flat"}


def epsilon() -> Shots:
    world = scenes.torus(6000, SIZE)
    for radii in (1e-7, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 0.1, 0.5, 1, 2, 5, 10, 20, 50, 100):
        yield radii, *world, {"epsilon": radii}


def gap() -> Shots:
    """A red sheet before a green one; epsilon is 0.5 radii."""
    front = sheet(20, 1.0, 0, 3.0, (1, 0, 0))
    for radii in (1e-6, 1e-3, 0.01, 0.1, 0.2, 0.3, 0.4, 0.45, 0.55, 0.6, 0.8, 1, 2):
        back = sheet(20, 1.0, 0, 3.0 + radii * float(front.radius[0]), (0, 1, 0))
        yield radii, Scene((front, back)), origin_camera(), {"shading": "flat"}


HARDWARE_DEPTH = {"MAX_HARDWARE_DEPTH_RATIO": math.inf, "MAX_HARDWARE_DEPTH_RADIUS": math.inf}

#: file -> its panels
FIGURES = {
    "invariance": (
        Panel("scale", "scale of the world", scale, 60, "itself"),
        Panel("offset", "distance from the world's origin, in torus radii", offset, 60, "itself"),
    ),
    "depth": (
        Panel("near", "near plane, something right behind it", near, 60),
        Panel("near, hardware depth", "the same with the hardware's depth", near, 60, limits=HARDWARE_DEPTH),
        Panel("parallel span", "parallel camera: distance of the farthest", span, 60),
    ),
    "grazing": (
        Panel("grazing", "degrees left to edge-on", grazing, 50),
        Panel("floor", "height of the eye above a floor", floor_below, 50),
    ),
    "views": (
        Panel("field of view", "field of view, degrees", field_of_view, 50, is_log=False),
        Panel("off axis", "window off the axis, picture widths", off_axis, 50),
    ),
    "sizes": (
        Panel("giants", "radius of one splat, near distances", giants, 50),
        Panel("ratio", "length of ellipses over their width", ratio, 50),
        Panel("sub-pixel", "radius in pixels of 100,000 on a pixel", sub_pixel, 50),
    ),
    "sums": (
        Panel("overdraw", "splats over every sample, float32 sums", overdraw, 80),
        Panel("overdraw, float16", "splats over every sample, float16 sums", overdraw_in_float16, 0),
    ),
    "layers": (
        Panel("epsilon", "epsilon, radii", epsilon, 40),
        Panel("gap", "gap between two sheets, radii", gap, 50),
    ),
}


#: method -> what shows its formula's limit, as (label, scene, camera): tests/extremes' known failures.
FAILURES = {
    "affine": (
        lambda: ("sheet at 68 degrees", lit(sheet(30, 1.0, 68, 2.0)), origin_camera()),
        lambda: ("window 5 widths off the axis", *next(s for s in off_axis() if s[0] == 5)[1:3]),
    ),
    "ewa": (lambda: ("one disc, a floor", *next(s for s in giants() if s[0] > 300)[1:3]),),
    "raycast": (lambda: ("sheet edge-on", lit(sheet(30, 1.0, 90, 2.0)), origin_camera()),),
    "homogeneous": (lambda: ("ellipses 10 : 1", *next(s for s in ratio() if s[0] == 10)[1:3]),),
}


def draw_failures(path: Path, device) -> None:
    """Above what the methods draw, below the truth."""
    shots = [(method, *make()) for method, makers in FAILURES.items() for make in makers]
    figure, axes = plt.subplots(2, len(shots), figsize=(2 * len(shots), 4.3), layout="constrained")
    for (above, below), (method, label, scene, camera) in zip(axes.T, shots, strict=True):
        frame = Renderer(device).render(scene, camera, Settings(method=method, supersampling=SAMPLES))
        for axis, picture in ((above, frame), (below, render_exact(scene, camera, samples=SAMPLES))):
            axis.imshow(srgb(picture.color[..., :3]), origin="lower", interpolation="nearest")
            axis.set(xticks=(), yticks=())
        above.set_title(f"{method}: {label}", fontsize=7)
        below.set_xlabel("truth", fontsize=7)
    figure.savefig(path, dpi=80)
    plt.close(figure)


@dataclass(frozen=True)
class Found:
    """At one x: the PSNR, at most `EQUAL`; empty pixels; numbers that are not finite."""

    x: float
    decibels: float
    empty: int
    not_finite: int


def measured(panel: Panel, device) -> dict[str, list[Found]]:
    """method -> what was found at each x."""
    results = {method: [] for method in METHODS}
    renderers, firsts = {method: Renderer(device) for method in METHODS}, {}
    usual = {name: getattr(PLAN, name) for name in panel.limits}
    try:
        for name, value in panel.limits.items():
            setattr(PLAN, name, value)
        for x, scene, camera, changes in panel.shots():
            truth = (
                render_exact(scene, camera, Settings(**changes), samples=SAMPLES) if panel.against == "truth" else None
            )
            for method in METHODS:
                frame = renderers[method].render(
                    scene, camera, Settings(method=method, supersampling=SAMPLES, **changes)
                )
                known = truth or firsts.setdefault(method, frame)
                empty = np.count_nonzero((known.coverage > 0.999) & (frame.coverage == 0))
                not_finite = sum(np.count_nonzero(~np.isfinite(a)) for a in (frame.color, frame.depth, frame.normal))
                results[method].append(Found(x, min(psnr(frame.color, known.color), EQUAL), empty, not_finite))
    finally:
        for name, value in usual.items():
            setattr(PLAN, name, value)
    return {method: sorted(found, key=lambda f: f.x) for method, found in results.items()}


def draw_figure(path: Path, panels: tuple[Panel, ...], results: dict) -> None:
    """One picture of panels side by side, every method a line; crosses where pixels are empty."""
    figure, axes = plt.subplots(1, len(panels), figsize=(4.5 * len(panels), 3), sharey=True, layout="constrained")
    for axis, panel in zip(axes, panels, strict=True):
        for method, found in results[panel.name].items():
            (line,) = axis.plot(
                [f.x for f in found], [f.decibels for f in found], marker="o", markersize=3, label=method
            )
            holes = [f for f in found if f.empty]
            axis.plot([f.x for f in holes], [f.decibels for f in holes], "x", color=line.get_color(), markersize=8)
        if panel.least:
            axis.axhline(panel.least, color="gray", linestyle="--", linewidth=1, label="quads, held by tests")
        axis.set(xscale="log" if panel.is_log else "linear", xlabel=panel.x, ylim=(0, EQUAL + 10))
        axis.grid(alpha=0.3)
    axes[0].set_ylabel("PSNR, dB")
    axes[-1].legend(fontsize=7)
    figure.savefig(path, dpi=80)
    plt.close(figure)


def row(name: str, results: dict[str, list[Found]]) -> str:
    """A line of the table: for every method the least PSNR, and where there are any the empty pixels in all shots."""
    cells = []
    for found in results.values():
        empty, not_finite = sum(f.empty for f in found), sum(f.not_finite for f in found)
        cell = f"{min(f.decibels for f in found):.0f}"
        cells.append(cell + (f", {empty} empty" if empty else "") + (f", {not_finite} NaN" if not_finite else ""))
    return f"| {name} | " + " | ".join(cells) + " |"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--out", type=Path, default=ROOT / "docs" / "numerics")
    parser.add_argument("--only", choices=[*FIGURES, "failures"], help="one figure")
    options = parser.parse_args()
    options.out.mkdir(parents=True, exist_ok=True)
    device = open_device("standalone")
    commit = subprocess.run(["git", "rev-parse", "--short", "HEAD"], cwd=ROOT, capture_output=True, text=True).stdout
    print(f"{device.renderer}, {device.backend}, {datetime.date.today()}, commit {commit.strip()}", flush=True)
    if options.only in (None, "failures"):
        draw_failures(options.out / "failures.png", device)
    table = []
    for file in FIGURES if options.only is None else FIGURES.keys() & {options.only}:
        results = {}
        for panel in FIGURES[file]:
            results[panel.name] = measured(panel, device)
            for method, found in results[panel.name].items():
                values = (f"{f.x:.3g}: {f.decibels:.1f}" + (f" ({f.empty} empty)" if f.empty else "") for f in found)
                print(f"{panel.name}, {method}: " + ", ".join(values), flush=True)
            table.append(row(panel.name, results[panel.name]))
        draw_figure(options.out / f"{file}.png", FIGURES[file], results)
    if not table:
        return
    print("\n| least dB | " + " | ".join(METHODS) + " |\n|" + "---|" * (len(METHODS) + 1))
    print("\n".join(table))


if __name__ == "__main__":
    main()
