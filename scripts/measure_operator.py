# SPDX-License-Identifier: GPL-3.0-or-later
"""The conversion operator as a whole beside the sampling alone, and what ten million surfels take.

    PYTHON scripts/measure_operator.py [--models DIR] [--rounds 5] [--large 0|10] [--case FILE RESOLUTION] ...

PYTHON must have bpy, trimesh and rich. Per case, turn by turn: the operator from a mesh object to a surfel object, and
the sampling of the same mesh, read and cleaned. Seconds are of the processor, so that other work on the machine counts
little. --large N: the dragon into N million surfels through the operator's own steps, with the share of the work and
the memory of the process every tenth of a second, and a cancel in the middle.
"""

import argparse
import datetime
import os
import sys
import threading
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT))

import bpy  # noqa: E402

import splat_addon  # noqa: E402
from scripts.measure_conversion import CASES, SURFEL_BYTES, load, spread  # noqa: E402
from splat_addon.blender.conversion import Choices  # noqa: E402
from splat_addon.blender.conversion_batch import ConversionBatch  # noqa: E402
from splat_addon.blender.gathering import gather  # noqa: E402
from splat_addon.sampling import drop_unusable, sample_mesh  # noqa: E402


def add_object(path: Path) -> bpy.types.Object:
    """The model as a smooth-shaded object, alone in the file and selected."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    mesh = load(path)
    data = bpy.data.meshes.new("model")
    data.from_pydata(mesh.positions, [], mesh.triangles, shade_flat=False)
    made = bpy.data.objects.new("model", data)
    bpy.context.collection.objects.link(made)
    select(made)
    return made


def select(source: bpy.types.Object) -> None:
    source.select_set(True)
    bpy.context.view_layer.objects.active = source


def remove(made: bpy.types.Object) -> None:
    data = made.data
    bpy.data.objects.remove(made)
    bpy.data.meshes.remove(data)


def processor_seconds(job) -> float:
    started = time.process_time()
    job()
    return time.process_time() - started


def measure(path: Path, resolution: int, rounds: int) -> str:
    """A row of the table."""
    source = add_object(path)
    mesh, _ = drop_unusable(gather([source], bpy.context.evaluated_depsgraph_get(), False).mesh)
    whole, alone = [], []
    for _ in range(rounds):
        select(source)
        whole.append(processor_seconds(lambda: bpy.ops.object.surfels_from_mesh(resolution=resolution)))
        made = bpy.context.active_object
        count = len(made.data.vertices)
        made.select_set(False)
        remove(made)
        alone.append(processor_seconds(lambda: sample_mesh(mesh, resolution=resolution)))
    ratios = [a / b for a, b in zip(whole, alone, strict=True)]
    name = path.name.split(".")[0]
    return f"| {name} | {resolution} | {count:,} | {spread(whole)} | {spread(alone)} | {spread(ratios)} |"


class MemoryTrace:
    """Megabytes of the process every tenth of a second, while the context lasts."""

    def __enter__(self):
        self.samples, self._over = [], threading.Event()
        self._thread = threading.Thread(target=self._watch)
        self._thread.start()
        return self

    def __exit__(self, *error):
        self._over.set()
        self._thread.join()

    def _watch(self):
        while not self._over.wait(0.1):
            self.samples.append(resident())


def resident() -> float:
    """Megabytes of the process in memory (Linux)."""
    return int(Path("/proc/self/statm").read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE") / 1e6


def measure_large(path: Path, millions: float) -> None:
    """Prints what the conversion into so many surfels takes, and what a cancel leaves behind."""
    source = add_object(path)
    choices = Choices({"count": millions * 1e6})
    data_before = len(bpy.data.objects), len(bpy.data.meshes)
    for stop_at in (0.6, None):
        batch, shares = ConversionBatch([source], choices), []

        def report(share, batch=batch, shares=shares, stop_at=stop_at):
            shares.append((time.perf_counter(), share))
            batch.is_cancelled = stop_at is not None and share >= stop_at

        before, started = resident(), time.perf_counter()
        with MemoryTrace() as trace:
            for conversion in batch.prepared(bpy.context):
                batch.sample(conversion, report)
            stopped = time.perf_counter()
            made = batch.place_all(bpy.context) if batch.has_surfels else []
        gaps = [b - a for (a, _), (b, _) in zip(shares, shares[1:], strict=False)]
        print(
            f"{'cancelled at 60 %' if stop_at else 'to the end'}: {time.perf_counter() - started:.1f} s, "
            f"{len(shares)} reports of progress, {max(gaps):.2f} s apart at most; memory {before:.0f} MB before, "
            f"{max(trace.samples):.0f} at most, {resident():.0f} after"
        )
        if stop_at:
            print(f"  cancel: {stopped - shares[-1][0]:.2f} s from the word to the end", end="; ")
            left = (len(bpy.data.objects), len(bpy.data.meshes)) != data_before
            print("something was left behind" if left else "objects and meshes are those from before")
        else:
            count = sum(len(conversion.surfels) for conversion, _ in made)
            extra = (max(trace.samples) - before) * 1e6 / count - 2 * SURFEL_BYTES
            print(f"  {count:,} surfels; {extra:.0f} bytes each beside the result and its copy in Blender's mesh")
        del batch, conversion


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--models", type=Path, default=ROOT.parent / "shared" / "models")
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--large", type=float, default=0, metavar="MILLIONS")
    parser.add_argument("--case", nargs=2, action="append", metavar=("FILE", "RESOLUTION"))
    arguments = parser.parse_args()
    splat_addon.register()
    print(f"Blender {bpy.app.version_string}, {os.cpu_count()} cores, {datetime.date.today()}")
    if arguments.large:
        measure_large(arguments.models / "dragon_vrip.ply.gz", arguments.large)
        return
    print(f"Processor seconds, median (min-max) of {arguments.rounds} turns.")
    print("| model | resolution | surfels | operator | sampling alone | ratio |\n|---|---|---|---|---|---|")
    for name, resolution in arguments.case or CASES:
        print(measure(arguments.models / name, int(resolution), arguments.rounds), flush=True)


if __name__ == "__main__":
    main()
