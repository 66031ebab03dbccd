# SPDX-License-Identifier: GPL-3.0-or-later
"""Table 2 of view-independent object-space splatting for real models, and the failures of each reduction.

It shows the number of surfels (and its ratio to the original), the bare surface at the default splat size, the rms
distance of surfels from the surface, and what adaptive sampling saves.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import trimesh

from measuring.models import in_view, load, load_any, short
from splat_addon.reference.bare import uncovered_points
from splat_addon.reference.metrics import psnr
from splat_addon.rendering import Light, Renderer, Settings, open_device
from splat_addon.sampling import (
    PLAIN,
    Channel,
    Surface,
    Tolerance,
    TriangleMesh,
    VertexColors,
    drop_unusable,
    grid_spacing,
    sample_surface,
    surfels_from_points,
)
from splat_addon.surfels import Surfels

DEVICES = ("standalone",)
QUICK = {"resolution": 16, "only": ["fandisk.obj.gz"], "points": 500}
MODELS = (
    "armadillo.obj.gz", "bunny.obj.gz", "dragon_vrip.ply.gz", "spot.obj.gz", "fandisk.obj.gz", "truck.obj.gz",
    "CesiumMilkTruck.glb", "phoenix_bird.glb",
)  # fmt: skip
#: The models whose errors are measured, one for each kind of failure.
ERROR_MODELS = ("armadillo.obj.gz", "fandisk.obj.gz", "truck.obj.gz", "phoenix_bird.glb")
ADAPTIVE_MODELS = ("fandisk.obj.gz", "CesiumMilkTruck.glb", "truck.obj.gz", "spot.obj.gz", "armadillo.obj.gz")
TOLERANCES = (0.05, 0.25)
#: The paper's Table 2: original, 3-to-1, Zwicker's, the normal-based reduction.
PUBLISHED = {
    "Tiny": (311_028, 180_947, 271_682, 177_782),
    "Tiger": (206_064, 140_203, 180_282, 136_143),
    "Butterfly": (251_897, 212_943, 251_480, 224_144),
}
#: Order of the rows.
COLUMNS = {"none": "original", "three_to_one": "3-to-1", "grazing": "Zwicker's (70 deg)", "normal": "normal"}
#: With the paper's own, which chooses by the surfel's normal where ours chooses by the triangle's.
COUNTED = {**COLUMNS, "surfel_normal": "surfel's normal (the paper's)"}
ADAPTIVE = "model", "tolerance", "surfels", "times fewer", "error reported", "largest distance found", "bare"


def arguments(parser) -> None:
    parser.add_argument("--resolution", type=float, default=256)
    parser.add_argument("--only", nargs="+", choices=MODELS, default=MODELS, metavar="FILE", help="of these models")
    parser.add_argument("--points", type=int, default=40_000, help="of the surface, asked whether they are bare")


def run(options, report) -> None:
    renderer = Renderer(open_device(options.device))
    report.header(how=f"resolution {options.resolution:g}")
    meshes = {name: drop_unusable(load(options.models / name))[0] for name in report.steps(options.only, "Loading")}
    draw(meshes, renderer, report)
    draw_points(options.models / "rangemap_lato315.ply.gz", renderer, report)
    report.table(["model", *COUNTED.values()], counts(meshes, options), "Surfels (share of the original):")
    about = "Bare surface at the default splat size, and distance of the surfels from the surface (rms):"
    report.table(["model", *COLUMNS.values()], errors(meshes, options), about)
    report.table(ADAPTIVE, adaptive(meshes, options), "Adaptive:")


def counts(meshes: dict, options):
    """The paper's table, and below it our models."""
    for name, published in PUBLISHED.items():
        *others, own = with_ratio(published)
        yield f"*published: {name}*", *others, "", own
    for name, mesh in meshes.items():
        made = [len(sampled(mesh, options.resolution, reduction)) for reduction in COUNTED]
        yield short(name), *with_ratio(made)


def with_ratio(numbers) -> list[str]:
    """The first number as it is, the others with their ratio to it."""
    return [f"{numbers[0]:,}", *(f"{number:,} ({number / numbers[0]:.3f})" for number in numbers[1:])]


def errors(meshes: dict, options):
    """The price of each reduction: bare surface, and surfels off the surface."""
    for name in (n for n in ERROR_MODELS if n in meshes):
        mesh, cells = meshes[name], []
        spacing = grid_spacing(mesh, resolution=options.resolution)
        for reduction in COLUMNS:
            surfels = sampled(mesh, options.resolution, reduction)
            distance = distances(mesh, surfels, np.random.default_rng(0).choice(len(surfels), options.points // 10))
            rms = np.sqrt((distance**2).mean()) / spacing
            cells.append(f"{bare(mesh, surfels, spacing, options):.3%}, {rms:.3f} H")
        yield short(name), *cells


def bare(mesh: TriangleMesh, surfels: Surfels, spacing: float, options) -> float:
    return len(uncovered_points(mesh, surfels, spacing, options.points)) / options.points


def distances(mesh: TriangleMesh, surfels: Surfels, rows) -> np.ndarray:
    """Distances of a subset of the surfels' centres from the mesh."""
    exact = trimesh.Trimesh(mesh.positions, mesh.triangles, process=False)
    return trimesh.proximity.closest_point(exact, surfels.origin + surfels.positions[rows].astype(np.float64))[1]


def adaptive(meshes: dict, options):
    """Surfels left by adaptive sampling of the normal-based reduction, the error bound that it reports, and the
    measured error."""
    for name in (n for n in ADAPTIVE_MODELS if n in meshes):
        mesh = meshes[name]
        spacing = grid_spacing(mesh, resolution=options.resolution)
        for cells in TOLERANCES:
            larger = PLAIN | {"tolerance": Tolerance(cells * spacing)}
            made = sample_surface(mesh, resolution=options.resolution, **larger)
            surfels, left = made.surfels, len(made.surfels)
            merged = np.flatnonzero(surfels.scales[:, 1] > 1.3 * spacing)[: options.points // 10]
            found = distances(mesh, surfels, merged).max(initial=0) / spacing
            whole, share = left + made.saved, bare(mesh, surfels, spacing, options)
            row = short(name), f"{cells} H", f"{left:,} of {whole:,}", f"{whole / left:.2f}"
            yield *row, f"{made.error / spacing:.3f} H", f"{found:.3f} H", f"{share:.3%}"


def sampled(mesh: TriangleMesh, resolution: float, reduction: str) -> Surfels:
    """Samples without the surfels of parts that no ray hits."""
    made = sample_surface(mesh, resolution=resolution, reduction=reduction, **PLAIN)
    rows = slice(len(made.surfels) - made.small_parts)
    return replace(made.surfels, **{name: array[rows] for name, array in made.surfels.arrays().items()})


def draw(meshes: dict, renderer: Renderer, report) -> None:
    """Draw the failures of reductions side by side, and the same mesh sampled plainly and adaptively."""
    if "phoenix_bird.glb" in meshes:
        bird = colored_by_side(meshes["phoenix_bird.glb"])
        view = bird.bounds(), (0.3, 0.8, 0.5), (0, 1, 0), 0.75
        shown = [sampled(bird, 256, reduction) for reduction in ("none", "normal", "three_to_one")]
        report.picture("phoenix_bird", [render(renderer, surfels, *view) for surfels in shown], colors=128)
    if "CesiumMilkTruck.glb" in meshes:
        mesh = meshes["CesiumMilkTruck.glb"]
        view = mesh.bounds(), (0.9, 0.5, 0.9), (0, 1, 0), 1.45
        spacing = grid_spacing(mesh, resolution=200)
        plain = sample_surface(mesh, resolution=200, **PLAIN).surfels
        merged = sample_surface(mesh, resolution=200, **(PLAIN | {"tolerance": Tolerance(0.1 * spacing)})).surfels
        views = [render(renderer, surfels, *view, sun=True) for surfels in (plain, merged)]
        report.say(f"Adaptive van: {len(plain):,} and {len(merged):,} surfels, PSNR {psnr(*views):.1f} dB.")
        sizes = np.log2(merged.scales[:, 1] / merged.scales[:, 1].min()).clip(0, 3) / 3
        by_size = np.column_stack([sizes, 0.3 + 0.4 * sizes, 1 - sizes, np.ones(len(sizes))])
        views.append(render(renderer, replace(merged, colors=by_size), *view))
        report.picture("adaptive", views, colors=128)


def draw_points(path, renderer: Renderer, report) -> None:
    """Draw a range map's bare points, and the surfels made from them."""
    points = load_any(path).vertices
    facing, dark = np.tile((0.0, 0.0, 1.0), (len(points), 1)), np.full((len(points), 4), (0.05, 0.05, 0.05, 1))
    bare, *_ = surfels_from_points(points, facing, np.full(len(points), 0.12), dark)
    whole, *_ = surfels_from_points(points, viewpoint=(0, 0, 0))
    view = (points.min(axis=0), points.max(axis=0)), (0, -0.05, 1), (0, 1, 0), 1.2
    views = render(renderer, bare, *view), render(renderer, whole, *view, sun=True)
    report.picture("range_map", views, colors=128)


def colored_by_side(mesh: TriangleMesh) -> TriangleMesh:
    """Orange where the surface faces down (-y), blue where it faces up."""
    a, b, c = np.moveaxis(mesh.positions[mesh.triangles], 1, 0)
    up = np.cross(b - a, c - a)[:, 1] > 0
    colors = np.where(up[:, None], (0.05, 0.25, 0.8, 1), (0.9, 0.3, 0.05, 1))
    surface = Surface(Channel((1, 1, 1, 1), VertexColors()))
    return replace(mesh, corner_colors=np.repeat(colors[:, None], 3, axis=1), surfaces=(surface,))


def render(renderer: Renderer, surfels: Surfels, box, toward, up, distance: float, sun: bool = False) -> np.ndarray:
    """(400, 400, 4) picture of the surfels in their own colours, or under a sun. distance: in diagonals of the box."""
    eye = 2 * distance * np.array(toward) / np.linalg.norm(toward)
    scene, camera = in_view(surfels, 400, eye, fov=0.6, up=up, box=box)
    lights = (Light("sun", energy=2.0, direction=(-0.7, -0.8, -0.4)),) if sun else ()
    scene = replace(scene, lights=lights, world=(0.3, 0.3, 0.3) if sun else (1.0, 1.0, 1.0))
    settings = Settings(method="quad", shading="principled" if sun else "flat", supersampling=3)
    return renderer.render(scene, camera, settings).color
