# SPDX-License-Identifier: GPL-3.0-or-later
"""Processor time and memory of making surfels from bare points, beside a twin that has scipy's kd-tree.

    PYTHON scripts/measure_points.py [--models DIR] [--rounds 5] [--points 1000000] [--picture PNG]

PYTHON must have numpy, scipy, rich, and for the picture moderngl and Pillow (the environment that scripts/test.py
makes). All of it runs in one thread, so its processor time is about what a quiet machine takes. Twin and original run
in turns; the twin differs in one function. The picture shows the range map of --models.
"""

import argparse
import datetime
import gzip
import os
import platform
import statistics
import sys
import tempfile
import time
import tracemalloc
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT))

import numpy as np  # noqa: E402
from rich.console import Console  # noqa: E402
from rich.progress import track  # noqa: E402
from scipy.spatial import cKDTree  # noqa: E402

from splat_addon.interchange import read_contents  # noqa: E402
from splat_addon.sampling import surfels_from_points  # noqa: E402
from splat_addon.sampling.points import from_points  # noqa: E402
from splat_addon.sampling.points.neighbours import nearest_neighbours  # noqa: E402

HEADER = (
    "points", "surfels", "CPU s", "points/CPU s", "neighbours CPU s", "kd-tree CPU s", "twin / original",
    "peak bytes a point",
)  # fmt: skip


def sphere(count: int) -> np.ndarray:
    """Random points in random order, the worst that a memory cache can meet."""
    points = np.random.default_rng(0).normal(size=(count, 3))
    return points / np.linalg.norm(points, axis=1, keepdims=True)


def range_map(models: Path) -> np.ndarray:
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "map.ply"
        path.write_bytes(gzip.decompress((models / "rangemap_lato315.ply.gz").read_bytes()))
        return read_contents(path).positions


def by_kd_tree(positions: np.ndarray, count: int, report=None) -> tuple[np.ndarray, np.ndarray]:
    """The twin of `nearest_neighbours`, which tells of no progress."""
    distances, neighbours = cKDTree(positions).query(positions, count + 1)
    return neighbours[:, 1:].astype(np.int32), distances[:, 1:].astype(np.float32)


def timed(search, points: np.ndarray) -> tuple[float, float, int]:
    """Processor seconds of everything, of the search alone, and surfels."""
    seconds = []

    def watched(*arguments):
        started = time.process_time()
        found = search(*arguments)
        seconds.append(time.process_time() - started)
        return found

    from_points.nearest_neighbours = watched
    try:
        started = time.process_time()
        count = len(surfels_from_points(points)[0])
        return time.process_time() - started, sum(seconds), count
    finally:
        from_points.nearest_neighbours = nearest_neighbours


def peak_bytes(points: np.ndarray) -> float:
    """Peak bytes a point above the input, the result included."""
    tracemalloc.start()
    surfels_from_points(points)
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    return peak / len(points)


def report(clouds: dict, rounds: int) -> None:
    rows = {name: [] for name in clouds}
    for _ in track(range(rounds), "Converting", console=Console(stderr=True)):
        for name, points in clouds.items():
            rows[name].append((timed(nearest_neighbours, points), timed(by_kd_tree, points)))
    print(f"{platform.processor() or platform.machine()}, {os.cpu_count()} cores, {datetime.date.today()}")
    print(f"Python {platform.python_version()}, numpy {np.__version__}; median (min-max) of {rounds} rounds\n")
    print(f"| cloud | {' | '.join(HEADER)} |\n|{'---|' * (len(HEADER) + 1)}")
    for name, points in clouds.items():
        whole, search, twin_search = ([r[k][i] for r in rows[name]] for k, i in ((0, 0), (0, 1), (1, 1)))
        ratios = [twin[0] / own[0] for own, twin in rows[name]]
        cells = (
            name, f"{len(points):,}", f"{rows[name][0][0][2]:,}", spread(whole),
            f"{len(points) / statistics.median(whole):,.0f}", spread(search), spread(twin_search), spread(ratios),
            f"{peak_bytes(points):.0f}",
        )  # fmt: skip
        print("| " + " | ".join(cells) + " |", flush=True)


def spread(values: list) -> str:
    return f"{statistics.median(values):.2f} ({min(values):.2f}-{max(values):.2f})"


def draw(points: np.ndarray, path: Path) -> None:
    """Two halves: the points as they come, and as surfels; the camera stands where the scanner stood, nearer."""
    from PIL import Image

    from splat_addon.rendering import Camera, Light, Renderer, Scene, Settings, open_device

    matrix = np.eye(4)
    matrix[:3, 3] = 0, -10, -200
    camera = Camera.perspective(matrix, np.radians(13), (640, 560), 1, 2000)
    lights = [Light("sun", direction=(0.5, -0.6, -0.8), energy=3.0)]
    renderer, halves = Renderer(open_device("standalone")), []
    radius = 0.08
    bare = surfels_from_points(points, np.tile((0.0, 0.0, 1.0), (len(points), 1)), np.full(len(points), radius))
    for surfels, shading in ((bare, "flat"), (surfels_from_points(points, viewpoint=(0, 0, 0)), "principled")):
        scene = Scene(surfels=[surfels[0]], lights=lights, world=(0.02, 0.02, 0.02))
        color = renderer.render(scene, camera, Settings(method="quad", supersampling=2, shading=shading)).color[
            ::-1, :, :3
        ]
        halves.append(np.clip(color, 0, 1) ** (1 / 2.2))
    path.parent.mkdir(parents=True, exist_ok=True)
    Image.fromarray(np.uint8(255 * np.hstack(halves))).convert("L").save(path, optimize=True)


def main(arguments: list) -> int:
    parser = argparse.ArgumentParser(prog="measure_points.py", description=__doc__.split("\n", 1)[0])
    parser.add_argument("--models", type=Path, default=ROOT.parent / "shared" / "models")
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--points", type=int, default=1_000_000, help="random points of a sphere")
    parser.add_argument("--picture", type=Path, help="only draw the range map into this PNG")
    options = parser.parse_args(arguments)
    if not (options.models / "rangemap_lato315.ply.gz").is_file():
        parser.error(f"The folder {options.models} has no rangemap_lato315.ply.gz; name another with --models.")
    scan = range_map(options.models)
    if options.picture:
        draw(scan, options.picture)
    else:
        report({"range map": scan, "random points of a sphere": sphere(options.points)}, options.rounds)
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
