# SPDX-License-Identifier: GPL-3.0-or-later
"""How far surfels lie from their triangles at most, in float64: soups of random triangles and thin slivers.

    PYTHON scripts/measure_exactness.py [--resolutions 64 256 1024] [--soups 24]

PYTHON must have numpy (the environment that scripts/test.py makes). Sizes lie between powers of two, where
float32 is coarsest; slivers are down to 1e-9 of their length.
"""

import argparse
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT))

import numpy as np  # noqa: E402

from scripts.distances import distances  # noqa: E402
from splat_addon.sampling import TriangleMesh, drop_unusable, grid_spacing, sample_surface  # noqa: E402

TRIANGLES = 6


def soup(random: np.random.Generator, has_slivers: bool) -> TriangleMesh:
    """Each triangle is a material of its own, by which a surfel tells whose it is."""
    corners = random.random((TRIANGLES, 3, 3))
    corners[0, :2] = (0, 0, 0), (1, 1, 1)
    if has_slivers:
        thinner = 10.0 ** random.uniform(-9, -2, (TRIANGLES - 1, 1))
        corners[1:, 2] = corners[1:, 1] + (corners[1:, 2] - corners[1:, 1]) * thinner
    triangles = np.arange(3 * TRIANGLES).reshape(-1, 3)
    mesh, _ = drop_unusable(TriangleMesh(corners.reshape(-1, 3) * random.uniform(1, 2), triangles))
    return TriangleMesh(mesh.positions, mesh.triangles, materials=np.arange(len(mesh), dtype=np.int32))


def farthest(mesh: TriangleMesh, resolution: int) -> tuple[float, int]:
    """The largest distance, in cells, and of how many surfels. Those of parts between all rays are left out."""
    sampling = sample_surface(mesh, resolution=resolution)
    surfels = sampling.surfels
    count = len(surfels) - sampling.small_parts
    points = surfels.origin + surfels.positions[:count].astype(np.float64)
    owner = surfels.materials[:count]
    triangles = mesh.positions[mesh.triangles]
    away = max(distances(points[owner == k], *triangle).max(initial=0) for k, triangle in enumerate(triangles))
    return float(away) / grid_spacing(mesh, resolution=resolution), count


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--resolutions", type=int, nargs="+", default=[64, 97, 256, 1024])
    parser.add_argument("--soups", type=int, default=24)
    options = parser.parse_args()
    print("| resolution R | surfels | farthest, H | in R 2^-24 H |\n|---|---|---|---|")
    for resolution in options.resolutions:
        random = np.random.default_rng(resolution)
        found = [farthest(soup(random, number % 2 == 1), resolution) for number in range(options.soups)]
        worst = max(away for away, _ in found)
        count = sum(count for _, count in found)
        print(f"| {resolution} | {count:,} | {worst:.2g} | {worst / resolution * 2**24:.2f} |", flush=True)


if __name__ == "__main__":
    main()
