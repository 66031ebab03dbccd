# SPDX-License-Identifier: GPL-3.0-or-later
"""27 transparent spheres, as in figure 6 of Guennebaud et al. 2006: the table and the picture in docs/features.md.

    PYTHON scripts/measure_transparency.py [--size 192] [--turns 5] [--picture FILE]

PYTHON is the environment that scripts/test.py makes. PSNR is of sRGB, from `render_exact`, which peels every layer that
a ray meets, with 4 x 4 rays a pixel under the method's own filter; times are ratios to the same spheres opaque, in
turn, medians.
"""

from __future__ import annotations

import argparse
import statistics
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT))

from splat_addon.reference import render_exact, scenes  # noqa: E402
from splat_addon.reference.metrics import psnr  # noqa: E402
from splat_addon.rendering import Renderer, Scene, Settings, open_device  # noqa: E402

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


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--size", type=int, default=192)
    parser.add_argument("--turns", type=int, default=5)
    parser.add_argument("--picture", type=Path, help="write the pictures of mip, and the exact one, side by side")
    arguments = parser.parse_args()
    renderer = Renderer(open_device("standalone"))
    scene, camera = scenes.transparent_spheres(size=(arguments.size, arguments.size))
    print(f"{renderer.device.renderer}\n\n| method | layers | PSNR | layers made | time |\n|---|---|---|---|---|")
    for method, (choices, pixel_filter) in METHODS.items():
        exact = render_exact(scene, camera, Settings(), samples=4, pixel_filter=pixel_filter).color
        made = {
            name: Settings(method=method, layers=layers, blends_rest=blends, outputs=("color",), **choices)
            for name, (layers, blends) in CHOICES.items()
        }
        frames = {name: [] for name in (*made, "opaque")}
        for _ in range(arguments.turns):
            frames["opaque"].append(renderer.render(opaque(scene), camera, made["6 layers"]))
            for name, settings in made.items():
                frames[name].append(renderer.render(scene, camera, settings))
        times = {name: statistics.median(f.stats["milliseconds"] for f in turns) for name, turns in frames.items()}
        for name in made:
            last = frames[name][-1]
            ratio = times[name] / times["opaque"]
            print(f"| {method} | {name} | {psnr(last.color, exact):.1f} | {last.stats['layers']} | {ratio:.1f} x |")
    if arguments.picture:
        shown = [
            frames[name][-1].color for name in ("6 layers", "3 layers, the rest lost", "3 layers, the rest blended")
        ]
        write_picture(arguments.picture, np.concatenate([exact, *shown], axis=1))


def opaque(scene: Scene) -> Scene:
    """The same surfels, and nothing shows through them."""
    made = {}
    for instance in scene.surfels:
        surfels = instance.surfels
        if surfels not in made:
            made[surfels] = replace(surfels, colors=surfels.colors * (1, 1, 1, 0) + (0, 0, 0, 1))
    return replace(scene, surfels=tuple(replace(i, surfels=made[i.surfels]) for i in scene.surfels))


def write_picture(path: Path, color: np.ndarray) -> None:
    """(h, w, 4) scene-linear, row 0 at the bottom, as an sRGB file."""
    from PIL import Image

    linear = np.clip(color[::-1, :, :3], 0, 1)
    encoded = np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)
    Image.fromarray((encoded * 255 + 0.5).astype(np.uint8)).save(path, optimize=True)


if __name__ == "__main__":
    main()
