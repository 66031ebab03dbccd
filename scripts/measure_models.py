# SPDX-License-Identifier: GPL-3.0-or-later
"""From mesh to picture on the standalone device: speeds, and how true the picture is, on real models.

    PYTHON scripts/measure_models.py [--models FOLDER] [--size 512] [--rounds 5] [--out FOLDER]

PYTHON is the environment that scripts/test.py makes. PSNR is of sRGB values against `render_exact` with the same
samples a pixel, and again against 8 x 8 samples, both box-filtered.
"""

from __future__ import annotations

import argparse
import datetime
import gzip
import os
import platform
import statistics
import subprocess
import sys
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT))

import numpy as np  # noqa: E402
import trimesh  # noqa: E402
from PIL import Image  # noqa: E402

from splat_addon.reference import render_exact  # noqa: E402
from splat_addon.reference.metrics import psnr, srgb  # noqa: E402
from splat_addon.rendering import Camera, Light, Renderer, Scene, Settings, look_at, open_device  # noqa: E402
from splat_addon.sampling import TriangleMesh, sample_mesh  # noqa: E402

CASES = (("armadillo.obj.gz", 256), ("dragon_vrip.ply.gz", 1024))


def load(path: Path) -> TriangleMesh:
    """A mesh with smooth vertex normals."""
    with gzip.open(path) as file:
        loaded = trimesh.load(file, file_type=path.suffixes[0][1:], process=False, force="mesh")
    triangles = np.asarray(loaded.faces)
    return TriangleMesh(loaded.vertices, triangles, corner_normals=np.asarray(loaded.vertex_normals)[triangles])


def scene_of(surfels, size: int) -> tuple[Scene, Camera]:
    """The model in three-quarter view under a sun."""
    low, high = (surfels.origin + corner for corner in surfels.local_bounds)
    middle, reach = (low + high) / 2, float(np.linalg.norm(high - low)) / 2
    eye = middle + reach * np.array((1.2, 0.7, 2.6))
    camera = Camera.perspective(look_at(eye, middle, (0, 1, 0)), 0.66, (size, size), reach / 100, reach * 10)
    return Scene((surfels,), (Light("sun", energy=3, direction=(-0.5, -0.8, -0.6)),), (0.2, 0.2, 0.2)), camera


def median_seconds(job, rounds: int) -> float:
    """Of `rounds` calls, after one that is not counted."""
    times = []
    for _ in range(rounds + 1):
        started = time.perf_counter()
        job()
        times.append(time.perf_counter() - started)
    return statistics.median(times[1:])


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--models", type=Path, default=ROOT.parent / "shared" / "models")
    parser.add_argument("--size", type=int, default=512)
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--out", type=Path, default=ROOT / "build" / "measure")
    options = parser.parse_args()
    options.out.mkdir(parents=True, exist_ok=True)
    renderer, settings = Renderer(open_device("standalone")), Settings(method="quad", supersampling=2)
    git = ["git", "rev-parse", "--short", "HEAD"]
    commit = subprocess.run(git, cwd=ROOT, capture_output=True, text=True).stdout.strip()
    machine = f"{platform.machine()}, {os.cpu_count()} cores, {renderer.device.renderer}"
    print(f"{machine}, {datetime.date.today()}, commit {commit}")
    samples = settings.supersampling
    print(f"{options.size} x {options.size}, {samples} x {samples} samples, method {settings.method}")
    columns = "model", "surfels", "M surfels/s", "frame ms", "M splats/s", "PSNR, same samples", "PSNR, 8 x 8"
    print(f"| {' | '.join(columns)} |\n|{'---|' * len(columns)}")
    for name, resolution in CASES:
        mesh = load(options.models / name)
        surfels = sample_mesh(mesh, resolution=resolution)
        sampling = median_seconds(lambda m=mesh, r=resolution: sample_mesh(m, resolution=r), options.rounds)
        scene, camera = scene_of(surfels, options.size)
        drawing = median_seconds(lambda s=scene, c=camera: renderer.render(s, c, settings), options.rounds)
        frame = renderer.render(scene, camera, settings)
        same, fine = (render_exact(scene, camera, settings, samples=n).color for n in (settings.supersampling, 8))
        pixels = (255 * srgb(frame.color[::-1, :, :3]) + 0.5).astype(np.uint8)
        Image.fromarray(pixels).save(options.out / f"{name.split('.')[0]}.png")
        count = len(surfels)
        cells = (
            f"{name.split('.')[0]} at {resolution}",
            f"{count:,}",
            f"{count / sampling / 1e6:.2f}",
            f"{1e3 * drawing:.0f}",
            f"{count / drawing / 1e6:.2f}",
            f"{psnr(frame.color, same):.1f} dB",
            f"{psnr(frame.color, fine):.1f} dB",
        )
        print("| " + " | ".join(cells) + " |", flush=True)


if __name__ == "__main__":
    main()
