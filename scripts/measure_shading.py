# SPDX-License-Identifier: GPL-3.0-or-later
"""What shading costs against overdraw; with a contact sheet of the models. What each costs: measure_features.py.

    PYTHON scripts/measure_shading.py [--size 256] [--rounds 15] [--picture PNG]

PYTHON is the environment that scripts/test.py makes. Standalone device; milliseconds are wall time of a pass, the
device waited for after each; all cases are timed in turns, of each the median is kept, and ratios are printed.
"""

from __future__ import annotations

import argparse
import math
import os
import platform
import statistics
import sys
from dataclasses import replace
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT))

import numpy as np  # noqa: E402

from scripts.costs.shots import ball  # noqa: E402
from splat_addon.reference import scenes  # noqa: E402
from splat_addon.rendering import (  # noqa: E402
    Camera,
    Light,
    Lines,
    Renderer,
    Scene,
    Settings,
    look_at,
    open_device,
)
from splat_addon.rendering.shading_models import SHADING_MODELS  # noqa: E402
from splat_addon.surfels import Surfels  # noqa: E402

OVERDRAWS = (1, 2, 4, 8, 16, 32, 64)
SIDE = 64


def board(overdraw: int) -> Scene:
    """A square of SIDE x SIDE discs of which so many lie over a place, under two lights."""
    axis = (np.arange(SIDE) + 0.5) * 2 / SIDE - 1
    x, y = (a.ravel() for a in np.meshgrid(axis, axis))
    count = len(x)
    surfels = Surfels(
        positions=np.stack([x, y, 0 * x], axis=1),
        rotations=np.tile((1.0, 0.0, 0.0, 0.0), (count, 1)),
        scales=np.full((count, 2), 2 / SIDE * math.sqrt(overdraw / math.pi)),
        normals=np.tile((0.0, 0.0, 1.0), (count, 1)),
        colors=np.ones((count, 4)),
        materials=np.zeros(count, np.int32),
    )
    lights = Light("sun", energy=2.0, direction=(1, 0, -1)), Light("point", energy=30.0, position=(0, 1, 2))
    return Scene([surfels], lights)


def medians(renderer, cases: dict, rounds: int) -> dict:
    """case -> pass -> median milliseconds. cases: name -> scene, camera, settings."""
    times = {name: [] for name in cases}
    for round_number in range(rounds + 1):
        for name, (scene, camera, settings) in cases.items():
            taken = renderer.render(scene, camera, replace(settings, profile=True)).stats["passes"]
            if round_number:  # the first compiles
                times[name].append(taken)
    return {name: {p: statistics.median(t[p] for t in taken) for p in taken[0]} for name, taken in times.items()}


def print_overdraw(renderer, size: int, rounds: int) -> None:
    camera = Camera.orthographic(look_at((0, 0, 5), (0, 1e-3, 0)), 2.0, (size, size), near=0.1, far=10)
    cases = {n: (board(n), camera, Settings(method="quad", supersampling=1)) for n in OVERDRAWS}
    taken = medians(renderer, cases, rounds)
    print("| overdraw | attribute pass | shading pass |\n|---|---|---|")
    for n in OVERDRAWS:
        attributes, shading = (taken[n][p] / taken[1][p] for p in ("attributes", "shading"))
        print(f"| {n} | {attributes:.2f} | {shading:.2f} |")


def draw_sheet(renderer, path: Path) -> None:
    """Every model on the two tori, and two with lines."""
    from PIL import Image

    scene, camera = scenes.torus(size=(150, 112))
    plain = Settings(method="mip", supersampling=2, matcap=ball())
    shown = [replace(plain, shading=name) for name in SHADING_MODELS]
    shown += [replace(plain, shading=name, lines=Lines(width=1.5)) for name in ("toon", "flat", "normals")]
    pictures = [np.clip(renderer.render(scene, camera, s).color[::-1, :, :3], 0, 1) for s in shown]
    rows = [np.concatenate(pictures[i : i + 4], axis=1) for i in range(0, len(pictures), 4)]
    encoded = np.concatenate(rows) ** (1 / 2.2)
    Image.fromarray((encoded * 255 + 0.5).astype(np.uint8)).save(path, optimize=True)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--size", type=int, default=256)
    parser.add_argument("--rounds", type=int, default=15)
    parser.add_argument("--picture", type=Path)
    chosen = parser.parse_args()
    renderer = Renderer(open_device("standalone"))
    if chosen.picture:
        draw_sheet(renderer, chosen.picture)
    print(f"{renderer.device.renderer}, {os.cpu_count()} cores, {platform.system()}; {chosen.rounds} rounds\n")
    print_overdraw(renderer, chosen.size, chosen.rounds)


if __name__ == "__main__":
    main()
