# SPDX-License-Identifier: GPL-3.0-or-later
"""What each feature costs where it is present: a picture with it and the same one without, turn by turn.

    PYTHON scripts/measure_features.py [--device standalone|blender] [--quick] [--out DIR] [--only NAME ...] [--turns N]

PYTHON is the environment that scripts/test.py makes. Leaves costs.csv and costs.md in DIR: docs/costs.md is one.
"""

from __future__ import annotations

import argparse
import csv
import sys
from pathlib import Path

from environment import ROOT, Problem, exit_with_problems

sys.path.insert(0, str(ROOT))

from costs.features import FEATURES, Feature
from costs.measurement import COLUMNS, measure
from costs.shots import plain
from inside_a_render import run_on
from leaving import run_and_leave
from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn, TimeRemainingColumn
from trade.report import header, table

from splat_addon.rendering import open_device

PAGE = """\
# What each feature costs

Made by `scripts/measure_features.py`, not by hand: a picture with the feature beside the same one without. *Time*
is the median ratio of both in one turn (least and most); *more* is what comes to the frame without, and what the
plan adds: passes and what shaders do, textures and tables that are read, with a minus where something goes, and the
MiB of textures that passes write. What a scene does not have costs nothing: no pass, no texture and no line of a
shader is there for it (`tests/rendering/test_plan_table.py`).

{how}

`{command}`

{table}
"""


def parse(arguments: list[str]) -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--device", choices=("standalone", "blender"), default="standalone")
    parser.add_argument("--quick", action="store_true", help="the most used ones in smaller pictures, in a minute")
    parser.add_argument("--out", type=Path, default=ROOT / "build" / "costs")
    parser.add_argument("--only", nargs="+", metavar="NAME", help="features whose name or group has one of these words")
    parser.add_argument("--turns", type=int, help="pairs of pictures that are counted")
    parser.add_argument("--size", type=int, help="pixels along each side")
    return parser.parse_args(arguments)


def wanted(options: argparse.Namespace) -> list[Feature]:
    """Raises Problem where there is none."""
    chosen = [f for f in FEATURES if f.is_quick or not options.quick]
    if options.only:
        chosen = [f for f in FEATURES if any(word in f"{f.group} {f.name}" for word in options.only)]
    if not chosen:
        groups = ", ".join(dict.fromkeys(f.group for f in FEATURES))
        raise Problem(f"No feature's name or group has {' or '.join(options.only)} in it; the groups are {groups}.", 2)
    return chosen


def run(options: argparse.Namespace) -> None:
    """Measures and writes; the files are whole up to the last feature that was measured."""
    features = wanted(options)
    size = options.size or (128 if options.quick else 256)
    turns, count = options.turns or (3 if options.quick else 15), 10_000 if options.quick else 40_000
    device = open_device(options.device)
    shot = plain(count, (size, size))
    features = [f for f in features if f.present(shot).settings.multisampling in (0, *device.multisample_counts)]
    how = f"{size} x {size} pixels, {count:,} splats, medians of {turns} turns"
    head, rows = header(device, how), []
    columns = TextColumn("{task.description}"), BarColumn(), TimeElapsedColumn(), TimeRemainingColumn()
    with Progress(*columns) as progress:
        task = progress.add_task("", total=len(features) * 2 * (turns + 1))
        for feature in features:
            progress.update(task, description=feature.name)
            rows.append(measure(feature, shot, device, turns, lambda: progress.advance(task)))
            write(rows, head, options.out)
    print((options.out / "costs.md").read_text(encoding="utf-8"))


def write(rows: list[dict], head: str, folder: Path) -> None:
    with (folder / "costs.csv").open("w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, COLUMNS)
        writer.writeheader()
        writer.writerows(rows)
    names = ["feature", "beside", "time", "ms more", "passes, shaders", "textures, tables", "MiB more"]
    command = " ".join(["PYTHON", "scripts/measure_features.py", *sys.argv[1:]])
    text = PAGE.format(how=head, command=command, table=table(names, [cells(row) for row in rows]))
    (folder / "costs.md").write_text(text, encoding="utf-8")


def cells(row: dict) -> list[str]:
    """A row of the table for readers."""
    time = f"{row['ratio']:.2f} ({row['ratio_min']:.2f} to {row['ratio_max']:.2f})"
    more = f"{row['ms_more']:.1f} on {row['ms']:.1f}"
    space = f"{row['bytes'] / 2**20:.2f}" if row["bytes"] else ""
    return [row["feature"], row["beside"], time, more, row["passes"], row["textures"], space]


@exit_with_problems
def main(arguments: list[str]) -> int:
    """Exit code 0, or 1 or 2 after one sentence."""
    options = parse(arguments)
    options.out.mkdir(parents=True, exist_ok=True)
    run_on(options.device, lambda: run(options))
    return 0


if __name__ == "__main__":
    run_and_leave(lambda: main(sys.argv[1:]))
