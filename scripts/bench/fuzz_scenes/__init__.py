# SPDX-License-Identifier: GPL-3.0-or-later
"""Random scenes of extreme numbers, and what becomes of them: crashes, hangs, faults, pixels that are not finite.

A case is one scene: materials, worlds and lights of random nodes, meshes with random modifiers, surfels whose
attributes somebody edited, five cameras and random settings. It is exported with each camera, and for a part of the
cases drawn at 8 x 8 pixels and converted. Watched processes do that: one that ends or hangs is started again after the
case. A case is the same each time it is made: `--first N --cases 1` repeats one.

A hang is a step of the extension that takes more than five seconds of processor time. What ends or hangs while Blender
itself makes or evaluates a scene is counted apart. Needs Linux or macOS for the limit on memory.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import threading
from collections import Counter
from collections.abc import Iterator

from environment.module import module_process

QUICK = {"cases": 3, "every": 3}

#: Processor seconds of a step that count as a hang.
SLOW = 5.0

#: Seconds after which a case is ended, on a machine that does other things too.
HANG = 60

#: Steps of the extension; the others are Blender's own.
OURS = ("export", "draw", "convert")


def arguments(parser) -> None:
    parser.add_argument("--first", type=int, default=0, help="the first case")
    parser.add_argument("--cases", type=int, default=1000)
    parser.add_argument("--every", type=int, default=10, help="of so many cases, one is drawn and converted")


def run(options, report) -> None:
    report.header(how="one process at a time, watched")
    log, made = options.out / "stderr.txt", Counter()
    wrong: dict[str, list[str]] = {"crashes": [], "hangs": [], "faults": [], "not finite": [], "Blender's own": []}
    for record in watched(options, log):
        if "held" not in record:
            how, step, case = record["how"], record["step"], record["case"]
            wrong[how if step in OURS else "Blender's own"].append(f"{case} ({step}, {how})")
            continue
        made += Counter(record["held"]) + Counter(cases=1, pictures=record["pictures"])
        case = record["case"]
        wrong["hangs"] += [f"{case} ({step})" for step in OURS if record["seconds"].get(step, 0) > SLOW]
        wrong["faults"] += [f"{case}: {sentence}" for sentence in record["unworded"]]
        wrong["not finite"] += [f"{case} ({record['not_finite']} numbers)"] * bool(record["not_finite"])
    report.table(["made", "number"], [[name, f"{count:,}"] for name, count in sorted(made.items())])
    report.table(["what went wrong", "number", "the first"], [[k, len(v), "; ".join(v[:3])] for k, v in wrong.items()])
    if bad := [name for name, found in wrong.items() if found and name != "Blender's own"]:
        raise RuntimeError(f"There were {', '.join(bad)}; {log} has the tracebacks.")


def watched(options, log) -> Iterator[dict]:
    """The record of each case; of one that did not end, a record of its last step, and how it ended."""
    first, last = options.first, options.first + options.cases
    with log.open("w", encoding="utf-8") as errors:
        while first < last:
            step = {}
            for record in _lines(first, last - first, options.every, errors):
                if "held" in record:
                    yield record
                    first = record["case"] + 1
                step = record
            if first < last:
                ended = {"how": "crashes", "step": "start", "case": first, **({} if "held" in step else step)}
                yield ended
                first = ended["case"] + 1


def _lines(first: int, count: int, every: int, errors) -> Iterator[dict]:
    """The records of a process, until it ends or hangs."""
    one_thread = {"LP_NUM_THREADS": "0", "OPENBLAS_NUM_THREADS": "1"}
    started = module_process(sys.executable, "bench.fuzz_scenes.worker", first, count, every)
    started["env"] |= {name: os.environ.get(name, value) for name, value in one_thread.items()}
    worker = subprocess.Popen(**started, stdout=subprocess.PIPE, stderr=errors, text=True)
    step, is_late = {}, False

    def end() -> None:
        nonlocal is_late
        is_late = True
        worker.kill()

    while True:
        # the process ends itself before, with the stack of its hang, unless Python does not run
        timer = threading.Timer(2 * HANG, end)
        timer.start()
        line = worker.stdout.readline()
        timer.cancel()
        if not line:
            break
        step = json.loads(line)
        yield step
    if worker.wait() == HUNG or is_late:
        yield {**step, "how": "hangs"} if "held" not in step else step


#: The exit code of a process that faulthandler ends.
HUNG = 1
