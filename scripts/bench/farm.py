# SPDX-License-Identifier: GPL-3.0-or-later
"""Overhead of splitting an animation into chunks on a render farm, and what remains when workers are killed at random
moments.

The efficiency of four workers is simulated: each task's cost is measured in processor seconds, as a process of its own
that starts up and opens the file, and tasks go, in their order, to whichever worker is free. This is what four
single-core machines that share only a disk would do.
"""

from __future__ import annotations

import os
import random
import resource
import subprocess
import sys
import time
from pathlib import Path
from tempfile import TemporaryDirectory

import bpy
import numpy as np

import splat_addon
from environment import ROOT
from measuring.blender_scene import lit_scene

STAND_IN = ROOT / "tests" / "blender" / "commands" / "blender_stand_in.py"
WORKERS = 4
QUICK = {"size": (64, 48), "resolution": 32, "frames": 4, "chunk": 2, "kills": 1}


def arguments(parser) -> None:
    parser.add_argument("--size", type=int, nargs=2, default=(640, 480))
    parser.add_argument("--resolution", type=int, default=400, help="of the ball of surfels")
    parser.add_argument("--frames", type=int, default=48)
    parser.add_argument("--chunk", type=int, default=6, help="frames of a task")
    parser.add_argument("--kills", type=int, default=10, help="workers that are killed, one after another")


def run(options, report) -> None:
    splat_addon.register()
    report.header()
    with TemporaryDirectory() as name:
        folder = Path(name)
        surfels = _saved_scene(folder / "scene.blend", options)
        whole = _timed(_command(folder, "whole_", 1, options.frames))
        starts = range(1, options.frames + 1, options.chunk)
        tasks = [_timed(_command(folder, "farm_", first, options.chunk, options.frames)) for first in starts]
        makespan = _makespan(tasks, WORKERS)
        report.say(f"{options.frames} frames of {options.size[0]} x {options.size[1]}, {surfels:,} surfels.")
        report.table(
            ["what", "seconds of a processor"],
            [
                ["one worker, one process", f"{whole:.1f}"],
                [f"{len(tasks)} tasks of {options.chunk} frames, one after another", f"{sum(tasks):.1f}"],
                [f"{WORKERS} workers, simulated", f"{makespan:.1f}"],
            ],
        )
        report.say(f"{WORKERS} workers reach {whole / makespan / WORKERS:.0%} of {WORKERS} times one worker.")
        _kill(folder, tasks[0], options, report)


def _kill(folder: Path, seconds: float, options, report) -> None:
    """Start a chunk, kill it at each of the moments, check the output, and start it again."""
    moments, half_written, wrong = random.Random(18), 0, 0
    for turn in range(options.kills):
        command = _command(folder, f"killed{turn}_", 1, options.chunk)
        process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        time.sleep(moments.uniform(0, seconds))
        process.kill()
        process.wait()
        half_written += sum(not _is_same(folder, path, f"killed{turn}_") for path in folder.glob(f"killed{turn}_*"))
        _timed(command)
        made = sorted(folder.glob(f"killed{turn}_*"))
        wrong += options.chunk - len(made) + sum(not _is_same(folder, path, f"killed{turn}_") for path in made)
    left = [path.name for path in folder.iterdir() if "unfinished" in path.name]
    report.say(
        f"{options.kills} workers killed: {half_written} files half-written, {wrong} frames lost or another picture "
        f"after the task was given again, {len(left)} leftovers."
    )
    if half_written or wrong or left:
        raise RuntimeError("A killed worker left something behind; see above.")


def _is_same(folder: Path, path: Path, name: str) -> bool:
    """Whether a picture equals the one of the uninterrupted run, pixel by pixel."""
    try:
        return np.array_equal(_pixels(path), _pixels(folder / path.name.replace(name, "whole_")))
    except RuntimeError:
        return False


def _pixels(path: Path) -> np.ndarray:
    image = bpy.data.images.load(str(path))
    values = np.empty(image.size[0] * image.size[1] * 4, np.float32)
    image.pixels.foreach_get(values)
    bpy.data.images.remove(image)
    return values


def _makespan(tasks: list[float], workers: int) -> float:
    """The finishing time when each worker takes the next task as soon as it is free."""
    free = [0.0] * workers
    for seconds in tasks:
        free[free.index(min(free))] += seconds
    return max(free)


def _timed(command: list[str]) -> float:
    """Processor seconds of a command. Raises CalledProcessError."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    one_thread = {**os.environ, "LP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, env=one_thread)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def _command(folder: Path, name: str, first: int, chunk: int, last: int | None = None) -> list[str]:
    blender = [sys.executable, str(STAND_IN), "--background", str(folder / "scene.blend"), "--command", "surfels"]
    frames = ["--first", str(first), "--chunk", str(chunk), *(["--last", str(last)] if last else [])]
    return [*blender, "render", "--out", str(folder / f"{name}####"), *frames]


def _saved_scene(file: Path, options) -> int:
    """Save a scene with a moving ball of surfels; returns the number of surfels."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = lit_scene(options.size, (0.3, 0.3, 0.3), (0.6, 0.4, 0.0), 2.0)
    scene.camera.location, scene.camera.rotation_euler = (0, -6, 0), (np.pi / 2, 0, 0)
    bpy.ops.mesh.primitive_uv_sphere_add(segments=64, ring_count=32)
    bpy.ops.object.surfels_from_mesh(resolution=options.resolution, source="HIDE")
    surfels = bpy.context.object
    for frame, x in ((1, -1.5), (options.frames, 1.5)):
        surfels.location.x = x
        surfels.keyframe_insert("location", frame=frame)
    scene.frame_end = options.frames
    bpy.ops.wm.save_as_mainfile(filepath=str(file))
    return len(surfels.data.vertices)
