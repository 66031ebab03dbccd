# SPDX-License-Identifier: GPL-3.0-or-later
"""What 16-bit storage, float16 sums, multisampling and the threshold at edges lose and gain: docs/numerics.md's tables.

    PYTHON scripts/measure_formats.py [--models FOLDER] [--size 256] [--turns 7] [--only TABLE]

PYTHON is the environment that scripts/test.py makes. Times are ratios of one run, in turn, medians; PSNR is of sRGB.
"""

from __future__ import annotations

import argparse
import datetime
import math
import os
import platform
import statistics
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import replace
from functools import partial
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT))

import numpy as np  # noqa: E402
from PIL import Image  # noqa: E402

from scripts.costs.planned import BYTES  # noqa: E402
from scripts.measure_models import load, median_seconds, scene_of  # noqa: E402
from scripts.trade.measurement import draw_turns  # noqa: E402
from splat_addon.reference import render_exact, scenes  # noqa: E402
from splat_addon.reference.extremes import discs  # noqa: E402
from splat_addon.reference.metrics import psnr, srgb  # noqa: E402
from splat_addon.rendering import Camera, Frame, Light, Renderer, Scene, Settings, open_device  # noqa: E402
from splat_addon.rendering.storages import STORAGES  # noqa: E402
from splat_addon.sampling import sample_mesh  # noqa: E402

FORMATS = {
    "16-bit storage": {"storage": "16-bit"},
    "float16 sums": {"accumulation": "float16"},
    "both": {"storage": "16-bit", "accumulation": "float16"},
}
MULTISAMPLED = {
    "1 sample": {},
    "2 x 2": {"supersampling": 2},
    "3 x 3": {"supersampling": 3},
    "4 hardware samples, shaded once": {"multisampling": 4},
    "4 hardware samples, each shaded": {"multisampling": 4, "sample_shading": True},
    "1 sample, threshold 0.25": {"edge_threshold": 0.25},
    "1 sample, threshold 1": {"edge_threshold": 1.0},
    "4 shaded once, threshold 0.25": {"multisampling": 4, "edge_threshold": 0.25},
}
#: Of those, in docs/rendering/multisampling.png.
PICTURED = ("1 sample", "4 hardware samples, shaded once", "4 hardware samples, each shaded", "3 x 3")


def in_turn(renderer: Renderer, scene, camera, choices: dict, turns: int) -> tuple[dict[str, Frame], dict[str, float]]:
    """The last frame of each choice, and the median of its time over the first one's of the same turn."""
    draw = partial(renderer.render, scene, camera)
    frames, times = draw_turns(draw, list(choices.values()), turns, lambda: None)
    first, *_ = times.values()
    ratios = {s: statistics.median(t / f for t, f in zip(own, first, strict=True)) for s, own in times.items()}
    return {name: frames[s] for name, s in choices.items()}, {name: ratios[s] for name, s in choices.items()}


def pictures(models: Path, size: int) -> Iterator[tuple[str, Scene, Camera]]:
    mesh = load(models / "armadillo.obj.gz")
    for resolution in (192, 512):
        surfels = sample_mesh(mesh, resolution=resolution)
        yield f"armadillo, {len(surfels) // 1000}k", *scene_of(surfels, size)
    yield "checker plane, 20k", *scenes.checker_plane(size=(size, size))
    yield "torus in a torus, 40k", *scenes.torus(size=(size, size))


def formats(renderer: Renderer, options) -> None:
    print("| scene | method | format | PSNR to float32, dB | same coverage | time |\n|---|---|---|---|---|---|")
    for name, scene, camera in pictures(options.models, options.size):
        for method in ("quad", "mip"):
            plain = Settings(method=method, supersampling=1)
            choices = {"float32": plain} | {label: replace(plain, **values) for label, values in FORMATS.items()}
            frames, ratios = in_turn(renderer, scene, camera, choices, options.turns)
            for label in FORMATS:
                frame, exact = frames[label], frames["float32"]
                same = 100 * np.mean(frame.coverage == exact.coverage)
                print(
                    f"| {name} | {method} | {label} | {psnr(frame.color, exact.color):.1f} | {same:.2f} % "
                    f"| {ratios[label]:.2f} |",
                    flush=True,
                )


def memory(renderer: Renderer, options) -> None:
    surfels = sample_mesh(load(options.models / "armadillo.obj.gz"), resolution=512)
    print("\n| storage | bytes a surfel | seconds to pack a million |\n|---|---|---|")
    for storage in STORAGES.values():
        arrays, _ = storage.pack(surfels)
        seconds = median_seconds(lambda storage=storage: storage.pack(surfels), options.turns) * 1e6 / len(surfels)
        size = sum(a.size / 4 * BYTES[f] for a, (_, f) in zip(arrays, storage.textures, strict=True))
        print(f"| {storage.name} | {size / len(surfels):.2f} | {seconds:.2f} |")
    torus, camera = scenes.torus(1000, (64, 64))
    print("\n| sums | bytes a sample, with depth and materials |\n|---|---|")
    for accumulation in ("float32", "float16"):
        plan = renderer.render(
            torus, camera, Settings(method="quad", supersampling=2, accumulation=accumulation)
        ).stats["plan"]
        drawn = [t for p in plan.passes if p.name in ("visibility", "attributes") for t in p.writes]
        print(f"| {accumulation} | {sum(BYTES[plan.format(t)] for t in drawn)} |")


def overdraw(renderer: Renderer, options) -> None:
    print("\n| layers | PSNR, dB | largest error, of 255 |\n|---|---|---|")
    camera = Camera.perspective(np.eye(4), math.radians(60), (12, 12), 0.01, 1000)
    for layers in (1, 10, 30, 100, 300, 1000, 2000, 5000):
        random = np.random.default_rng(1)
        centers = np.concatenate([random.normal(0, 0.02, (layers, 2)), -3 - 1e-3 * random.random((layers, 1))], axis=1)
        sun = Light("sun", energy=2.0, direction=(0.3, 0.2, -1.0))
        scene = Scene((discs(centers, (1.5, 0, 0), (0, 1.5, 0)),), (sun,), (0.1, 0.1, 0.1))
        whole, half = (
            renderer.render(scene, camera, Settings(method="quad", supersampling=2, accumulation=accumulation)).color
            for accumulation in ("float32", "float16")
        )
        print(f"| {layers} | {psnr(half, whole):.1f} | {255 * np.abs(half - whole).max():.2f} |", flush=True)


def multisampling(renderer: Renderer, options) -> None:
    names = ("checker_plane", "torus")
    print(f"\n| quads | {' | '.join(f'{n}, dB to a box | holes | time' for n in names)} |\n|{'---|' * 7}")
    columns = []
    for name in names:
        scene, camera = getattr(scenes, name)(size=(128, 128))
        exact = render_exact(scene, camera, samples=8)
        one = Settings(method="quad", supersampling=1)
        choices = {label: replace(one, **values) for label, values in MULTISAMPLED.items()}
        frames, ratios = in_turn(renderer, scene, camera, choices, options.turns)
        if name == "torus":
            save_details([frames[label].color for label in PICTURED], options.out)
        columns.append(
            [
                f"{psnr(f.color, exact.color):.1f} | {np.count_nonzero((exact.coverage > 0.999) & (f.coverage == 0))} "
                f"| {ratios[label]:.2f}"
                for label, f in frames.items()
            ]
        )
    for label, *cells in zip(MULTISAMPLED, *columns, strict=True):
        print(f"| {label} | {' | '.join(cells)} |")


def save_details(colors: list[np.ndarray], path: Path) -> None:
    """A piece of each picture, side by side, every pixel six wide."""
    pieces = [srgb(color[16:56, 8:48, :3])[::-1] for color in colors]
    strip = (np.concatenate(pieces, axis=1).clip(0, 1) * 255).astype(np.uint8)
    Image.fromarray(strip).resize((6 * strip.shape[1], 6 * strip.shape[0]), Image.Resampling.NEAREST).save(path)


PARTS = {"formats": formats, "memory": memory, "overdraw": overdraw, "multisampling": multisampling}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--models", type=Path, default=ROOT.parent / "shared" / "models")
    parser.add_argument("--size", type=int, default=256)
    parser.add_argument("--turns", type=int, default=7)
    parser.add_argument("--out", type=Path, default=ROOT / "docs" / "rendering" / "multisampling.png")
    parser.add_argument("--only", choices=PARTS, help="one of the tables")
    options = parser.parse_args()
    renderer = Renderer(open_device("standalone"))
    commit = subprocess.run(["git", "rev-parse", "--short", "HEAD"], cwd=ROOT, capture_output=True, text=True).stdout
    print(
        f"{renderer.device.renderer}, {platform.machine()}, {os.cpu_count()} cores, {datetime.date.today()}, {commit}"
    )
    for name, part in PARTS.items():
        if options.only in (None, name):
            part(renderer, options)


if __name__ == "__main__":
    main()
