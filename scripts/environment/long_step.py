# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs a command that takes minutes and shows that it lives: plain lines, since nothing is installed yet."""

from __future__ import annotations

import os
import queue
import subprocess
import threading
import time
from typing import Callable

#: Seconds of silence after which a sign of life is printed.
PATIENCE = 15


def run_showing(command: list[str], pick: Callable[[str], str | None]) -> tuple[int, str]:
    """Exit code and whole output (stdout and stderr as they came) of a command.

    pick: makes the line to show from a line of output; None leaves it out.
    """
    started = time.monotonic()
    process = subprocess.Popen(
        command,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        env={**os.environ, "PYTHONUNBUFFERED": "1"},
        text=True,
        encoding="utf-8",
        errors="replace",
    )
    lines: queue.Queue[str | None] = queue.Queue()
    threading.Thread(target=_forward, args=(process.stdout, lines), daemon=True).start()
    output = []
    doing = "starting"
    try:
        while True:
            try:
                line = lines.get(timeout=PATIENCE)
            except queue.Empty:
                _show(started, f"still {doing}")
                continue
            if line is None:
                return process.wait(), "".join(output)
            output.append(line)
            shown = pick(line)
            if shown:
                doing = shown[:1].lower() + shown[1:]
                _show(started, shown)
    finally:
        if process.poll() is None:
            process.kill()


def _forward(stream, lines: queue.Queue) -> None:
    for line in stream:
        lines.put(line)
    lines.put(None)


def _show(started: float, text: str) -> None:
    print(f"  [{time.monotonic() - started:4.0f} s] {text}", flush=True)
