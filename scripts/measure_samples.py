# SPDX-License-Identifier: GPL-3.0-or-later
"""How fast samples converge, and what they cost: the tables in docs/features.md.

    PYTHON scripts/measure_samples.py [--size 64] [--turns 5] [--only smoothing|blur|panorama|time]

PYTHON is the environment that scripts/test.py makes. PSNR is of sRGB: of still pictures from `render_exact` with
16 x 16 rays a pixel, of blurred ones from the mean of 1024 samples, of panoramas from the means of 8 x 8 pixels of a
larger one by Quads. Times are ratios to one sample of the same method: all counts in turn, medians of the turns'
ratios.
"""

from __future__ import annotations

import argparse
import statistics
import sys
from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT))

from splat_addon.reference import render_exact, scenes  # noqa: E402
from splat_addon.reference.metrics import psnr  # noqa: E402
from splat_addon.rendering import (  # noqa: E402
    Equirectangular,
    Lens,
    Panorama,
    Renderer,
    Scene,
    Settings,
    look_at,
    open_device,
)
from splat_addon.rendering.accumulation import moment_places  # noqa: E402

COUNTS = (1, 4, 16, 64)
MANY = 1024
METHODS = ("quad", "mip")
#: Of the picture's height, how far a moving scene goes.
PATH = 0.1


def settings_of(method: str, count: int, shading: str = "flat") -> Settings:
    return Settings(method=method, shading=shading, samples=count, outputs=("color",))


def smoothing(renderer: Renderer, size: int, turns: int) -> None:
    """Still pictures, lit, against filtered pixels."""
    table("scene | method | filter", COUNTS)
    for name in ("checker_plane", "torus"):
        scene, camera = getattr(scenes, name)(count=10_000, size=(size, size))
        truths = {f: render_exact(scene, camera, samples=16, pixel_filter=f).color for f in ("box", "gaussian")}
        for method in METHODS:
            shots = [renderer.render(scene, camera, settings_of(method, c, "principled")).color for c in COUNTS]
            for kind, truth in truths.items():
                row(f"{name} | {method} | {kind}", [f"{psnr(shot, truth):.1f}" for shot in shots])


def blur(renderer: Renderer, size: int, turns: int) -> None:
    """Depth of field and motion blur, against as good as all samples."""
    table("what | method", COUNTS)
    scene, camera = scenes.checker_plane(count=10_000, size=(size, size))
    through = replace(camera, lens=Lens(0.02, float(np.linalg.norm(camera.matrix_world[:3, 3])), blades=6))
    for method in METHODS:
        truth, *shots = (renderer.render(scene, through, settings_of(method, c)).color for c in (MANY, *COUNTS))
        row(f"depth of field | {method}", [f"{psnr(shot, truth):.1f}" for shot in shots])
    scene, camera = scenes.torus(count=10_000, size=(size, size))
    for method in METHODS:
        truth, *shots = (moving(renderer, scene, camera, method, count) for count in (MANY, *COUNTS))
        row(f"motion blur | {method}", [f"{psnr(shot, truth):.1f}" for shot in shots])


def moving(renderer: Renderer, scene: Scene, camera, method: str, count: int) -> np.ndarray:
    """The picture while the scene moves along the picture, with a moment for each sample."""
    across = camera.matrix_world[:3, 0] * np.linalg.norm(camera.matrix_world[:3, 3])
    across *= PATH * (camera.window[3] - camera.window[2])

    def moments():
        for place in moment_places(count, count):
            moved = []
            for instance in scene.surfels:
                matrix = instance.matrix_world.copy()
                matrix[:3, 3] += (place - 0.5) * across
                moved.append(replace(instance, matrix_world=matrix))
            yield replace(scene, surfels=tuple(moved)), camera

    return renderer.render_moments(moments(), count, settings_of(method, count)).color


def panorama(renderer: Renderer, size: int, turns: int) -> None:
    """All around from within the torus scene, against a larger panorama."""
    table("what | method", COUNTS)
    scene, camera = scenes.torus(count=10_000, size=(size, size))
    turned = look_at((0.0, 0.0, 0.3), (1.0, 0.3, 0.2))
    for method in METHODS:
        camera = Panorama(turned, Equirectangular(), (2 * size, size), near=0.01)
        large = renderer.render(scene, replace(camera, size=(16 * size, 8 * size)), settings_of("quad", 1)).color
        truth = large.reshape(size, 8, 2 * size, 8, 4).mean(axis=(1, 3))
        shots = [renderer.render(scene, camera, settings_of(method, count)).color for count in COUNTS]
        row(f"panorama | {method}", [f"{psnr(shot, truth):.1f}" for shot in shots])


def time(renderer: Renderer, size: int, turns: int) -> None:
    """Milliseconds of rendering as ratios; four times the size, where a frame's fixed costs count less."""
    counts = COUNTS[:3]
    table("what | method", counts)
    scene, camera = scenes.torus(count=40_000, size=(4 * size, 4 * size))
    scene = replace(scene, lights=tuple(replace(light, casts_shadow=True) for light in scene.lights))
    for name, shadows in (("two lights", 0), ("with shadows", 512)):
        for method in METHODS:
            ratios = {count: [] for count in counts}
            for turn in range(turns + 1):
                took = {}
                for count in counts:
                    settings = replace(settings_of(method, count, "principled"), shadow_resolution=shadows)
                    took[count] = renderer.render(scene, camera, settings).stats["milliseconds"]
                if turn:  # the first compiles and uploads
                    for count in counts:
                        ratios[count].append(took[count] / took[1])
            row(f"time, {name} | {method}", [f"{statistics.median(ratios[count]):.1f}" for count in counts])


def table(head: str, counts: Iterable[int]) -> None:
    print(f"\n| {head} | {' | '.join(map(str, counts))} |")
    print(f"|{'---|' * (head.count('|') + 1 + len(tuple(counts)))}")


def row(head: str, cells: list[str]) -> None:
    print(f"| {head} | {' | '.join(cells)} |", flush=True)


TABLES = {"smoothing": smoothing, "blur": blur, "panorama": panorama, "time": time}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--size", type=int, default=64)
    parser.add_argument("--turns", type=int, default=5)
    parser.add_argument("--only", choices=TABLES)
    arguments = parser.parse_args()
    renderer = Renderer(open_device("standalone"))
    print(renderer.device.renderer)
    for name, measured in TABLES.items():
        if arguments.only in (None, name):
            measured(renderer, arguments.size, arguments.turns)


if __name__ == "__main__":
    main()
