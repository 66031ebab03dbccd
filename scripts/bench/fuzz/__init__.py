# SPDX-License-Identifier: GPL-3.0-or-later
"""Damaged files of every format that is read, and what became of them.

A file is made from a sound one by a few changes that know the format: numbers of directories and headers, rows and
tables with checksums made right again, or plain bytes; a file of blocks is also changed while a view reads it. Each is
read as the extension would read it, by a process that is watched, in at most 1 GB more than it has when it starts.

*Coarser* was drawn with coarser surfels and a sentence; *refused* ended in a sentence. The others are faults, of which
none is right: *unworded* is an exception without a sentence, *memory* asked for more than 1 GB, *not finite* is a
result that nobody checked, *hang* took more than 5 s of processor time, or a minute, *crash* ended the process. Files
that did are left beside this page.
"""

from __future__ import annotations

from bench.fuzz.formats import FORMATS
from bench.fuzz.watching import OUTCOMES, Fault, watched

QUICK = {"files": 40, "format": ["blocks", "surfels"]}


def arguments(parser) -> None:
    parser.add_argument("--format", nargs="+", choices=FORMATS, default=list(FORMATS), help="of the files")
    parser.add_argument("--files", type=int, default=20_000, help="of each format")
    parser.add_argument("--seed", type=int, default=0, help="the same seed makes the same files")
    parser.add_argument("--first", type=int, default=0, help="number of the first file, to see one again")


def run(options, report) -> None:
    report.header(how=f"{options.files:,} files a format, seed {options.seed}")
    columns = ["format", *OUTCOMES, "MB at most"]
    faults: list[Fault] = []
    report.table(columns, (row(name, options, report, faults) for name in options.format))
    for fault in faults[:50]:
        report.say(f"{fault.outcome}: file {fault.number:,} of {fault.format}: {fault.text}")
    if faults:
        raise SystemExit(1)


def row(name: str, options, report, faults: list[Fault]) -> list:
    """The number of files of a format by what became of them, and the memory of the process that read them."""
    counts, most = dict.fromkeys(OUTCOMES, 0), 0
    numbers = range(options.first, options.first + options.files)
    for found in report.progress.track(
        watched(name, options.seed, numbers, report.out), len(numbers), description=name
    ):
        counts[found.outcome] += 1
        most = max(most, found.megabytes)
        if found.is_fault:
            faults.append(found)
    return [name, *(f"{count:,}" for count in counts.values()), f"{most:,}"]
