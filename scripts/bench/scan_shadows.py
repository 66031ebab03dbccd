# SPDX-License-Identifier: GPL-3.0-or-later
"""Shadows in lit pictures of scans: noisy ones of models, and one of a crown of leaves, beside rays to the mesh.

A sun is the only light. The truth follows 3 x 3 rays a pixel to the mesh, and from there one to the sun, in the pixels
that the scanner saw. *Lit*, *shadow*: PSNR where all rays reach the sun, or none does. *Black*: share of the pixels
below 25 of 255, and in the truth. The crown has opaque square leaves that are turned at random in an ellipsoid.
"""

from __future__ import annotations

from dataclasses import replace

import bpy  # noqa: F401 - mathutils comes with it
import numpy as np
from mathutils import Vector
from mathutils.bvhtree import BVHTree

from bench.representation.lit import BASE, SETTINGS, STRENGTH, SUN, blinn, parallel
from bench.representation.meshes import load_colored
from bench.scanned.scanner import Scan, scanned
from measuring.models import short
from splat_addon.reference.metrics import srgb
from splat_addon.rendering import Instance, Light, Material, Renderer, Scene, open_device
from splat_addon.sampling import TriangleMesh, surfels_from_points

DEVICES = ("blender",)
QUICK = {"model": ["leaves"], "points": 4000, "size": 32}
COLUMNS = "model", "surfels", "whole picture", "lit", "shadow", "black", "black in truth"
LEAVES = "leaves"
#: Leaves of the crown, their edge, and the crown's half-axes.
COUNT, EDGE, CROWN = 8000, 0.08, (1.0, 1.0, 1.3)
ROUGHNESS, RAYS, BLACK = 0.8, 3, 25 / 255
#: Pixels whose middle is farther from every hit of the scanner, in spacings, do not count.
_FARTHEST = 2.0


def arguments(parser) -> None:
    parser.add_argument("--model", nargs="+", default=("spot.obj.gz", "armadillo.obj.gz", LEAVES), help="or leaves")
    parser.add_argument("--points", type=int, default=100_000)
    parser.add_argument("--noise", type=float, default=0.5, help="in spacings")
    parser.add_argument("--size", type=int, default=256, help="pixels along each side")


def run(options, report) -> None:
    renderer = Renderer(open_device(options.device))
    report.header(renderer.device, f"noise of {options.noise:g} spacings")
    report.table(COLUMNS, rows(options, report, renderer))


def rows(options, report, renderer):
    for name in options.model:
        mesh = crown() if name == LEAVES else load_colored(options.models, name)
        scan, camera = scanned(mesh, options.points, options.noise, 0.0), parallel(mesh, 0, options.size)
        truth, reached, counts = followed(mesh, scan, camera)
        for how, flattens, resolution in (("as scanned", False, 2048), ("Flatten Noise", True, 2048),
                                          ("without Shadow", False, 0)):  # fmt: skip
            surfels, _ = surfels_from_points(scan.points, scanners=scan.scanners, flattens_noise=flattens)
            frame = pictured(renderer, surfels, camera, resolution)
            shown, here = srgb(frame.color[..., 0]), counts & (frame.color[..., 3] > 0.99)
            report.picture(
                f"{short(name)}_{how.split()[0]}", [frame.color[..., :3], np.repeat(truth[..., None], 3, axis=2)]
            )
            off = shown - srgb(truth)
            kinds = here, here & (reached == 1), here & (reached == 0)
            yield (short(name), how, *(f"{_psnr(off[kind]):.1f}" for kind in kinds),
                   *(f"{(picture[here] < BLACK).mean():.1%}" for picture in (shown, srgb(truth))))  # fmt: skip


def pictured(renderer, surfels, camera, resolution: int):
    grey = np.full((len(surfels), 4), BASE, np.float32)
    grey[:, 3] = 1
    instance = Instance(replace(surfels, colors=grey), materials=(Material(roughness=ROUGHNESS),))
    light = Light("sun", direction=tuple(SUN), energy=STRENGTH, casts_shadow=True)
    return renderer.render(Scene((instance,), (light,)), camera, replace(SETTINGS, shadow_resolution=resolution))


def followed(mesh: TriangleMesh, scan: Scan, camera) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """(h, w) radiance, (h, w) the share of the rays that reach the sun, and (h, w) bool, which pixels count: those that
    the mesh covers where the scanner saw it."""
    tree = BVHTree.FromPolygons(mesh.positions.tolist(), mesh.triangles.tolist())
    (width, height), (left, right, low, high) = camera.size, camera.window
    across, up, back, eye = np.asarray(camera.matrix_world, np.float64)[:3].T
    reach = float(np.ptp(mesh.positions, axis=0).max())
    ahead, to_sun = Vector(-back), Vector(-SUN / np.linalg.norm(SUN))
    shape = height * RAYS, width * RAYS
    places, normals, is_hit, is_lit = np.full((*shape, 3), np.inf), np.ones((*shape, 3)), *np.zeros((2, *shape), bool)
    for y, x in np.ndindex(shape):
        at = left + (x + 0.5) / shape[1] * (right - left), low + (y + 0.5) / shape[0] * (high - low)
        hit, normal, face, _ = tree.ray_cast(Vector(eye + at[0] * across + at[1] * up), ahead)
        if hit is None:
            continue
        smooth = Vector(mesh.corner_normals[face].mean(axis=0)) if mesh.corner_normals is not None else normal
        facing = -1 if normal.dot(ahead) > 0 else 1
        lit_from = hit + facing * 1e-4 * reach * normal
        is_hit[y, x], is_lit[y, x] = True, tree.ray_cast(lit_from, to_sun)[0] is None
        places[y, x], normals[y, x] = hit, facing * smooth
    light = blinn(normals.reshape(-1, 3), ROUGHNESS, back)[:, 0].reshape(shape) * is_lit
    whole = np.maximum(_mean(is_hit), 1e-9)
    middle = places[RAYS // 2 :: RAYS, RAYS // 2 :: RAYS]
    counts = _mean(is_hit) == 1
    counts[counts] = scan.seen.query(middle[counts])[0] < _FARTHEST * scan.spacing
    return _mean(light), _mean(is_lit) / whole, counts


def crown() -> TriangleMesh:
    """Leaves with triangles for both sides, of which the scanner sees the front."""
    random = np.random.default_rng(1)
    directions = random.normal(size=(3, COUNT, 3))
    middles = directions[0] / np.linalg.norm(directions[0], axis=1, keepdims=True)
    middles *= random.uniform(size=(COUNT, 1)) ** (1 / 3) * CROWN
    along = directions[1] / np.linalg.norm(directions[1], axis=1, keepdims=True)
    normals = np.cross(along, directions[2])
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    a, b = EDGE / 2 * along, EDGE / 2 * np.cross(normals, along)
    corners = np.stack([middles - a - b, middles + a - b, middles + a + b, middles - a + b], axis=1)
    first = 4 * np.arange(COUNT, dtype=np.int32)[:, None]
    fronts = np.concatenate([first + np.array(three) for three in ((0, 1, 2), (0, 2, 3))])
    triangles = np.concatenate([fronts, fronts[:, ::-1]]).astype(np.int32)
    turned = np.concatenate([normals, normals, -normals, -normals])
    return TriangleMesh(corners.reshape(-1, 3), triangles, np.repeat(turned[:, None], 3, axis=1))


def _mean(values: np.ndarray) -> np.ndarray:
    """(h, w) means of the rays of each pixel."""
    height, width = values.shape
    return values.reshape(height // RAYS, RAYS, width // RAYS, RAYS).mean(axis=(1, 3))


def _psnr(off: np.ndarray) -> float:
    return float(-10 * np.log10(np.mean(off**2))) if len(off) else np.nan
