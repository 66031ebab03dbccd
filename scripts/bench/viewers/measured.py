# SPDX-License-Identifier: GPL-3.0-or-later
"""Draws given points in a process of its own and leaves pictures, times and memory; needs numpy alone.

`in_this`, `in_blender`, `in_pyvista` and `in_open3d` call `leave` with a function that prepares a program's scene and
returns one that draws a view. They are run as `python FILE GIVEN MADE KIND`.
"""

from __future__ import annotations

import resource
import sys
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np

#: `ru_maxrss` is in bytes on macOS, and in KiB elsewhere.
_UNIT = 1 if sys.platform == "darwin" else 1024

Draw = Callable[[int], np.ndarray]


def leave(prepare: Callable[[dict[str, np.ndarray], str], Draw]) -> None:
    """Draw each view, then some again.

    prepare: from the arrays of GIVEN and KIND, a function of a view's number that returns its (h, w, 3) linear picture
        over the background, row 0 at the bottom.
    MADE holds pictures, (v, h, w, 3) float32; first, the seconds of the clock until the first of them is there; again,
    (t, 2) seconds of the clock and of the processor for each later one; bytes, by how much the process's peak memory
    has grown since its modules were loaded.
    """
    path, made, kind = sys.argv[1:]
    given = dict(np.load(path))
    before, clock = _peak(), time.perf_counter()
    draw = prepare(given, kind)
    pictures = [draw(0)]
    first = time.perf_counter() - clock
    pictures += [draw(k) for k in range(1, len(given["cameras"]))]
    again = []
    for turn in range(int(given["turns"])):
        start = time.perf_counter(), time.process_time()
        draw(turn % len(pictures))
        again.append((time.perf_counter() - start[0], time.process_time() - start[1]))
    np.savez(made, pictures=np.array(pictures, np.float32), first=first, again=np.array(again), bytes=_peak() - before)


def _peak() -> int:
    """Bytes. On Linux not by `resource`, which counts the memory of the process that started this one, too."""
    status = Path("/proc/self/status")
    if not status.exists():
        return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * _UNIT
    (line,) = (line for line in status.read_text().splitlines() if line.startswith("VmHWM:"))
    return int(line.split()[1]) * 1024


def encoded(linear: np.ndarray) -> np.ndarray:
    """uint8 sRGB of linear values."""
    linear = np.clip(linear, 0, 1)
    values = np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)
    return np.rint(255 * values).astype(np.uint8)


def decoded(values: np.ndarray) -> np.ndarray:
    """Linear float32 of uint8 sRGB."""
    values = values.astype(np.float32) / 255
    return np.where(values <= 0.04045, values / 12.92, ((values + 0.055) / 1.055) ** 2.4)
