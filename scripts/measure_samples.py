# SPDX-License-Identifier: GPL-3.0-or-later
"""How fast samples converge to filtered pixels, and what they cost: the table in docs/features.md.

    PYTHON scripts/measure_samples.py [--size 64] [--turns 3]

PYTHON is the environment that scripts/test.py makes. PSNR is of sRGB, from `render_exact` with 16 x 16 rays a pixel;
times are ratios to one sample of the same method, in turn, medians.
"""

from __future__ import annotations

import argparse
import statistics
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT))

from splat_addon.reference import render_exact, scenes  # noqa: E402
from splat_addon.reference.metrics import psnr  # noqa: E402
from splat_addon.rendering import Renderer, Settings, open_device  # noqa: E402

COUNTS = (1, 4, 16, 64, 256)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--size", type=int, default=64)
    parser.add_argument("--turns", type=int, default=3)
    arguments = parser.parse_args()
    renderer = Renderer(open_device("standalone"))
    print(f"{renderer.device.renderer}\n\n| scene | method | filter | {' | '.join(map(str, COUNTS))} |")
    print(f"|---|---|---|{'---|' * len(COUNTS)}")
    times = {}
    for name in ("checker_plane", "torus"):
        scene, camera = getattr(scenes, name)(count=10_000, size=(arguments.size, arguments.size))
        truths = {f: render_exact(scene, camera, samples=16, pixel_filter=f).color for f in ("box", "gaussian")}
        for method in ("quad", "mip"):
            pictures = []
            for count in COUNTS:
                settings = Settings(method=method, samples=count, outputs=("color",))
                turns = arguments.turns if count <= 16 else 1
                frames = [renderer.render(scene, camera, settings) for _ in range(turns)]
                pictures.append(frames[-1].color)
                elapsed = statistics.median(frame.stats["milliseconds"] for frame in frames)
                times.setdefault((method, count), []).append(elapsed)
            for filter_name, truth in truths.items():
                cells = " | ".join(f"{psnr(picture, truth):.1f}" for picture in pictures)
                print(f"| {name} | {method} | {filter_name} | {cells} |", flush=True)
    for method in ("quad", "mip"):
        first = times[method, 1]
        ratios = (statistics.mean(a / b for a, b in zip(times[method, c], first, strict=True)) for c in COUNTS)
        print(f"| time | {method} | | {' | '.join(f'{ratio:.1f} x' for ratio in ratios)} |")


if __name__ == "__main__":
    main()
