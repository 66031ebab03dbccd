# SPDX-License-Identifier: GPL-3.0-or-later
"""The trade of speed for accuracy: scenes x methods x samples, each against the float64 reference.

    PYTHON scripts/measure.py [--quick] [--rounds 5] [--out FOLDER]

PYTHON is the environment that scripts/test.py makes. Draws on the standalone device, the choices of a scene turn by
turn; writes trade.csv, trade.md and a plot for each scene. PSNR is of sRGB values, under the pixel's Gaussian (sigma
0.7071) and under a box, against 8 x 8 samples (4 x 4 with --quick).
"""

from __future__ import annotations

import argparse
import csv
import datetime
import os
import platform
import statistics
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT))

import matplotlib  # noqa: E402
import numpy as np  # noqa: E402
from rich.progress import Progress  # noqa: E402

from splat_addon.reference import render_exact, scenes  # noqa: E402
from splat_addon.reference.metrics import psnr  # noqa: E402
from splat_addon.rendering import Renderer, Settings, open_device  # noqa: E402
from splat_addon.rendering.methods import METHODS  # noqa: E402

matplotlib.use("Agg")
from matplotlib import pyplot  # noqa: E402

SIZE = (256, 256)
SCENES = {
    "checker": lambda: scenes.checker_plane(cells=40, count=40_000, elevation=6, size=SIZE),
    "torus": lambda: scenes.torus(60_000, size=SIZE),
    "sphere": lambda: scenes.sphere(2_000, size=SIZE),
    "sub-pixel sphere": lambda: scenes.sphere(300_000, size=SIZE),
}
#: What is unfiltered gains by samples; what is filtered is made for one.
CHOICES = [("quad", n) for n in (1, 2, 3, 4)] + [(name, n) for name in METHODS if name != "quad" for n in (1, 2)]
COLUMNS = ("scene", "method", "samples", "psnr_gaussian", "psnr_box", "ms", "ms_min", "ms_max", "holes")


def measure_scene(renderer, name, choices, rounds, samples, advance) -> list[dict]:
    """A row for every choice; frames are drawn turn by turn, the first turn is not counted."""
    scene, camera = SCENES[name]()
    exact = {f: render_exact(scene, camera, FLAT, samples=samples, pixel_filter=f) for f in ("gaussian", "box")}
    times = {choice: [] for choice in choices}
    frames = {}
    for turn in range(rounds + 1):
        for method, count in choices:
            settings = Settings(method=method, supersampling=count, shading="flat")
            frame = frames[method, count] = renderer.render(scene, camera, settings)
            if turn:
                times[method, count].append(frame.stats["milliseconds"])
            advance()
    return [
        {
            "scene": name,
            "method": method,
            "samples": f"{count} x {count}",
            "psnr_gaussian": round(psnr(frames[method, count].color, exact["gaussian"].color), 1),
            "psnr_box": round(psnr(frames[method, count].color, exact["box"].color), 1),
            "ms": round(statistics.median(times[method, count])),
            "ms_min": round(min(times[method, count])),
            "ms_max": round(max(times[method, count])),
            "holes": int(np.count_nonzero((exact["box"].coverage > 0.999) & (frames[method, count].coverage == 0))),
        }
        for method, count in choices
    ]


FLAT = Settings(shading="flat")


def plot(rows: list[dict], path: Path) -> None:
    """PSNR under the Gaussian against milliseconds, one scene."""
    figure, axes = pyplot.subplots(figsize=(6, 4), dpi=100)
    for method in METHODS:
        mine = [row for row in rows if row["method"] == method]
        axes.plot([r["ms"] for r in mine], [r["psnr_gaussian"] for r in mine], "o-", label=METHODS[method].label)
        for row in mine:
            axes.annotate(row["samples"][0], (row["ms"], row["psnr_gaussian"]), fontsize=7, xytext=(3, 3),
                          textcoords="offset points")  # fmt: skip
    axes.set(xlabel="ms a frame", ylabel="PSNR, dB (Gaussian pixel)", title=rows[0]["scene"], xscale="log")
    axes.legend(fontsize=8)
    axes.grid(alpha=0.3)
    figure.tight_layout()
    figure.savefig(path)
    pyplot.close(figure)


def header(device, rounds: int, samples: int) -> str:
    """Machine, date, commit and how it was measured."""
    git = ["git", "rev-parse", "--short", "HEAD"]
    commit = subprocess.run(git, cwd=ROOT, capture_output=True, text=True).stdout.strip()
    machine = f"{platform.machine()}, {os.cpu_count()} cores, {device.renderer}"
    how = f"{SIZE[0]} x {SIZE[1]}, medians of {rounds} turns, reference {samples} x {samples} samples"
    return f"{machine}; {datetime.date.today()}, commit {commit}; {how}"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--quick", action="store_true", help="fewer turns, a coarser reference, one filtered sample")
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--out", type=Path, default=ROOT / "build" / "trade")
    options = parser.parse_args()
    options.out.mkdir(parents=True, exist_ok=True)
    rounds, samples = (2, 4) if options.quick else (options.rounds, 8)
    choices = [c for c in CHOICES if not options.quick or c[0] == "quad" or c[1] == 1]
    renderer = Renderer(open_device("standalone"))
    rows = []
    with Progress() as progress:
        task = progress.add_task("Measuring", total=len(SCENES) * len(choices) * (rounds + 1))
        for name in SCENES:
            mine = measure_scene(renderer, name, choices, rounds, samples, lambda: progress.advance(task))
            plot(mine, options.out / f"{name.replace(' ', '-')}.png")
            rows += mine
    with (options.out / "trade.csv").open("w", newline="") as file:
        writer = csv.DictWriter(file, COLUMNS)
        writer.writeheader()
        writer.writerows(rows)
    lines = [header(renderer.device, rounds, samples), "", f"| {' | '.join(COLUMNS)} |", "|" + "---|" * len(COLUMNS)]
    lines += [f"| {' | '.join(str(row[c]) for c in COLUMNS)} |" for row in rows]
    (options.out / "trade.md").write_text("\n".join(lines) + "\n", encoding="utf-8")
    print("\n".join(lines))


if __name__ == "__main__":
    main()
