# SPDX-License-Identifier: GPL-3.0-or-later
"""Figures of Guennebaud et al. 2006."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import trimesh

from bench.papers.figures.shots import FLAT, LIT, Draw
from splat_addon.reference import scenes
from splat_addon.rendering import Light, make_polygons
from splat_addon.sampling import PLAIN, TriangleMesh, joined_at_edges, sample_mesh

#: Spacing of the splats beside polygons, in radii of the ball.
SPACING = 0.06


def figures(draw: Draw, draw_frame, size: int):
    board = scenes.checker_plane(60, 360_000, 8, (size, size // 2))
    methods = "quad", "ewa", "homogeneous_printed", "raycast_printed"
    shown = [draw(board, FLAT, method=method) for method in methods]
    yield "2006-3", "No filter; EWA; the paper's; Botsch et al. 2005", shown, 1
    near = scenes.checker_plane(8, 2_500, 25, (size, size // 2))
    yield "2006-4", "Close: Botsch et al. 2005; the paper's", [draw(near, FLAT, method=m) for m in methods[:1:-1]], 1
    even, bare, weight = half_polygons(size, True), half_polygons(size, False), {"shading": "weight"}
    ways = (even, {}), (even, weight), (bare, weight)
    shown = [draw(half, replace(LIT, method="quad", supersampling=2, **how)) for half, how in ways]
    shown = [nearest_of_both(draw_frame, even), *shown]
    caption = "Splats beside polygons: naive, the nearer of both; blended; weights; weights without splats on edges"
    yield "2006-5", caption, shown, 1
    spheres = scenes.transparent_spheres(2_000, size=(size, size))
    layers = (6, False), (3, False), (3, True)
    shown = [draw(spheres, LIT, method="quad", layers=n, blends_rest=rest) for n, rest in layers]
    yield "2006-6", "6 layers; 3 layers; 3 layers, of which the last blends the rest", shown, 1


def nearest_of_both(draw_frame, shot) -> np.ndarray:
    """The nearer of splats and polygons at each pixel, which nothing blends: what section 5.1 calls naive."""
    scene, camera = shot
    settings = replace(LIT, method="quad", outputs=("color", "depth"))
    alone = replace(scene, polygons=()), replace(scene, surfels=())
    splats, polygons = (draw_frame(one, camera, settings) for one in alone)
    return np.where((splats.depth < polygons.depth)[..., None], splats.color, polygons.color)


def half_polygons(size: int, has_edge_samples: bool):
    """A ball of which one half is polygons and the other splats, which the mesh's edges between them may have too."""
    ball = trimesh.creation.icosphere(3)
    middle = ball.vertices[ball.faces][:, :, 0].mean(axis=1)
    halves = (ball.faces[middle > 0], ball.faces[middle <= 0])
    near, far = (TriangleMesh(ball.vertices, half, corner_normals=ball.vertices[half]) for half in halves)
    splats = sample_mesh(far, spacing=SPACING, **PLAIN)
    if has_edge_samples:
        splats = joined_at_edges(splats, near, far, SPACING)
    polygons = make_polygons(near.positions, near.triangles, near.corner_normals, (1.0, 1.0, 1.0, 1.0))
    white = replace(splats.as_solid(), colors=np.ones((len(splats), 4)))
    sun = Light("sun", energy=3.0, direction=(0.2, 0.6, -0.8))
    scene, camera = scenes.sphere(1, (size, size))
    return replace(scene, surfels=(white,), polygons=(polygons,), lights=(sun,)), camera
