# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs a command that takes minutes and shows progress in plain lines, since nothing is installed yet."""

from __future__ import annotations

import os
import subprocess
import threading
import time
from typing import Callable

#: Seconds between two progress lines.
PATIENCE = 15


def run_showing(command: list[str], pick: Callable[[str], str | None]) -> tuple[int, str]:
    """Exit code and output (stdout and stderr interleaved) of a command.

    pick: turns a line of output into the line to show, or None to show nothing.
    """
    started, shown, is_over = time.monotonic(), ["Starting"], threading.Event()

    def show(text: str) -> None:
        print(f"  [{time.monotonic() - started:4.0f} s] {text}", flush=True)

    def reassure() -> None:
        while not is_over.wait(PATIENCE):
            show(f"still {shown[-1][:1].lower()}{shown[-1][1:]}")

    output = {"stdout": subprocess.PIPE, "stderr": subprocess.STDOUT, "encoding": "utf-8", "errors": "replace"}
    environment, lines = {**os.environ, "PYTHONUNBUFFERED": "1"}, []
    process = subprocess.Popen(command, stdin=subprocess.DEVNULL, env=environment, **output)
    threading.Thread(target=reassure, daemon=True).start()
    try:
        for line in process.stdout:
            lines.append(line)
            if pick(line):
                shown.append(pick(line))
                show(shown[-1])
        return process.wait(), "".join(lines)
    finally:
        is_over.set()
        if process.poll() is None:
            process.kill()
