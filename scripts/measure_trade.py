# SPDX-License-Identifier: GPL-3.0-or-later
"""The second half of measure.py, in a Python with moderngl, Blender's wheel and matplotlib.

    PYTHON scripts/measure_trade.py [--device standalone|blender] [--quick] [--out DIR] [--scenes NAME ...] [--turns N]

PSNR is of sRGB values; the pixel filters are the Gaussian of sigma 0.7071 px and the box. A quick run draws the
promised scenes at half the size with a quarter of the splats, fewer turns and a coarser truth.
"""

from __future__ import annotations

import argparse
import sys
from dataclasses import dataclass, replace
from pathlib import Path

from environment import ROOT, Problem, exit_with_problems

sys.path.insert(0, str(ROOT))

from inside_a_render import run_on
from leaving import run_and_leave
from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn, TimeRemainingColumn
from trade.cases import CASES, FULL, Case, View
from trade.choices import PICTURED, YARDSTICK, choices
from trade.measurement import measure
from trade.pictures import save_differences
from trade.plots import plot_overview, plot_scene
from trade.report import header, write_csv, write_markdown
from trade.truth import exact_frames

from splat_addon.rendering import Renderer, open_device


@dataclass(frozen=True)
class Effort:
    """size: pixels along each side. turns: counted ones. samples: N of the truth's N x N; those of no choice, which
    would then be measured against itself."""

    size: int
    turns: int
    samples: int


FULL_EFFORT, QUICK_EFFORT = Effort(FULL, 5, 8), Effort(FULL // 2, 2, 5)


def parse(arguments: list[str]) -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="measure.py", description=__doc__.split("\n")[0])
    parser.add_argument("--device", choices=("standalone", "blender"), default="standalone")
    parser.add_argument("--quick", action="store_true", help="the promised scenes at half the size, in 1.5 minutes")
    parser.add_argument("--out", type=Path, default=ROOT / "build" / "trade")
    parser.add_argument("--models", type=Path, default=ROOT.parent / "shared" / "models", help="folder of test models")
    parser.add_argument("--scenes", nargs="+", choices=CASES, metavar="NAME", help=f"some of: {', '.join(CASES)}")
    parser.add_argument("--turns", type=int, help="frames of each choice that are counted")
    parser.add_argument("--size", type=int, help="pixels along each side; splats keep their size in pixels")
    parser.add_argument("--samples", type=int, help="N of the truth's N x N samples a pixel")
    return parser.parse_args(arguments)


def effort(options: argparse.Namespace) -> Effort:
    """What was asked for, else what is usual."""
    usual = QUICK_EFFORT if options.quick else FULL_EFFORT
    return Effort(options.size or usual.size, options.turns or usual.turns, options.samples or usual.samples)


def run(options: argparse.Namespace) -> None:
    """Measures and writes; the files are whole up to the last scene that was measured."""
    plan = effort(options)
    names = options.scenes or [c.name for c in CASES.values() if c.is_promised or not options.quick]
    renderer = Renderer(open_device(options.device))
    chosen = choices(options.quick, renderer.device.multisample_counts)
    size, turns, samples = plan.size, plan.turns, plan.samples
    how = f"{size} x {size} pixels, medians of {turns} turns, truth of {samples} x {samples} samples"
    head = header(renderer.device, how)
    print(head, flush=True)
    rows, skipped = [], {}
    with progress_bar() as progress:
        task = progress.add_task("", total=len(names) * len(chosen) * (plan.turns + 1))
        for name in names:
            progress.update(task, description=name)
            try:
                mine = measure_case(CASES[name], renderer, plan, chosen, options, lambda: progress.advance(task))
            except FileNotFoundError as error:
                skipped[name] = str(error)
                line = f"SKIPPED {name}: {error}; name the folder of models with --models."
                progress.console.print(line, style="bold red", soft_wrap=True)
                progress.advance(task, len(chosen) * (plan.turns + 1))
                continue
            rows += mine
            write_csv(rows, options.out / "trade.csv")
            write_markdown(rows, chosen, head, skipped, options.out / "trade.md")
            plot_overview(rows, options.out / "overview.png")
    if not rows:
        raise Problem(f"Nothing was measured: {'; '.join(skipped.values())}.")
    write_markdown(rows, chosen, head, skipped, options.out / "trade.md")
    print((options.out / "trade.md").read_text(encoding="utf-8"))


def measure_case(case: Case, renderer: Renderer, plan: Effort, chosen, options, advance) -> list[dict]:
    """The rows of one scene, whose plot and pictures are left in the folder."""
    scene, camera = case.build(View(plan.size, options.models))
    lit = replace(YARDSTICK, shading=case.shading)
    exact = exact_frames(scene, camera, lit, plan.samples, options.out / "truth")

    def draw(settings):
        return renderer.render(scene, camera, replace(settings, shading=case.shading))

    rows, frames = measure(case.name, draw, chosen, plan.turns, exact, advance)
    stem = case.name.replace(" ", "-")
    plot_scene(rows, options.out / f"{stem}.png")
    pictured = {settings: frame for settings, frame in frames.items() if settings in PICTURED}
    save_differences(pictured, exact["gaussian"], options.out / f"{stem}-differences.png")
    return rows


def progress_bar() -> Progress:
    return Progress(TextColumn("{task.description}"), BarColumn(), TimeElapsedColumn(), TimeRemainingColumn())


@exit_with_problems
def main(arguments: list[str]) -> int:
    """Exit code 0, or 1 after one sentence."""
    options = parse(arguments)
    options.out.mkdir(parents=True, exist_ok=True)
    run_on(options.device, lambda: run(options))
    return 0


if __name__ == "__main__":
    run_and_leave(lambda: main(sys.argv[1:]))
