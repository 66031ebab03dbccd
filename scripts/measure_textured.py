# SPDX-License-Identifier: GPL-3.0-or-later
"""What texture-mapped surfels gain and cost, beside surfels of one colour each: a globe covered with text.

    PYTHON scripts/measure_textured.py [--size 256] [--rounds 5] [--picture PNG]

PYTHON is the environment that scripts/test.py makes. The truth is the texture itself on the analytic sphere, looked up
by float64 rays, 12 x 12 a pixel; PSNR is of sRGB values where the sphere is seen less than 75 degrees from its normal.
Unlit; the two kinds of surfels are timed in turns, on the standalone device: processor time of all threads.
"""

from __future__ import annotations

import argparse
import datetime
import math
import os
import platform
import statistics
import subprocess
import sys
import time
from dataclasses import replace
from functools import partial
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT))

import numpy as np  # noqa: E402

from splat_addon.reference.filters import filter_weights, resample  # noqa: E402
from splat_addon.reference.lettering import page  # noqa: E402
from splat_addon.reference.metrics import psnr, srgb  # noqa: E402
from splat_addon.reference.textures import point_colors  # noqa: E402
from splat_addon.rendering import (  # noqa: E402
    Camera,
    Instance,
    Renderer,
    Scene,
    Settings,
    SurfaceTexture,
    look_at,
    open_device,
)
from splat_addon.sampling import (  # noqa: E402
    Channel,
    Image,
    Surface,
    Texture,
    Tolerance,
    TriangleMesh,
    sample_surface,
)

RESOLUTIONS = (8, 16, 32, 64, 128, 256)
#: name -> settings and the pixel filter of its truth
METHODS = {
    "mip": (Settings(method="mip", supersampling=1, shading="flat"), "gaussian"),
    "quad, 2 x 2": (Settings(method="quad", supersampling=2, shading="flat"), "box"),
}
RAYS = 12
#: Rows of pixels whose rays are worked out at once.
STRIP = 16
LEAST_COSINE = math.cos(math.radians(75))


def text_image() -> Image:
    """Dark letters on paper that changes its colour from pole to pole; four texels a dot."""
    ink = np.kron(page(60, 20), np.ones((4, 4)))[..., None]
    share = np.linspace(0, 1, len(ink))[:, None, None]
    paper = share * (0.85, 0.75, 0.45) + (1 - share) * (0.4, 0.65, 0.85)
    colors = np.where(ink > 0, (0.03, 0.02, 0.05), paper)
    return Image(np.concatenate([colors, np.ones_like(ink)], axis=2))


def globe(image: Image, rows: int = 256) -> TriangleMesh:
    """The unit sphere with texture coordinates of longitude and latitude, its seam closed."""
    lon, lat = np.meshgrid(np.linspace(0, 1, 2 * rows + 1), np.linspace(0, 1, rows + 1))
    angle, height = 2 * np.pi * lon, np.pi * (lat - 0.5)
    points = np.stack([np.cos(height) * np.cos(angle), np.cos(height) * np.sin(angle), np.sin(height)], axis=2)
    index = np.arange(lon.size).reshape(lon.shape)
    a, b, c, d = (index[i : i + rows, j : j + 2 * rows].ravel() for i, j in ((0, 0), (0, 1), (1, 1), (1, 0)))
    triangles = np.concatenate([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)])
    uvs = np.stack([lon.ravel(), lat.ravel()], axis=1)[triangles]
    points = points.reshape(-1, 3)
    surface = Surface(Channel((1.0, 1.0, 1.0, 1.0), Texture(image)))
    return TriangleMesh(points, triangles, corner_normals=points[triangles], corner_uvs=uvs, surfaces=(surface,))


def truth(image: Image, camera: Camera, pixel_filter: str) -> tuple[np.ndarray, np.ndarray]:
    """(h, w, 3) the texture on the sphere, and (h, w) bool where only what is well seen of it is in the pixel."""
    weights = filter_weights(pixel_filter, RAYS)
    margin = (len(weights) // RAYS - 1) // 2
    size, (left, right, bottom, top) = camera.size[0], camera.window
    rows = []
    eye = camera.matrix_world[:3, 3]
    for first in range(0, size, STRIP):
        # the rays of some rows of pixels with the filter's margin
        last = min(first + STRIP, size)
        y = (np.arange((first - margin) * RAYS, (last + margin) * RAYS) + 0.5) / (size * RAYS)
        x = (np.arange(-margin * RAYS, (size + margin) * RAYS) + 0.5) / (size * RAYS)
        x, y = np.meshgrid(left + x * (right - left), bottom + y * (top - bottom))
        rays = np.stack([x, y, -np.ones_like(x)], axis=-1).reshape(-1, 3) @ camera.matrix_world[:3, :3].T
        rays /= np.linalg.norm(rays, axis=1, keepdims=True)
        along = -rays @ eye
        inside = along**2 - eye @ eye + 1
        points = eye + rays * (along - np.sqrt(np.maximum(inside, 0)))[:, None]
        seen = (inside > 0) & (-np.einsum("ij,ij->i", points, rays) > LEAST_COSINE)
        uvs = np.stack([np.arctan2(points[:, 1], points[:, 0]) / (2 * np.pi) % 1, np.zeros(len(points))], axis=1)
        uvs[:, 1] = np.arcsin(np.clip(points[:, 2], -1, 1)) / np.pi + 0.5
        values = np.zeros((len(points), 4))
        values[seen, :3], values[seen, 3] = point_colors(SurfaceTexture(image), uvs[seen]), 1
        rows.append(resample(values.reshape(*x.shape, 4), weights, RAYS))
    pixels = np.concatenate(rows)
    return pixels[..., :3], pixels[..., 3] > 1 - 1e-9


def milliseconds(jobs: list, rounds: int) -> list[float]:
    """The median processor time of each, run in turns, after one round that is not counted."""
    times = [[] for _ in jobs]
    for _ in range(rounds + 1):
        for job, taken in zip(jobs, times):
            started = time.process_time()
            job()
            taken.append(1e3 * (time.process_time() - started))
    return [statistics.median(taken[1:]) for taken in times]


def scene_of(surfels, image: Image) -> Scene:
    return Scene((Instance(surfels, textures=(SurfaceTexture(image),)),), world=(0.2, 0.2, 0.2))


def without_uvs(surfels):
    return replace(surfels, uvs=None, uv_along_x=None, uv_along_y=None)


def report(size: int, rounds: int) -> None:
    image, camera, renderer = text_image(), view(size), Renderer(open_device("standalone"))
    git = ["git", "rev-parse", "--short", "HEAD"]
    commit = subprocess.run(git, cwd=ROOT, capture_output=True, text=True).stdout.strip()
    print(
        f"{platform.machine()}, {os.cpu_count()} cores, {renderer.device.renderer}, {datetime.date.today()}, {commit}"
    )
    height, width = image.pixels.shape[:2]
    print(f"{size} x {size} pixels, texture {width} x {height}, median of {rounds} rounds, CPU ms\n")
    mesh, samplings = globe(image), {}
    for resolution in RESOLUTIONS:
        samplings[resolution] = sample_surface(mesh, resolution=resolution, texture_mapped=True).surfels
    print("| method | resolution | surfels | dB, a colour each | dB, texture-mapped | ms | ms | time |")
    print("|---|---|---|---|---|---|---|---|")
    for name, (settings, pixel_filter) in METHODS.items():
        seen, inside = truth(image, camera, pixel_filter)
        for resolution, surfels in samplings.items():
            scenes = [scene_of(s, image) for s in (without_uvs(surfels), surfels)]
            jobs = [partial(renderer.render, scene, camera, settings) for scene in scenes]
            true = [psnr(job().color[inside][None, :, :3], seen[inside][None]) for job in jobs]
            own, looked_up = milliseconds(jobs, rounds)
            print(
                f"| {name} | {resolution} | {len(surfels):,} | {true[0]:.1f} | {true[1]:.1f} | {own:.0f} "
                f"| {looked_up:.0f} | {looked_up / own:.2f} |",
                flush=True,
            )
    report_merging(image)
    report_conversion(mesh, rounds)


def report_conversion(mesh: TriangleMesh, rounds: int) -> None:
    """What it costs to keep the coordinates, in turns."""
    jobs = [partial(sample_surface, mesh, resolution=512, texture_mapped=mapped) for mapped in (False, True)]
    plain, mapped = milliseconds(jobs, rounds)
    print(f"Sampling {len(jobs[0]().surfels):,} surfels: {plain:.0f} ms, texture-mapped {mapped:.0f} ms", end="")
    print(f" ({mapped / plain:.2f})")


def report_merging(image: Image) -> None:
    """How many surfels are left of a flat, textured board where merging asks for the map or for the colours."""
    corners = np.array([(-2, -1, 0), (2, -1, 0.5), (2, 1, 1), (-2, 1, 0.5)], float)
    triangles = np.array([(0, 1, 2), (0, 2, 3)])
    uvs = np.array([(0, 0), (1, 0), (1, 1), (0, 1)], float)[triangles]
    surface = Surface(Channel((1.0, 1.0, 1.0, 1.0), Texture(image)))
    board = TriangleMesh(corners, triangles, corner_uvs=uvs, surfaces=(surface,))
    counts = []
    for tolerance, texture_mapped in ((None, False), (Tolerance(1e-3), False), (Tolerance(1e-3), True)):
        sampling = sample_surface(board, resolution=256, tolerance=tolerance, texture_mapped=texture_mapped)
        counts.append(len(sampling.surfels))
    print(f"\nA flat board of text at resolution 256: {counts[0]:,} surfels; adaptive {counts[1]:,}; ", end="")
    print(f"adaptive and texture-mapped {counts[2]:,}")


def view(size: int) -> Camera:
    eye = (2.2, -1.6, 0.9)
    return Camera.perspective(look_at(eye, (0, 0, 0)), math.radians(42), (size, size), 0.1, 10)


def draw(size: int, path: Path) -> None:
    """A colour each and texture-mapped, both of resolution 32; a colour each, of resolution 256."""
    from PIL import Image as Picture

    image, renderer = text_image(), Renderer(open_device("standalone"))
    mesh, settings = globe(image), Settings(method="mip", supersampling=1, shading="flat")
    coarse, fine = (sample_surface(mesh, resolution=r, texture_mapped=True).surfels for r in (32, 256))
    panels = [
        renderer.render(scene_of(surfels, image), view(size), settings).color[::-1, :, :3]
        for surfels in (without_uvs(coarse), coarse, without_uvs(fine))
    ]
    path.parent.mkdir(parents=True, exist_ok=True)
    picture = Picture.fromarray(np.uint8(np.rint(255 * srgb(np.concatenate(panels, axis=1)))))
    picture.quantize(128, dither=Picture.Dither.NONE).save(path, optimize=True)
    print(
        f"{path}: {len(coarse):,} surfels with a colour each, as many texture-mapped, {len(fine):,} with a colour each"
    )


def main(arguments: list) -> int:
    parser = argparse.ArgumentParser(prog="measure_textured.py", description=__doc__.split("\n", 1)[0])
    parser.add_argument("--size", type=int, default=256)
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--picture", type=Path, help="only draw into this PNG")
    options = parser.parse_args(arguments)
    if options.picture:
        draw(options.size, options.picture)
    else:
        report(options.size, options.rounds)
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
