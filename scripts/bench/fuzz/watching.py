# SPDX-License-Identifier: GPL-3.0-or-later
"""Lets another process read damaged files, and begins another one where that hangs or dies."""

from __future__ import annotations

import json
import signal
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from queue import Empty, Queue
from threading import Thread
from typing import NamedTuple

from environment.module import module_process

#: What can become of a file; those from "unworded" on are faults.
OUTCOMES = ("read", "coarser", "refused", "unworded", "memory", "not finite", "hang", "crash")
#: The signal that ends a process which takes too long; Windows has none, and only silence tells.
_SLOW = getattr(signal, "SIGPROF", 0)
#: Seconds after which a process that says nothing is ended.
_SILENCE = 60


class Fault(NamedTuple):
    """What became of a file, which need not be a fault. text: what was said. megabytes: resident so far."""

    format: str
    number: int
    outcome: str
    text: str
    megabytes: int

    @property
    def is_fault(self) -> bool:
        return OUTCOMES.index(self.outcome) >= OUTCOMES.index("unworded")


def watched(name: str, seed: int, numbers: range, folder: Path) -> Iterator[Fault]:
    """What became of each file of a format. folder: where files of faults are left."""
    first, megabytes = numbers.start, 0
    while first < numbers.stop:
        for found in _process(name, seed, range(first, numbers.stop), folder):
            first, megabytes = found.number + 1, found.megabytes or megabytes
            yield found._replace(megabytes=megabytes)


def _process(name: str, seed: int, numbers: range, folder: Path) -> Iterator[Fault]:
    """What one process found, until it is done or ended."""
    order = [name, seed, numbers.start, numbers.stop, folder]
    process = subprocess.Popen(
        **module_process(sys.executable, "bench.fuzz.reading", *order),
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    lines: Queue[str | None] = Queue()
    Thread(target=_hand_on, args=(process.stdout, lines), daemon=True).start()
    errors: list[str] = []
    Thread(target=lambda: errors.extend(process.stderr), daemon=True).start()
    next_one = numbers.start
    try:
        while next_one < numbers.stop:
            line = lines.get(timeout=_SILENCE)
            if line is None:
                code = process.wait()
                said = "".join(errors[-12:]).strip()
                is_slow = bool(_SLOW) and code == -_SLOW
                outcome, text = ("hang", "5 s of processor time") if is_slow else ("crash", f"exit code {code}; {said}")
                yield Fault(name, next_one, outcome, text, 0)
                return
            number, outcome, text, megabytes = json.loads(line)
            yield Fault(name, number, outcome, text, megabytes)
            next_one = number + 1
    except Empty:
        yield Fault(name, next_one, "hang", f"{_SILENCE} s", 0)
    finally:
        process.kill()
        process.wait()


def _hand_on(stream, lines: Queue[str | None]) -> None:
    for line in stream:
        lines.put(line)
    lines.put(None)
