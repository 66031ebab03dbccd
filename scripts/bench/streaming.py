# SPDX-License-Identifier: GPL-3.0-or-later
"""A file of more surfels than memory holds: its first picture, the longest one of a flight, and the memory.

A landscape is written portion by portion, by another process, unless --file names one that is there; then it is drawn
as the 3D view does it: once after opening the file, and while the camera flies over it at the view's rate. *Read* is
the part of a picture's time in which surfels are chosen and waited for; the rest is packed, uploaded and drawn. *At
rest* is the time from the flight's end to the whole picture, and the longest call of the view in it.
*Processor* is the most processor time of all threads in a call, which other programs change little.
"""

from __future__ import annotations

import resource
from multiprocessing import get_context
from pathlib import Path
from time import perf_counter, process_time, sleep

import numpy as np

from splat_addon.rendering import (
    Camera,
    Instance,
    Light,
    Pace,
    Refinement,
    Renderer,
    Scene,
    Settings,
    look_at,
    open_device,
)
from splat_addon.streaming import BlockFile, Stream, write_blocks
from splat_addon.surfels import Surfels

DEVICES = ("standalone",)
QUICK = {"side": 300, "size": 64, "flight": 3}
#: Surfels that are made at once; period and height of the landscape's waves, in widths of it.
PART, WAVES = 1_000_000, ((0.1, 0.012), (0.023, 0.003), (0.0041, 0.0005))
COLUMNS = "shadow first,_s longest,_ms processor,_ms read median,_ms read splats".split()
COLUMNS += "at_rest,_s longest,_ms processor,_ms splats".split()


def arguments(parser) -> None:
    parser.add_argument("--side", type=int, default=14_143, help="surfels along each side of the landscape")
    parser.add_argument("--size", type=int, default=512, help="pixels along each side")
    parser.add_argument("--flight", type=int, default=60, help="pictures of the flight")
    parser.add_argument("--budget", type=int, default=512, help="megabytes for rows of the file")
    parser.add_argument("--rate", type=float, default=10, help="pictures a second that the flight asks for")
    parser.add_argument("--file", type=Path, help="a file to fly over; it is written if it is not there, and kept")


class Landscape:
    """side x side surfels over the unit square, in parts."""

    def __init__(self, side: int):
        self.side = side

    def __iter__(self):
        rows = max(PART // self.side, 1)
        for first in range(0, self.side, rows):
            y, x = np.mgrid[first : min(first + rows, self.side), : self.side].astype(np.float32).reshape(2, -1)
            yield self._part((x + 0.5) / self.side, (y + 0.5) / self.side)

    def _part(self, x: np.ndarray, y: np.ndarray) -> Surfels:
        height, slope_x, slope_y, one = np.zeros_like(x), np.zeros_like(x), np.zeros_like(x), np.ones_like(x)
        for period, size in WAVES:
            a, b = 2 * np.pi / period * x, 2 * np.pi / period * y
            height += size * np.sin(a) * np.cos(b)
            slope_x += size * 2 * np.pi / period * np.cos(a) * np.cos(b)
            slope_y -= size * 2 * np.pi / period * np.sin(a) * np.sin(b)
        normals = np.stack([-slope_x, -slope_y, one], axis=1)
        normals /= np.linalg.norm(normals, axis=1, keepdims=True)
        turns = np.stack([1 + normals[:, 2], -normals[:, 1], normals[:, 0], 0 * x], axis=1)
        light = np.clip(0.5 + 20 * height, 0, 1)
        return Surfels(
            positions=np.stack([x, y, height], axis=1),
            rotations=turns / np.linalg.norm(turns, axis=1, keepdims=True),
            scales=np.full((len(x), 2), 2.5 / self.side),
            normals=normals,
            colors=np.stack([0.3 + 0.4 * light, 0.5 - 0.1 * light, 0.2 + 0.2 * light, one], axis=1),
            materials=np.zeros(len(x), np.int32),
        )


def run(options, report) -> None:
    path, started = options.file or options.out / "landscape.surfelblocks", perf_counter()
    is_new = not path.exists()
    if is_new:
        writer = get_context("spawn").Process(target=write_blocks, args=(path, Landscape(options.side)))
        writer.start()
        writer.join()
    try:
        device, seconds = open_device(options.device), perf_counter() - started
        report.header(device, f"{options.size} x {options.size} pixels, {options.budget} MB for rows of the file")
        written = f", written in {seconds:.0f} s with {megabytes(resource.RUSAGE_CHILDREN)}" if is_new else ""
        report.say(f"{BlockFile(path).count:,} surfels in a file of {path.stat().st_size / 1e9:.1f} GB{written}.")
        before = megabytes(resource.RUSAGE_SELF)
        report.table([n.replace("_", " ") for n in COLUMNS], (fly(device, path, s, options) for s in (0, 1024)))
        report.say(f"At most {megabytes(resource.RUSAGE_SELF)} resident, {before} before the file was opened.")
    finally:
        if options.file is None:
            path.unlink()


def megabytes(who: int) -> str:
    """The most memory that was resident; Linux counts in kilobytes."""
    return f"{resource.getrusage(who).ru_maxrss / 1000:,.0f} MB"


def fly(device, path: Path, shadow: int, options) -> tuple:
    """One row: seconds from opening the file to the first picture, then a flight from there."""
    started, settings = perf_counter(), Settings(detail_tolerance=1.25, shadow_resolution=shadow, outputs=("color",))
    stream = Stream(path, options.budget * 1_000_000)
    sun = Light("sun", energy=3, direction=(-0.5, 0.4, -0.6), casts_shadow=shadow > 0)
    scene = Scene((Instance(stream.coarsest, stream=stream),), (sun,), (0.2, 0.2, 0.2))
    view, times, spent, reads = Refinement(Renderer(device), Pace(options.rate)), [], [], []
    resolved = view.renderer.streamed.resolved

    def timed(*arguments, **named):
        begun = perf_counter()
        found = resolved(*arguments, **named)
        reads.append(1e3 * (perf_counter() - begun))
        return found

    view.renderer.streamed.resolved = timed

    def draw(share: float) -> None:
        pose = look_at((0.5 + 0.1 * share, -0.3 + 0.6 * share, 0.35 - 0.25 * share), (0.5, 0.55 + 0.3 * share, 0))
        camera, begun = Camera.perspective(pose, 0.8, (options.size, options.size), 0.001, 5), perf_counter()
        used = process_time()
        for shown in view.draw(scene, camera, settings):
            device.finish(device.target([shown.texture]))
        times.append(1e3 * (perf_counter() - begun))
        spent.append(1e3 * (process_time() - used))

    draw(0.0)
    first = perf_counter() - started
    for share in np.linspace(0, 1, options.flight):
        draw(share)
    moving, rests = splats(view), perf_counter()
    flown, read = list(times), list(reads)
    while view.wants_more:
        draw(1.0)
        sleep(0.02)  # the 3D view does other things between its pictures
    rested = perf_counter() - rests
    whole = splats(view)
    # otherwise it refers to itself, and the next flight has both in memory
    del view.renderer.streamed.resolved
    view.renderer.release()
    stream.close()
    return (
        "sun's" if shadow else "none", f"{first:.2f}", f"{max(flown):.0f}", f"{max(spent[:len(flown)]):.0f}",
        f"{max(read):.0f}",
        f"{np.median(flown):.0f}", f"{np.median(read):.0f}", f"{moving:,}",
        f"{rested:.1f}", f"{max(times[len(flown):], default=0):.0f}",
        f"{max(spent[len(flown):], default=0):.0f}", f"{whole:,}",
    )  # fmt: skip


def splats(view: Refinement) -> int:
    """The number in the last picture."""
    return sum(len(instance.surfels) for instance in view._drawn.surfels)
