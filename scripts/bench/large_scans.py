# SPDX-License-Identifier: GPL-3.0-or-later
"""A LAZ file of any size: a first look at few of its points, and all of them stored in a file of blocks.

The file has a hilly terrain with houses, flown in ten strips, points 0.1 apart; it is written in pieces, unless --file
names one that is there, such as a real scan. *Few* are read and become surfels in memory; *import* does so in Blender,
and *picture* is its first one there, as the import shows it; *all* become surfels in portions. *Processor* is the time
of all threads, which other programs change little; half of it is what two idle cores would take at best.
"""

from __future__ import annotations

import resource
import struct
from pathlib import Path
from time import perf_counter, process_time

import numpy as np

from environment import Problem
from scan_files.formats import las_rows
from splat_addon.interchange import point_pieces, read_contents
from splat_addon.sampling import surfels_from_points
from splat_addon.streaming import write_points
from splat_addon.surfels import Surfels

QUICK = {"points": 20_000, "few": 2000, "size": (48, 36), "steps": ("few", "all", "import", "picture")}
#: Points that are written at once, strips of the flight, and metres between points.
_PIECE, _STRIPS, _SPACING = 1_000_000, 10, 0.1
_CORNER = np.array([400_000.0, 5_600_000.0, 0.0])


def arguments(parser) -> None:
    parser.add_argument("--points", type=int, default=1_000_000)
    parser.add_argument("--few", type=int, default=300_000, help="points of the first look")
    parser.add_argument("--file", type=Path, help="a LAZ file; it is written if it is not there, and kept")
    parser.add_argument("--steps", nargs="+", choices=STEPS, default=("few", "all"), help="what to measure")
    parser.add_argument("--size", type=int, nargs=2, default=(800, 600), metavar=("WIDTH", "HEIGHT"))
    parser.add_argument("--samples", type=int, default=1, help="of a pixel of the picture")


def run(options, report) -> None:
    file = options.file or report.out / "scan.laz"
    if not (options.file and file.exists()):
        write_scan(file, options.points)
    count = point_pieces(file).count
    report.header(how=f"{count:,} points, {file.stat().st_size / 1e6:,.0f} MB")
    columns = ["what", "points", "surfels", "seconds", "processor", "MB at most"]
    report.table(columns, (measured(options, file, report.out, STEPS[name]) for name in options.steps))


def measured(options, file: Path, out: Path, step) -> list:
    start, processor = perf_counter(), process_time()
    name, points, surfels = step(options, file, out)
    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1000
    times = perf_counter() - start, process_time() - processor
    return [name, f"{points:,}", f"{surfels:,}", *(f"{each:,.1f}" for each in times), f"{memory:,.0f}"]


def few(options, file: Path, out: Path) -> tuple[str, int, int]:
    points = read_contents(file, most=options.few)
    surfels, _ = surfels_from_points(points.positions - _CORNER, colors=points.colors)
    return "few of them", len(points.positions), len(surfels)


def imported(options, file: Path, out: Path) -> tuple[str, int, int]:
    # not sooner, as Blender takes memory of its own
    import bpy

    import splat_addon

    splat_addon.register()
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.import_scene.surfels_ply(filepath=str(file), most_points=options.few)
    count = len(bpy.context.object.data.vertices)
    return "few, imported into Blender", options.few or count, count


def pictured(options, file: Path, out: Path) -> tuple[str, int, int]:
    import bpy

    from measuring.blender_scene import rendered

    scene = bpy.context.scene
    if not bpy.data.objects:
        raise Problem("The picture shows what was imported: measure the step import before it.")
    scene.render.resolution_x, scene.render.resolution_y = options.size
    scene.surfel_splatting.samples = options.samples
    rendered(scene)
    count = len(bpy.context.object.data.vertices)
    return f"the next picture in Blender, {options.samples} samples", count, count


def all_of_them(options, file: Path, out: Path) -> tuple[str, int, int]:
    pieces = point_pieces(file)
    parts = Parts(pieces)
    sample = pieces.sample.positions - _CORNER
    stored, _ = write_points(
        out / "scan.surfelblocks", parts, sample, pieces.count, converted, origin=_CORNER, neighbours=16
    )
    (out / "scan.surfelblocks").unlink()
    return "all, stored", pieces.count, stored


#: Memory at most is that of the steps before, too.
STEPS = {"few": few, "import": imported, "picture": pictured, "all": all_of_them}


class Parts:
    """The points of a file, as `write_points` takes them."""

    def __init__(self, pieces):
        self._pieces = pieces

    def __iter__(self):
        for points in self._pieces:
            yield {"positions": points.positions - _CORNER, "colors": points.colors}


def converted(arrays: dict[str, np.ndarray], own: int, told) -> tuple[Surfels, np.ndarray]:
    surfels, report = surfels_from_points(
        arrays["positions"], colors=arrays["colors"], viewpoint=(0.0, 0.0, 1e6), progress=told
    )
    mine = report.kept < own
    fields = {name: values[mine] for name, values in surfels.arrays().items()}
    fields["positions"] = (fields["positions"] + surfels.origin).astype(np.float32)
    return Surfels(origin=_CORNER, **fields), report.kept[mine]


def write_scan(file: Path, count: int) -> None:
    """Write a LAZ file of the terrain."""
    import lazrs

    kind, vlr = las_rows(3, 1).dtype, lazrs.LazVlr.new_for_compression(3, 0, False)
    data, head = bytes(vlr.record_data()), bytearray(227)
    struct.pack_into("<4s", head, 0, b"LASF")
    struct.pack_into("<BB", head, 24, 1, 2)
    struct.pack_into("<HII", head, 94, 227, 227 + 54 + len(data), 1)
    struct.pack_into("<BHI", head, 104, 3 | 0x80, kind.itemsize, count)
    struct.pack_into("<6d", head, 131, *[0.001] * 3, *_CORNER)
    random = np.random.default_rng(0)
    with open(file, "wb") as stream:
        stream.write(bytes(head) + struct.pack("<H16sHH32s", 0, b"laszip encoded", 22204, len(data), b"") + data)
        compressor = lazrs.LasZipCompressor(stream, vlr)
        for first in range(0, count, _PIECE):
            numbers = np.arange(first, min(first + _PIECE, count))
            compressor.compress_many(np.frombuffer(_rows(numbers, count, kind, random).tobytes(), np.uint8))
        compressor.done()


def _rows(numbers: np.ndarray, count: int, kind: np.dtype, random) -> np.ndarray:
    """The points of these numbers."""
    side, each = np.sqrt(count) * _SPACING, -(-count // _STRIPS)
    across = max(int(np.sqrt(count) / _STRIPS), 1)
    strip, number = numbers // each, numbers % each
    x = number // across * side * across / each + random.uniform(-0.05, 0.05, len(numbers))
    y = (strip + number % across / across) * side / _STRIPS + random.uniform(-0.05, 0.05, len(numbers))
    is_house = (np.floor(x / 12) + np.floor(y / 15)) % 2 == 0
    is_house &= (x % 12 < 8) & (y % 15 < 10)
    z = 20 + 5 * np.sin(x / 60) * np.cos(y / 45) + np.where(is_house, 6 - 0.4 * np.abs(x % 12 - 4), 0)
    rows = np.zeros(len(numbers), kind)
    for axis, values in zip("XYZ", (x, y, z + random.normal(0, 0.01, len(numbers))), strict=True):
        rows[axis] = np.rint(1000 * values)
    rows["returns"], rows["gps_time"] = 1 + 8, 1e3 * strip + 100 * number / each
    for name, house, ground in (("red", 180, 90), ("green", 80, 120), ("blue", 60, 60)):
        rows[name] = 256 * np.where(is_house, house, ground)
    return rows
