# SPDX-License-Identifier: GPL-3.0-or-later
"""The trade of speed for accuracy: scenes x methods x settings, each compared with an exact picture.

Parts: `methods`, samples and formats beside float64 rays; `numbers` (tolerance of levels, shadow resolution, layers,
storage, sums), each changed alone; `densities` and reductions beside the mesh; `stability`, how much pictures flicker;
`passes`, where the time goes; `promises`, how well targets are kept. PSNR is measured in sRGB; the pixel filters are
the Gaussian of sigma 0.7071 pixels and the box. A time is the median of ratios: the processor time of a frame, divided
by that of the yardstick, drawn just before. After the sign ±: half of the turns are as near. `to_float32`: PSNR
relative to the same choice without 16-bit formats.

Rows are kept in rows.json after each scene: `--resume` goes on with those of the same sources and options. `--pages`
writes the tables into the pages of docs, and the plots beside them. A quick run draws one scene of each part, small.
"""

from __future__ import annotations

from time import perf_counter, process_time

from bench.trade import densities, methods, numbers, passes, promises, stability
from bench.trade.cases import CASES
from bench.trade.choices import CHOICES
from bench.trade.kept import Kept
from environment import ROOT, Problem
from measuring.pages import check, fill
from measuring.report import Table
from splat_addon.rendering import Renderer, open_device

DEVICES = ("standalone", "blender")
QUICK = {"size": 32, "turns": 2, "samples": 3, "seconds": 0.0, "choices": "methods"}

#: Each has `units`, name -> what measures rows, and `made`, the tables of all rows; one has `plots`.
PARTS = {
    "methods": methods,
    "numbers": numbers,
    "densities": densities,
    "stability": stability,
    "passes": passes,
    "promises": promises,
}


def arguments(parser) -> None:
    parser.add_argument("--parts", nargs="+", choices=PARTS, default=list(PARTS), help="what to measure")
    parser.add_argument("--scenes", nargs="+", choices=CASES, metavar="NAME", help=f"some of: {', '.join(CASES)}")
    parser.add_argument("--choices", choices=CHOICES, default="page", help="the settings that each is drawn with")
    parser.add_argument("--size", type=int, default=96, help="pixels along each side; splats keep theirs")
    parser.add_argument("--samples", type=int, default=8, help="N of the truth's N x N samples a pixel; of no choice")
    parser.add_argument("--seconds", type=float, default=2.0, help="of a choice, after at least 3 turns")
    parser.add_argument("--resume", action="store_true", help="go on with the rows of an interrupted run")
    parser.add_argument("--pages", action="store_true", help="write tables and plots into docs; needs all parts")
    parser.set_defaults(turns=7)


def run(options, report) -> None:
    if options.pages and (options.quick or options.scenes or set(options.parts) != set(PARTS)):
        raise Problem("--pages writes whole runs into the docs: leave out --quick, --scenes and --parts.")
    if options.pages:
        check(ROOT / "docs", {"run", *(name for part in PARTS.values() for name in part.made([]))})
        report.pictures = ROOT / "docs" / "trade"
    renderer = Renderer(open_device(options.device))
    kept = Kept(options.out / "rows.json", _of(options), _device(renderer), options.resume)
    how = f"at most {options.turns} turns in pairs, truth of {options.samples} x {options.samples} samples"
    report.header(renderer.device, f"{options.size} x {options.size} pixels, {how}")
    pages = {"run": _said(kept.run, options, report)}
    for name in options.parts:
        pages |= run_part(name, renderer, options, report, kept)
    if options.pages:
        texts = {name: each.text if isinstance(each, Table) else each for name, each in pages.items()}
        for page in fill(ROOT / "docs", texts):
            report.say(f"Wrote {page.relative_to(ROOT)}")
        densities.write(options, kept.of_part("densities"))


def run_part(name: str, renderer: Renderer, options, report, kept: Kept) -> dict[str, Table | str]:
    """Measure a part and write its tables and plots; returns what the pages say of it. Raises Problem if nothing could
    be measured."""
    part, begun, worked = PARTS[name], perf_counter(), process_time()
    rows, skipped = [], {}
    for unit, measure in part.units(renderer, options, report).items():
        try:
            rows += kept.measured(f"{name}/{unit}", measure)
        except FileNotFoundError as error:
            skipped[unit] = str(error)
            report.say(f"**Skipped: {unit}**. {error}.")
        print(f"{name}, {unit}: {perf_counter() - begun:.0f} s", flush=True)
    if not rows or (skipped and options.pages):
        raise Problem(f"{'Not all' if rows else 'Nothing'} was measured. {'; '.join(skipped.values())}.")
    columns = dict.fromkeys(key for row in rows for key in row)
    report.csv(name, [{key: row.get(key, "") for key in columns} for row in rows])
    made = part.made(rows)
    for table in made.values():
        if isinstance(table, Table) and table.lines:
            report.table(table.columns, table.lines, table.about)
    if hasattr(part, "plots"):
        part.plots(renderer, options, rows, report)
    taken = f"{perf_counter() - begun:.0f} s, {process_time() - worked:.0f} s of processor time"
    report.say(f"{name}: {taken}.")
    return made


def _of(options) -> dict:
    names = "size", "samples", "turns", "seconds", "choices", "quick", "device"
    return {name: getattr(options, name) for name in names}


def _device(renderer: Renderer) -> str:
    return renderer.device.renderer.split(" (")[0]


def _said(run: dict, options, report) -> str:
    command = report.command.replace(" --resume", "")
    how = f"{options.size} x {options.size} pixels", run["machine"], f"{run['date']}, commit {run['commit']}"
    return f"`{command}` ({'; '.join(how)})"
