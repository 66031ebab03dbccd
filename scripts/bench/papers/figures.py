# SPDX-License-Identifier: GPL-3.0-or-later
"""The papers' figures, drawn with our models and scenes: for each its name, the paper's caption in short, and
the pictures.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from functools import cache
from pathlib import Path
from unittest.mock import patch

import numpy as np
import trimesh

from measuring.models import in_view, load
from splat_addon.quaternions import axes_quaternions
from splat_addon.reference import render_exact, scenes
from splat_addon.reference.extremes import sheet
from splat_addon.reference.methods import TWINS
from splat_addon.reference.methods.plane import splat_plane
from splat_addon.rendering import Camera, Light, Lines, Ramp, Renderer, Scene, Settings, make_polygons
from splat_addon.rendering.device.interface import FORMATS
from splat_addon.rendering.device.standalone import _STORED
from splat_addon.rendering.passes.textures import COLOR_SUM
from splat_addon.rendering.plan.frame_plan import FramePlan
from splat_addon.sampling import PLAIN, TriangleMesh, joined_at_edges, sample_mesh
from splat_addon.sampling.ldc.reductions import REDUCTIONS

FLAT = Settings(supersampling=1, shading="flat", outputs=("color",), detail_tolerance=0.0)
LIT = replace(FLAT, shading="phong", shadow_resolution=0)
UNFILTERED, FILTERED = (replace(LIT, method=name, lights_splats=True) for name in ("sprites_unfiltered", "sprites"))
#: Half-axes in pixels of a splat that is larger than the pixel's filter, smaller, and one way larger.
CONFIGURATIONS = (3.0, 3.0), (0.4, 0.4), (3.0, 0.3)
#: Spacing of the splats beside polygons, in radii of the ball.
SPACING = 0.06
WARM = Ramp(np.array([(0.1, 0.05, 0.15), (0.1, 0.05, 0.15), (0.7, 0.3, 0.2), (0.7, 0.3, 0.2), (1, 0.85, 0.6)]))

Draw = Callable[..., np.ndarray]


def figures(renderer: Renderer, models: Path, size: int) -> Iterator[tuple[str, str, list[np.ndarray], int]]:
    """(name, caption, pictures, enlargement) for each figure. size: pixels along an edge of a model's picture."""

    def draw(shot, settings: Settings, **choices) -> np.ndarray:
        return renderer.render(*shot, replace(settings, **choices)).color

    def model(name: str, resolution: int, **view):
        return in_view(_surfels(models / name, resolution), size, **view)

    yield from _of_2003(draw, model, size)
    yield from _of_2005(draw, model, size)
    yield from _of_2006(draw, renderer.render, size)
    yield from _view_independent(draw, size)
    yield from _reductions(draw, models, size)


def _of_2003(draw: Draw, model, size: int):
    coarse = model("bunny.obj.gz", 48)
    squares = draw(facing_squares(*coarse), LIT, method="quad")
    yield "2003-1", "Square splats against ellipses", [squares, draw(coarse, UNFILTERED)], 1
    round_ones = draw(facing_discs(*coarse), UNFILTERED)
    yield "2003-3", "The size alone; size and shape", [squares, round_ones, draw(coarse, UNFILTERED)], 1
    yield "2003-5", "Unfiltered and filtered splats", [draw(coarse, one) for one in (UNFILTERED, FILTERED)], 1
    crossing = scenes.torus(2_500, (size, size))
    shown = [draw(crossing, FLAT, method=one.method) for one in (UNFILTERED, FILTERED)]
    yield "2003-6", "One depth a splat; the depth of each pixel", shown, 1
    board = scenes.text_board(66_000, 30, (size, size))
    shown = [draw(board, FLAT, method=one.method) for one in (UNFILTERED, FILTERED)]
    yield "2003-8", "Unfiltered and filtered texture", shown, 1


def _of_2005(draw: Draw, model, size: int):
    scene, camera = model("bunny.obj.gz", 96)
    overlapping = replace(scene, lights=(replace(scene.lights[0], energy=1.0),), world=(0.05, 0.05, 0.05)), camera
    with sums_of_8_bits():
        bytes_ = draw(overlapping, FILTERED)
    yield "2005-2", "Sums of 8 bits; float sums", [bytes_, draw(overlapping, FILTERED)], 1
    checker = scenes.checker_plane(40, 90_000, 6, (size, size // 2))
    ways = {"method": "quad"}, {"method": "quad", "supersampling": 3}, {"method": "raycast_printed"}
    shown = [draw(checker, FLAT, **how) for how in ways]
    yield "2005-3", "No filter; supersampling; the paper's filter", shown, 1
    methods = "quad", "ewa", "raycast", "homogeneous"
    shown = [contour(method, *axes) for axes in CONFIGURATIONS for method in methods]
    yield "2005-4", "Contours of filters: none, EWA, Botsch et al., Guennebaud et al.", shown, 1
    shadowed = {"shadow_resolution": 1024, "supersampling": 2, "method": "quad"}
    scan, lines = model("armadillo.obj.gz", 200), Lines(width=1.5, shallow_angle=math.radians(20))
    ways = {"shading": "phong"}, {"shading": "toon", "lines": lines}, {"shading": "ramp", "ramp": WARM, "lines": lines}
    shown = [draw(scan, LIT, **shadowed, **how) for how in ways]
    yield "2005-5", "Phong; toon with outlines; a ramp with outlines; all with shadows", shown, 1


def _of_2006(draw: Draw, draw_frame, size: int):
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
    shown = [draw(spheres, LIT, method="quad", layers=n, blends_rest=rest, as_printed=True) for n, rest in layers]
    yield "2006-6", "6 layers; 3 layers; 3 layers, of which the last blends the rest", shown, 1


def _view_independent(draw: Draw, size: int):
    wide = size, size // 2
    checker, text = scenes.checker_plane(20, 40_000, 10, wide), scenes.text_board(66_000, 35, wide)
    ours, ren = {"method": "quad", "multisampling": 4}, {"method": "ewa_object", "as_printed": True}
    shown = [draw(shot, FLAT, **how) for shot in (checker, text) for how in (ours, ren)]
    yield "view-independent-2", "Checkers and text: 4 hardware samples; Ren et al. as printed", shown, 1
    near = splat_plane((0.3, -0.55, -1.6), (0.5, 0, 0), (0, 0.13, 1.1))
    ways = {"quad": {}, "ewa": {"variance": 1e-9}, "sprites": {}}
    across, up = np.meshgrid(np.linspace(-0.5, 1.1, size), np.linspace(-1.3, 0.3, size))
    points, pixel = np.stack([across.ravel(), up.ravel()], axis=1), np.full(2, 1.6 / size)
    shown = [in_steps(TWINS[name](near, points, pixel, **how)[0].reshape(size, size)) for name, how in ways.items()]
    yield "view-independent-7", "A splat in perspective: ours; the affine map without a filter; sprites", shown, 1
    textured = scenes.textured_plane(size=(size, size))
    shown = [draw(textured, FLAT, **how) for how in (ours, ren)]
    yield "view-independent-8", "Textures, looked up anisotropically: 4 hardware samples; Ren et al", shown, 1
    flat = Scene((sheet(24, 2.0, 72.0, 3.0),)), Camera.perspective(np.eye(4), 1.0, wide, 0.1, 100)
    shown = [draw(flat, FLAT, method=method) for method in ("quad", "ewa", "sprites")]
    yield "view-independent-9", "Ours; the affine map; sprites", shown, 1
    shown = [draw(text, FLAT, **how) for how in ({"method": "quad"}, ours, ren)]
    truth = render_exact(*text, FLAT, samples=4, pixel_filter="box").color
    yield "view-independent-10", "No filter; 4 hardware samples; Ren et al.; the truth", [*shown, truth], 1


def _reductions(draw: Draw, models: Path, size: int):
    above = {"eye": np.array((0.45, 1.2, 0.75)), "fov": 0.6, "up": (0, 1, 0)}
    for name, file, resolution, view, reductions in (
        ("view-independent-4", "bunny.obj.gz", 64, {}, ("none", "surfel_normal", "three_to_one", "grazing")),
        ("view-independent-5", "phoenix_bird.glb", 256, above, ("three_to_one", "grazing", "surfel_normal")),
    ):
        mesh, shown = load(models / file), []
        for reduction in reductions:
            with colored_by_image(reduction):
                surfels = sample_mesh(mesh, resolution=resolution, reduction=reduction, **PLAIN)
            shown.append(draw(in_view(surfels, size, **view), LIT, method="quad", supersampling=2))
        yield name, f"Surfels of the images along x, y, z in red, green, blue: {', '.join(reductions)}", shown, 1


@contextmanager
def colored_by_image(name: str):
    """Samples of a reduction have the colour of their layered depth image."""
    chosen = REDUCTIONS[name]

    def merge(arrays, axes, spacing):
        colored = {**arrays, "colors": np.eye(4, dtype=np.float32)[axes] * 0.8 + (0.05, 0.05, 0.05, 1)}
        return chosen.merge(colored, axes, spacing) if chosen.merge else colored

    with patch.dict(REDUCTIONS, {name: replace(chosen, merge=merge)}):
        yield


@cache
def _surfels(path: Path, resolution: int):
    return sample_mesh(load(path), resolution=resolution, **PLAIN)


def contour(method: str, wide: float, high: float, pixels: int = 5, places: int = 128) -> np.ndarray:
    """(places, places, 3) picture of a splat's weight, in steps of an eighth of its largest; it shows that many
    pixels each way.
    """
    plane = splat_plane((0.0, 0.0, -1.0), (wide / 100, 0.0, 1e-9), (0.0, high / 100, 0.0))
    axis = np.linspace(-pixels, pixels, places) / 100
    points = np.stack([a.ravel() for a in np.meshgrid(axis, axis)], axis=1)
    weights, _ = TWINS[method](plane, points, np.array((0.01, 0.01)))
    return in_steps(weights.reshape(places, places))


def in_steps(weights: np.ndarray) -> np.ndarray:
    """(h, w) weights -> (h, w, 3), in steps of an eighth of the largest."""
    return np.repeat(1 - np.ceil(8 * weights / weights.max())[..., None] / 8, 3, axis=2) ** 2.2


@contextmanager
def sums_of_8_bits():
    """Colours and weights are summed in a frame buffer of 8 bits a channel, which ends at 1 (2005, section 4.1)."""
    summed = FramePlan.format
    of_bytes = patch.object(FramePlan, "format", lambda plan, t: "RGBA8" if t is COLOR_SUM else summed(plan, t))
    with patch.dict(FORMATS, RGBA8=4), patch.dict(_STORED, RGBA8=("f1", None)), of_bytes:
        yield


def facing_discs(scene: Scene, camera):
    """The same surfels with discs that face the viewer: the first of the paper's two steps."""
    (instance,) = scene.surfels
    surfels = instance.surfels
    rotation = axes_quaternions(*(np.tile(camera.matrix_world[:3, k], (len(surfels), 1)) for k in range(3)))
    wide = np.repeat(surfels.scales.max(axis=1, keepdims=True), 2, axis=1)
    return replace(scene, surfels=(replace(instance, shape=replace(surfels, rotations=rotation, scales=wide)),)), camera


def facing_squares(scene: Scene, camera):
    """Squares as wide as the splats and parallel to the picture, as plain points are drawn."""
    (instance,) = scene.surfels
    surfels = instance.surfels
    across, up = (camera.matrix_world[:3, k] * surfels.scales.max(axis=1, keepdims=True) for k in (0, 1))
    middle = surfels.origin + surfels.positions.astype(np.float64)
    places = np.stack([middle + i * across + j * up for i, j in ((-1, -1), (1, -1), (1, 1), (-1, 1))], axis=1)
    first = 4 * np.arange(len(surfels))[:, None]
    triangles = np.concatenate([first + np.array(corners) for corners in ((0, 1, 2), (0, 2, 3))])
    normals = np.concatenate([surfels.normals, surfels.normals])[:, None].repeat(3, axis=1)
    polygons = make_polygons(places.reshape(-1, 3), triangles, corner_normals=normals)
    return replace(scene, surfels=(), polygons=(polygons,)), camera


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
