# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes scanned by a simulated scanner, with noise, strays and occlusion: how right their surfels are.

Six places around the model send rays on spherical grids; *noise* is the standard deviation along each axis, in
spacings; *strays* are spread evenly over the model's box. *10 degrees*: share of the points whose normal is within that
of the mesh's. *wrong side*: share beyond 90. *strays*, *lost*: shares of the strays, and of the good points, that were
left out; strays within three deviations of the surface do not count. *PSNR*: of the picture under a sun, against the
mesh's own normals in float64, where the scanner saw the mesh. *Flattened*: with noise flattened. *The mesh*: with its
normals at the places nearest to the noisy points, about the best that can be known of them. Points a second are those
of one processor's time, and of the clock.
"""

from __future__ import annotations

from functools import partial
from pathlib import Path

import numpy as np

from bench.representation.meshes import load_colored
from bench.scanned.others import of_checkout, of_open3d, of_the_mesh, ours
from bench.scanned.pictures import Views
from bench.scanned.scanner import Scan, scanned
from measuring.models import short
from splat_addon.rendering import Renderer, open_device

DEVICES = ("blender",)
QUICK = {"model": ["spot.obj.gz"], "points": 4000, "size": 48, "views": 1}
MODELS = (
    "bunny.obj.gz", "armadillo.obj.gz", "dragon_vrip.ply.gz", "fandisk.obj.gz", "spot.obj.gz", "truck.obj.gz",
    "CesiumMilkTruck.glb", "rangemap_lato315.ply.gz",
)  # fmt: skip
COLUMNS = (
    "model", "points", "places", "by", "10 degrees", "wrong side", "strays", "lost", "largest radius", "PSNR",
    "points/s of a processor", "of the clock",
)  # fmt: skip


def arguments(parser) -> None:
    parser.add_argument("--model", nargs="+", default=MODELS, help="files among the models")
    parser.add_argument("--points", type=int, default=200_000)
    parser.add_argument("--noise", type=float, default=0.5, help="in spacings")
    parser.add_argument("--strays", type=float, default=0.01, help="their share of the points")
    parser.add_argument("--size", type=int, default=256, help="pixels along each side")
    parser.add_argument("--views", type=int, default=2, choices=(1, 2, 3))
    parser.add_argument("--beside", type=Path, nargs="*", default=(), help="other checkouts of this project")
    parser.add_argument("--open3d", type=Path, help="a Python that has Open3D, to compare with")


def run(options, report) -> None:
    renderer = Renderer(open_device(options.device))
    report.header(renderer.device, f"noise of {options.noise:g} spacings, {options.strays:.0%} strays")
    report.table(COLUMNS, rows(options, report, renderer))


def rows(options, report, renderer):
    ways = {"this": ours, "flattened": partial(ours, flattens_noise=True), "the mesh": of_the_mesh} | {
        str(checkout): partial(of_checkout, checkout) for checkout in options.beside
    }
    if options.open3d:
        ways["Open3D"] = partial(of_open3d, options.open3d)
    for file in options.model:
        mesh = load_colored(options.models, file)
        scan = scanned(mesh, options.points, options.noise, options.strays)
        views = Views(mesh, scan, options)
        for places in ("known", "unknown"):
            for by, way in ways.items():
                surfels, kept, (clock, work) = way(scan, scan.scanners if places == "known" else None)
                psnr, pictures = views.compare(renderer, surfels)
                report.picture(f"{short(file)}_{places}_{Path(by).name}", pictures)
                count = len(scan.points)
                yield (
                    short(file), f"{count:,}", places, Path(by).name, *shares(scan, surfels, kept), f"{psnr:.1f}",
                    f"{count / work:,.0f}", f"{count / clock:,.0f}",
                )  # fmt: skip


def shares(scan: Scan, surfels, kept: np.ndarray) -> list[str]:
    """Table cells of one cloud: normals, sides, strays, lost points, and the largest radius in medians."""
    is_kept = np.zeros(len(scan.points), bool)
    is_kept[kept] = True
    good = ~scan.is_stray[kept]
    cosines = (surfels.normals[good] * scan.normals[kept[good]]).sum(axis=1)
    found = (
        (np.abs(cosines) > np.cos(np.radians(10))).mean(), (cosines < 0).mean(),
        1 - is_kept[scan.is_stray & ~scan.is_near].mean(), 1 - is_kept[~scan.is_stray].mean(),
    )  # fmt: skip
    return [*(f"{share:.2%}" for share in found), f"{surfels.radius.max() / np.median(surfels.radius):.1f}"]
