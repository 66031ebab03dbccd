# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs everything that `registry` lists, one after another, and tells what each took. Needs no environment."""

from __future__ import annotations

import os
import subprocess
from pathlib import Path
from time import perf_counter

from environment.module import module_process
from measuring.registry import modules


def run_every(python: Path, arguments: list[str]) -> int:
    """Run each with these arguments; the failures do not end the others. Returns 1 if there were any, else 0."""
    failed, whole, begun = [], 0.0, perf_counter()
    for name in modules():
        first = _work()
        code = subprocess.run(**module_process(python, "measuring", name, *arguments)).returncode
        taken = _work() - first
        whole += taken
        failed += [name] if code else []
        print(f"\n=== {name}: {taken:.0f} s of processor time{', FAILED' if code else ''}\n", flush=True)
    said = f"; failed: {', '.join(failed)}" if failed else ""
    print(f"All: {whole:.0f} s of processor time in {perf_counter() - begun:.0f} s{said}")
    return 1 if failed else 0


def _work() -> float:
    """Processor seconds of all processes that have ended; 0 on Windows, which does not tell."""
    times = os.times()
    return times.children_user + times.children_system
