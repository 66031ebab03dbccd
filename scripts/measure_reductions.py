# SPDX-License-Identifier: GPL-3.0-or-later
"""Table 2 of view-independent object-space splatting for real models, and where each reduction fails.

    PYTHON scripts/measure_reductions.py [--models DIR] [--resolution 256] [--out docs/conversion]

PYTHON must have numpy, scipy, trimesh, Pillow and moderngl (the environment that scripts/test.py makes). Prints three
Markdown tables and renders docs/conversion's pictures. Choosing by the shading normal is here as a counter-example
alone; the product has no such reduction.
"""

from __future__ import annotations

import argparse
import datetime
import gzip
import io
import os
import platform
import subprocess
import sys
from dataclasses import replace
from pathlib import Path
from unittest.mock import patch

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT))

import numpy as np  # noqa: E402
import trimesh  # noqa: E402
from PIL import Image  # noqa: E402

from scripts.coverage import uncovered_points  # noqa: E402
from splat_addon.reference.metrics import psnr, srgb  # noqa: E402
from splat_addon.rendering import Camera, Light, Renderer, Scene, Settings, look_at, open_device  # noqa: E402
from splat_addon.sampling import (  # noqa: E402
    REDUCTIONS,
    Channel,
    Surface,
    Tolerance,
    TriangleMesh,
    VertexColors,
    drop_unusable,
    grid_spacing,
    sample_surface,
)
from splat_addon.sampling.adaptive import MERGED_SIZE  # noqa: E402
from splat_addon.sampling.reductions import Reduction  # noqa: E402
from splat_addon.surfels import Surfels  # noqa: E402

MODELS = (
    "armadillo.obj.gz",
    "bunny.obj.gz",
    "dragon_vrip.ply.gz",
    "spot.obj.gz",
    "fandisk.obj.gz",
    "truck.obj.gz",
    "CesiumMilkTruck.glb",
    "phoenix_bird.glb",
)

#: The paper's Table 2: original, 3-to-1, Zwicker's, ours (the normal-based reduction).
PUBLISHED = {
    "Tiny": (311_028, 180_947, 271_682, 177_782),
    "Tiger": (206_064, 140_203, 180_282, 136_143),
    "Butterfly": (251_897, 212_943, 251_480, 224_144),
}

#: The table's order, then what the product does not have.
COLUMNS = {
    "none": "original",
    "three_to_one": "3-to-1",
    "grazing": "Zwicker's (70 deg)",
    "normal": "normal",
    "shading normal": "by shading normal",
}

#: The models whose errors are measured, for each kind of failure one.
ERROR_MODELS = ("armadillo.obj.gz", "fandisk.obj.gz", "truck.obj.gz", "phoenix_bird.glb")
ADAPTIVE_MODELS = ("fandisk.obj.gz", "CesiumMilkTruck.glb", "truck.obj.gz", "spot.obj.gz", "armadillo.obj.gz")
ADAPTIVE_TOLERANCES = (0.05, 0.25)
ERROR_POINTS, DISTANCE_POINTS = 40_000, 4_000


def load(path: Path) -> TriangleMesh:
    """A model, gzipped or not, with the file's or smooth normals at its corners, without colours."""
    content, name = path.read_bytes(), path.name
    if name.endswith(".gz"):
        content, name = gzip.decompress(content), name[: -len(".gz")]
    kind = name.rsplit(".", 1)[1]
    loaded = trimesh.load(io.BytesIO(content), file_type=kind, force="mesh", process=False)
    corner_normals = np.asarray(loaded.vertex_normals, np.float32)[loaded.faces]
    mesh = TriangleMesh(loaded.vertices, np.asarray(loaded.faces, np.int32), corner_normals=corner_normals)
    return drop_unusable(mesh)[0]


def sampled(mesh: TriangleMesh, resolution: float, reduction: str) -> Surfels:
    """By a reduction of the product, or by the shading normal; without the surfels of parts that no ray meets."""
    if reduction == "shading normal":
        return sampled_by_shading_normal(mesh, resolution)
    sampling = sample_surface(mesh, resolution=resolution, reduction=reduction)
    return kept(sampling.surfels, slice(len(sampling.surfels) - sampling.small_parts))


def sampled_by_shading_normal(mesh: TriangleMesh, resolution: float) -> Surfels:
    """Of each image's samples those whose interpolated normal points along its axis more than along the others."""
    parts = []
    for axis in range(3):
        keeps = lambda normals, grazing_angle, a=axis: (normals > 0) & (np.arange(3)[:, None] == a)  # noqa: E731
        with patch.dict(REDUCTIONS, alone=Reduction("", "", keeps, keeps)):
            whole = sampled(mesh, resolution, "alone")
        parts.append(kept(whole, np.abs(whole.normals).argmax(axis=1) == axis))
    return replace(parts[0], **{name: np.concatenate([p.arrays()[name] for p in parts]) for name in parts[0].arrays()})


def kept(surfels: Surfels, rows) -> Surfels:
    return replace(surfels, **{name: array[rows] for name, array in surfels.arrays().items()})


def print_counts(meshes: dict, resolution: float) -> None:
    """The paper's table with our models below its own."""
    print(f"| model | {' | '.join(COLUMNS.values())} |\n{'|---' * (len(COLUMNS) + 1)}|")
    for name, counts in PUBLISHED.items():
        print(f"| *published: {name}* | {' | '.join(with_ratio(counts))} | |")
    for name, mesh in meshes.items():
        counts = [len(sampled(mesh, resolution, reduction)) for reduction in COLUMNS]
        print(f"| {name.split('.')[0]} | {' | '.join(with_ratio(counts))} |", flush=True)


def with_ratio(counts) -> list[str]:
    """The first as it is, the others with their share of it."""
    return [f"{counts[0]:,}", *(f"{count:,} ({count / counts[0]:.3f})" for count in counts[1:])]


def print_errors(meshes: dict, resolution: float) -> None:
    """What the counts cost: bare surface, and surfels off the surface."""
    print(f"| model | {' | '.join(COLUMNS.values())} |\n{'|---' * (len(COLUMNS) + 1)}|")
    for name in ERROR_MODELS:
        if name not in meshes:
            continue
        mesh, cells = meshes[name], []
        spacing = grid_spacing(mesh, resolution=resolution)
        exact = trimesh.Trimesh(mesh.positions, mesh.triangles, process=False)
        for reduction in COLUMNS:
            surfels = sampled(mesh, resolution, reduction)
            bare = len(uncovered_points(mesh, surfels, spacing, ERROR_POINTS)) / ERROR_POINTS
            some = np.random.default_rng(0).choice(len(surfels), DISTANCE_POINTS)
            points = surfels.origin + surfels.positions[some].astype(np.float64)
            distance = trimesh.proximity.closest_point(exact, points)[1] / spacing
            cells.append(f"{100 * bare:.3f} %, {np.sqrt((distance**2).mean()):.3f} H")
        print(f"| {name.split('.')[0]} | {' | '.join(cells)} |", flush=True)


def print_adaptive(meshes: dict, resolution: float) -> None:
    """Surfels left by adaptive sampling of the normal reduction, the bound it reports, and what is true of it."""
    heads = "model", "tolerance", "surfels", "times fewer", "error reported", "largest distance found", "bare"
    print(f"| {' | '.join(heads)} |\n{'|---' * len(heads)}|")
    for name in (n for n in ADAPTIVE_MODELS if n in meshes):
        mesh = meshes[name]
        spacing = grid_spacing(mesh, resolution=resolution)
        exact = trimesh.Trimesh(mesh.positions, mesh.triangles, process=False)
        for cells in ADAPTIVE_TOLERANCES:
            sampling = sample_surface(mesh, resolution=resolution, tolerance=Tolerance(cells * spacing))
            surfels, left = sampling.surfels, len(sampling.surfels)
            merged = np.flatnonzero(surfels.scales[:, 1] > 1.3 * spacing)[:DISTANCE_POINTS]
            points = surfels.origin + surfels.positions[merged].astype(np.float64)
            distance = trimesh.proximity.closest_point(exact, points)[1].max() / spacing
            bare = len(uncovered_points(mesh, surfels, spacing, ERROR_POINTS)) / ERROR_POINTS
            cells_of_row = (
                name.split(".")[0], f"{cells} H", f"{left:,} of {left + sampling.saved:,}",
                f"{(left + sampling.saved) / left:.2f}", f"{sampling.error / spacing:.3f} H", f"{distance:.3f} H",
                f"{100 * bare:.3f} %",
            )  # fmt: skip
            print(f"| {' | '.join(cells_of_row)} |", flush=True)


def smooth_cube() -> TriangleMesh:
    """A cube coloured by face; its vertex normals are means over triangles, as many exporters write them."""
    box = trimesh.creation.box()
    colors = np.ones((12, 3, 4))
    colors[..., :3] = 0.25 + 0.5 * np.abs(box.face_normals)[:, None]
    normals = np.zeros((8, 3))
    np.add.at(normals, box.faces, box.face_normals[:, None])
    return colored(TriangleMesh(box.vertices, box.faces, corner_normals=normals[box.faces]), colors)


def colored(mesh: TriangleMesh, corner_colors: np.ndarray) -> TriangleMesh:
    return replace(mesh, corner_colors=corner_colors, surfaces=(Surface(Channel((1, 1, 1, 1), VertexColors())),))


def colored_by_side(mesh: TriangleMesh) -> TriangleMesh:
    """Orange where the surface faces down (-y), blue where it faces up."""
    a, b, c = np.moveaxis(mesh.positions[mesh.triangles], 1, 0)
    up = np.cross(b - a, c - a)[:, 1] > 0
    colors = np.where(up[:, None], (0.05, 0.25, 0.8, 1), (0.9, 0.3, 0.05, 1))
    return colored(mesh, np.repeat(colors[:, None], 3, axis=1))


#: file -> mesh, resolution, reductions side by side, direction and distance of the eye in box diagonals, up, target
def pictures(meshes: dict) -> dict:
    shots = {"smooth_cube": (smooth_cube(), 100, ("normal", "shading normal"), (0.75, -1.1, 0.7), (0, 0, 1), 1.7)}
    if "phoenix_bird.glb" in meshes:
        bird = colored_by_side(meshes["phoenix_bird.glb"])
        shots["phoenix_bird"] = (bird, 256, ("none", "normal", "three_to_one"), (0.3, 0.8, 0.5), (0, 1, 0), 0.75)
    return shots


def render(renderer: Renderer, surfels: Surfels, box, toward, up, distance: float, sun: bool = False) -> np.ndarray:
    """(400, 400, 4) of the surfels in their own colours, or under a sun; the eye is set by the box of the mesh."""
    (low, high), shading = box, "principled" if sun else "flat"
    middle, diagonal = (low + high) / 2, float(np.linalg.norm(high - low))
    eye = middle + diagonal * distance * np.array(toward) / np.linalg.norm(toward)
    camera = Camera.perspective(look_at(eye, middle, up), 0.6, (400, 400), diagonal / 100, diagonal * 10)
    lights = (Light("sun", energy=2.0, direction=(-0.7, -0.8, -0.4)),) if sun else ()
    scene = Scene((surfels,), lights, (0.3, 0.3, 0.3) if sun else (1.0, 1.0, 1.0))
    return renderer.render(scene, camera, Settings(method="quad", shading=shading, supersampling=3)).color


def save(views: list, path: Path) -> None:
    """Linear pictures side by side, as a PNG of 128 colours."""
    pixels = (255 * srgb(np.concatenate(views, axis=1)[::-1, :, :3]) + 0.5).astype(np.uint8)
    Image.fromarray(pixels).quantize(128).save(path, optimize=True)


def save_adaptive(renderer: Renderer, mesh: TriangleMesh, path: Path) -> None:
    """The same mesh sampled plainly, adaptively, and adaptively with the surfels coloured by size."""
    spacing = grid_spacing(mesh, resolution=200)
    options = {"resolution": 200, "tolerance": Tolerance(0.1 * spacing)}
    plain, merged = sample_surface(mesh, resolution=200).surfels, sample_surface(mesh, **options).surfels
    sizes = np.rint(np.log2(merged.scales[:, 1] / (MERGED_SIZE * spacing))).clip(0).astype(int)
    shade = np.random.default_rng(0).uniform(0.6, 1, (len(merged), 1))
    by_size = np.array([(0.6, 0.6, 0.6), (0.1, 0.5, 0.8), (0.1, 0.7, 0.2), (0.9, 0.4, 0.05)])[sizes] * shade
    shown = replace(merged, colors=np.concatenate([by_size, np.ones_like(shade)], axis=1))
    view = mesh.bounds(), (0.9, 0.5, 0.9), (0, 1, 0), 1.45
    views = [render(renderer, plain, *view, sun=True), render(renderer, merged, *view, sun=True)]
    print(f"{path.stem}: {len(plain):,} and {len(merged):,} surfels, PSNR {psnr(*views):.1f} dB")
    save([*views, render(renderer, shown, *view)], path)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--models", type=Path, default=ROOT.parent / "shared" / "models")
    parser.add_argument("--resolution", type=float, default=256)
    parser.add_argument("--out", type=Path, default=ROOT / "docs" / "conversion")
    parser.add_argument("--pictures-only", action="store_true")
    options = parser.parse_args()
    options.out.mkdir(parents=True, exist_ok=True)
    meshes = {name: load(options.models / name) for name in MODELS if (options.models / name).is_file()}
    for name in set(MODELS) - meshes.keys():
        print(f"{name} is left out: it is not in {options.models}.", file=sys.stderr)
    renderer = Renderer(open_device("standalone"))
    for name, (mesh, resolution, reductions, toward, up, distance) in pictures(meshes).items():
        view = mesh.bounds(), toward, up, distance
        save([render(renderer, sampled(mesh, resolution, r), *view) for r in reductions], options.out / f"{name}.png")
    if "CesiumMilkTruck.glb" in meshes:
        save_adaptive(renderer, meshes["CesiumMilkTruck.glb"], options.out / "adaptive.png")
    if options.pictures_only:
        return
    git = ["git", "rev-parse", "--short", "HEAD"]
    commit = subprocess.run(git, cwd=ROOT, capture_output=True, text=True).stdout.strip()
    print(f"{platform.machine()}, {os.cpu_count()} cores, {datetime.date.today()}, commit {commit}")
    print(f"\nSurfels at resolution {options.resolution:g} (share of the original):\n")
    print_counts(meshes, options.resolution)
    print("\nBare surface at the default splat size, and distance of the surfels from the surface (rms):\n")
    print_errors(meshes, options.resolution)
    print("\nAdaptive:\n")
    print_adaptive(meshes, options.resolution)


if __name__ == "__main__":
    main()
