# SPDX-License-Identifier: GPL-3.0-or-later
"""Seconds and memory of converting real meshes, against a cost model and against other ways to sample a mesh.

    PYTHON scripts/measure_conversion.py [--models DIR] [--rounds 7] [--slow-rounds 2] [--case armadillo.obj.gz 256] ...

PYTHON must have numpy, trimesh and rich (the environment that scripts/test.py makes). The cost model is 0.25 us a
triangle + 0.1 us a surfel. The others (`sampling_rivals.py`) are taken where they are installed: Open3D, trimesh, and
in a PYTHON with bpy Geometry Nodes and Blender's BVH tree. Everything runs once a round, so that a busy moment of the
machine does not fall on one alone. Meshes are smooth-shaded, without colours.
"""

import argparse
import datetime
import gzip
import io
import os
import platform
import statistics
import subprocess
import sys
import time
import tracemalloc
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT))

import numpy as np  # noqa: E402
import trimesh  # noqa: E402
from rich.console import Console  # noqa: E402
from rich.progress import track  # noqa: E402

from scripts.sampling_rivals import RIVALS, SLOW  # noqa: E402
from splat_addon.sampling import TriangleMesh, drop_unusable, sample_mesh  # noqa: E402
from splat_addon.surfels import LAYOUT  # noqa: E402

#: The cost model: seconds a triangle, seconds a surfel.
TRIANGLE_COST, SURFEL_COST = 0.25e-6, 0.1e-6

SURFEL_BYTES = sum(columns * np.dtype(dtype).itemsize for columns, dtype in LAYOUT.values())

CASES = (
    ("armadillo.obj.gz", 256),
    ("armadillo.obj.gz", 1024),
    ("dragon_vrip.ply.gz", 512),
    ("dragon_vrip.ply.gz", 1024),
)


HEADER = (
    "model", "resolution", "triangles", "surfels", "cleaning s", "sampling s", "of a processor", "M surfels/s at best",
    "ratio", "extra bytes a surfel",
)  # fmt: skip


def load(path: Path) -> TriangleMesh:
    """A gzipped model with smooth normals at its corners."""
    kind = path.name.split(".")[1]
    loaded = trimesh.load(io.BytesIO(gzip.decompress(path.read_bytes())), file_type=kind, force="mesh", process=False)
    corner_normals = np.asarray(loaded.vertex_normals, np.float32)[loaded.faces]
    return TriangleMesh(loaded.vertices, np.asarray(loaded.faces, np.int32), corner_normals=corner_normals)


class Timed(NamedTuple):
    """Seconds on the clock, seconds of all processors, and what the job gave."""

    clock: float
    work: float
    result: object


def timed(job) -> Timed:
    clock, work = time.perf_counter(), time.process_time()
    result = job()
    return Timed(time.perf_counter() - clock, time.process_time() - work, result)


def time_round(mesh: TriangleMesh, resolution: int) -> tuple[Timed, Timed]:
    """Cleaning, and sampling the clean mesh, which gives the number of surfels."""
    mesh = replace(mesh)  # it keeps what is once found of it
    cleaning = timed(lambda: drop_unusable(mesh)[0])
    sampling = timed(lambda: len(sample_mesh(cleaning.result, resolution=resolution)))
    return cleaning._replace(result=None), sampling


def extra_bytes(mesh: TriangleMesh, resolution: int) -> float:
    """Peak bytes a surfel while sampling, above the cleaned mesh and the result."""
    mesh, _ = drop_unusable(mesh)
    tracemalloc.start()
    count = len(sample_mesh(mesh, resolution=resolution))
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    return peak / count - SURFEL_BYTES


def report(models: Path, cases, rounds: int, slow_rounds: int) -> None:
    console = Console(stderr=True)
    names = list(dict.fromkeys(name for name, _ in cases))
    meshes = {name: load(models / name) for name in track(names, "Loading", console=console)}
    times = {case: [] for case in cases}
    rivals = {case: prepared_rivals(meshes[case[0]], case[1]) for case in cases}
    rival_times = {case: {name: [] for name in rivals[case]} for case in cases}
    for turn in track(range(rounds), "Converting", console=console):
        for case in cases:
            times[case].append(time_round(meshes[case[0]], case[1]))
            for name, job in rivals[case].items():
                if name in SLOW and turn >= slow_rounds:
                    continue
                rival_times[case][name].append(timed(job))

    commit = subprocess.run(["git", "rev-parse", "--short", "HEAD"], cwd=ROOT, capture_output=True, text=True).stdout
    print(f"{platform.processor() or platform.machine()}, {os.cpu_count()} cores, {datetime.date.today()}")
    print(f"Python {platform.python_version()}, numpy {np.__version__}, commit {commit.strip()}")
    print(f"Median (min-max) of {rounds} rounds. Ratio: processor seconds / (0.25 us a triangle + 0.1 us a surfel).")
    print("Sampling includes the check at the door of Surfels. Extra bytes: the peak while sampling, above the")
    print("cleaned mesh and the result.")
    print(f"| {' | '.join(HEADER)} |\n{'|---' * len(HEADER)}|")
    for (name, resolution), rows in times.items():
        mesh, count = meshes[name], rows[0][1].result
        model = TRIANGLE_COST * len(mesh) + SURFEL_COST * count
        cleaning, clock, work = (
            [getattr(row[k], what) for row in rows] for k, what in ((0, "work"), (1, "clock"), (1, "work"))
        )
        cells = (
            name.split(".")[0], f"{resolution}", f"{len(mesh):,}", f"{count:,}", spread(cleaning), spread(clock),
            spread(work), f"{count / min(work) / 1e6:.2f}", spread([w / model for w in work]),
            f"{extra_bytes(mesh, resolution):.0f}",
        )  # fmt: skip
        print("| " + " | ".join(cells) + " |", flush=True)
    print_rivals(times, rival_times, rivals)


def prepared_rivals(mesh: TriangleMesh, resolution: int) -> dict:
    """name -> function that samples the same mesh and returns its number of samples; only those that are installed."""
    usable, _ = drop_unusable(mesh)
    count = len(sample_mesh(usable, resolution=resolution))
    return {name: job for name, prepare in RIVALS.items() if (job := prepare(usable, resolution, count)) is not None}


def print_rivals(times: dict, rival_times: dict, rivals: dict) -> None:
    """Their seconds over ours, turn by turn: on the clock, in work of all processors, that for a sample, and that with
    the building of a tree, which a user who samples a mesh once waits for."""
    print("\nOthers: how many times longer they take than our sampling (without cleaning), turn by turn.\n")
    print("| model | other | its samples | its seconds | on the clock | in work | in work, a sample | with its tree |")
    print("|---|---|---|---|---|---|---|---|")
    for case, others in rival_times.items():
        for name, rows in others.items():
            turns = [(theirs, ours) for theirs, (_, ours) in zip(rows, times[case], strict=False)]
            clock, work = ([getattr(t, k) / getattr(o, k) for t, o in turns] for k in ("clock", "work"))
            each = [ratio * o.result / t.result for ratio, (t, o) in zip(work, turns, strict=True)]
            built = getattr(rivals[case][name], "preparation", 0.0)
            whole = [(t.work + built) / o.work for t, o in turns]
            label = f"{case[0].split('.')[0]} at {case[1]}"
            seconds = spread([row.clock for row in rows])
            cells = (
                label,
                name,
                f"{rows[0].result:,}",
                seconds,
                spread(clock),
                spread(work),
                spread(each),
                spread(whole),
            )
            print("| " + " | ".join(cells) + " |", flush=True)


def spread(values: list) -> str:
    return f"{statistics.median(values):.3g} ({min(values):.3g}-{max(values):.3g})"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--models", type=Path, default=ROOT.parent / "shared" / "models")
    parser.add_argument("--rounds", type=int, default=7)
    parser.add_argument("--slow-rounds", type=int, default=2, help="rounds of the others that take long")
    parser.add_argument("--case", nargs=2, action="append", metavar=("FILE", "RESOLUTION"))
    arguments = parser.parse_args()
    cases = [(name, int(resolution)) for name, resolution in arguments.case or CASES]
    missing = [name for name, _ in cases if not (arguments.models / name).is_file()]
    if missing:
        sys.exit(f"{arguments.models} has no {missing[0]}; name the folder of models with --models.")
    report(arguments.models, cases, arguments.rounds, arguments.slow_rounds)


if __name__ == "__main__":
    main()
