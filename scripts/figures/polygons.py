# SPDX-License-Identifier: GPL-3.0-or-later
"""Polygons among splats, and a ball split between them.

From the left: a scene of both; the split ball with its parts in two colours, then in its own; and 20 times its
difference from polygons alone.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from splat_addon.reference import scenes
from splat_addon.reference.metrics import psnr, srgb
from splat_addon.rendering import Camera, Light, PolygonInstance, Renderer, Scene, Settings, look_at, open_device
from splat_addon.rendering.scene.polygons import make_polygons
from splat_addon.sampling import Channel, Surface, TriangleMesh, VertexColors, edge_samples, sample_mesh
from splat_addon.surfels import concatenate

DEVICES = ("standalone",)
QUICK = {"size": 24, "resolution": 20}
SUN = Light("sun", (1, 0.95, 0.85), 2.6, direction=(0.5, 1, -1), size=0.05, casts_shadow=True)
SURFACE = (Surface(Channel((1.0, 1.0, 1.0, 1.0), VertexColors())),)


def arguments(parser) -> None:
    parser.add_argument("--method", default="mip")
    parser.add_argument("--size", type=int, default=240, help="pixels along each side")
    parser.add_argument("--resolution", type=int, default=90, help="of the ball's surfels")


def run(options, report) -> None:
    renderer, settings = Renderer(open_device(options.device)), Settings(method=options.method)
    size = (options.size, options.size)
    scene, camera = scenes.polygons(size=size)
    front = Camera.perspective(look_at((0.6, -3.2, 1), (0.1, 0, 0)), math.radians(42), size)
    two_colors = split_ball(options.resolution, (0.15, 0.35, 0.8, 1.0), (0.85, 0.45, 0.1, 1.0))
    split = split_ball(options.resolution)
    shots = {
        "hybrid": (replace(scene, lights=(SUN,), world=(0.12, 0.15, 0.2)), camera),
        "parts": (two_colors, front),
        "split": (split, front),
        "polygons": (replace(split, surfels=(), polygons=(drawn(whole_ball()),)), front),
    }
    colors = {name: renderer.render(*shot, settings).color[..., :3] for name, shot in shots.items()}
    alone = colors.pop("polygons")
    report.say(f"The split ball against polygons alone: {psnr(colors['split'], alone):.1f} dB.")
    apart = 20 * np.abs(colors["split"] - alone)
    report.picture("polygons", [*map(srgb, colors.values()), apart], encode=None)


def whole_ball() -> TriangleMesh:
    """A ball whose triangles share their vertices, with colours that vary smoothly."""
    soup = scenes.round_polygons(40).positions.astype(np.float64)
    places, index = np.unique(np.round(soup, 6), axis=0, return_inverse=True)
    return part(places, index.reshape(-1, 3))


def part(places: np.ndarray, triangles: np.ndarray) -> TriangleMesh:
    corners = places[triangles]
    waves = 0.5 + 0.4 * np.sin(corners * (6, 5, 4) + (0, 1, 0))
    colors = np.concatenate([waves, np.ones((*waves.shape[:2], 1))], axis=2)
    return TriangleMesh(places, triangles, corners, corner_colors=colors, surfaces=SURFACE)


def drawn(mesh: TriangleMesh, color=None) -> PolygonInstance:
    colors = mesh.corner_colors.reshape(-1, 4) if color is None else np.tile(color, (3 * len(mesh), 1))
    return PolygonInstance(make_polygons(mesh.positions, mesh.triangles, mesh.corner_normals, colors=colors))


def split_ball(resolution: int, color=None, other=None) -> Scene:
    """Polygons on one side of a wavy line and surfels on the other, with more along the edges between."""
    ball = whole_ball()
    x, _, z = ball.positions.T
    is_near = (x + 0.3 * np.sin(5 * z) < 0.1)[ball.triangles].mean(axis=1) > 0.5
    near, far = (part(ball.positions, ball.triangles[at]) for at in (is_near, ~is_near))
    surfels = sample_mesh(far, resolution=resolution)
    edges = edge_samples(near, far, 2 / resolution, float(np.median(surfels.scales)), surfels.origin)
    surfels = concatenate([surfels, edges])
    if other is not None:
        surfels = replace(surfels, colors=np.tile(np.float32(other), (len(surfels), 1)))
    return Scene((surfels,), (replace(SUN, casts_shadow=False),), (0.15, 0.15, 0.2), polygons=(drawn(near, color),))
