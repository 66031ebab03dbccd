# SPDX-License-Identifier: GPL-3.0-or-later
"""Benefit and cost of texture-mapped surfels, compared with surfels of one colour each: a globe covered with text.

The reference is the texture itself on the analytic sphere, looked up by float64 rays, 12 x 12 per pixel; PSNR is
measured in sRGB where the sphere is seen at less than 75 degrees from its normal. The scene is unlit; both kinds of
surfels are timed alternately, in processor time of all threads. The figure: surfels of one colour, as many
texture-mapped ones, and 64 times as many of one colour.
"""

from __future__ import annotations

import math
from dataclasses import replace
from functools import partial

import numpy as np

from measuring.timing import in_turn, processor
from splat_addon.reference.lettering import page
from splat_addon.reference.metrics import psnr
from splat_addon.reference.seen_texture import seen_texture
from splat_addon.rendering import Camera, Instance, Renderer, Scene, Settings, SurfaceTexture, look_at, open_device
from splat_addon.sampling import PLAIN, Channel, Image, Surface, Texture, TriangleMesh, sample_surface

DEVICES = ("standalone",)
QUICK = {"size": 32, "resolutions": [8, 16]}
#: name -> settings and the pixel filter of the reference
METHODS = {
    "mip": (Settings(method="mip", supersampling=1, shading="flat"), "gaussian"),
    "quad, 2 x 2": (Settings(method="quad", supersampling=2, shading="flat"), "box"),
}
COLUMNS = "method", "resolution", "surfels", "dB, a colour each", "dB, texture-mapped", "s", "s", "time"


def arguments(parser) -> None:
    parser.add_argument("--size", type=int, default=256, help="pixels along each side")
    parser.add_argument("--resolutions", type=int, nargs="+", default=[8, 16, 32, 64, 128, 256])


def run(options, report) -> None:
    image, renderer = text_image(), Renderer(open_device(options.device))
    height, width = image.pixels.shape[:2]
    how = f"{options.size} x {options.size} pixels, texture {width} x {height}, medians of {options.turns} turns"
    report.header(renderer.device, how)
    mesh, pose = globe(image), look_at((2.2, -1.6, 0.9), (0, 0, 0))
    camera = Camera.perspective(pose, math.radians(42), (options.size, options.size), 0.1, 10)
    made = {r: sample_surface(mesh, resolution=r, texture_mapped=True, **PLAIN).surfels for r in options.resolutions}

    def rows():
        for name, (settings, pixel_filter) in METHODS.items():
            seen, inside = seen_texture(SurfaceTexture(image), camera, pixel_filter, on_sphere)
            for resolution, surfels in report.steps(made.items(), name):
                kinds = {"own": without_uvs(surfels), "mapped": surfels}
                jobs = {k: partial(renderer.render, scene_of(s, image), camera, settings) for k, s in kinds.items()}
                drawn = in_turn(jobs, options.turns, processor)
                colors = (frame.color[inside][None, :, :3] for frame in drawn.results.values())
                decibels = (f"{psnr(color, seen[inside][None]):.1f}" for color in colors)
                times = (f"{drawn.spread(kind).median:.3f}" for kind in kinds)
                yield name, resolution, f"{len(surfels):,}", *decibels, *times, f"{drawn.ratio('mapped', 'own'):.2f}"

    report.table(COLUMNS, rows())
    coarse, fine = made.get(32, made[min(made)]), made[max(made)]
    shown = (scene_of(surfels, image) for surfels in (without_uvs(coarse), coarse, without_uvs(fine)))
    report.picture("textured", [renderer.render(s, camera, METHODS["mip"][0]).color for s in shown], colors=128)


def on_sphere(eye: np.ndarray, rays: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The longitude and latitude at which rays hit the unit sphere, and whether the angle is small enough to be
    measured.
    """
    along = -rays @ eye
    inside = along**2 - eye @ eye + 1
    points = eye + rays * (along - np.sqrt(np.maximum(inside, 0)))[:, None]
    well = (inside > 0) & (-np.einsum("ij,ij->i", points, rays) > math.cos(math.radians(75)))
    longitude = np.arctan2(points[:, 1], points[:, 0]) / (2 * np.pi) % 1
    return np.stack([longitude, np.arcsin(np.clip(points[:, 2], -1, 1)) / np.pi + 0.5], axis=1), well


def text_image() -> Image:
    """Dark letters on paper whose colour changes from pole to pole; four texels per dot."""
    ink = np.kron(page(60, 20), np.ones((4, 4)))[..., None]
    share = np.linspace(0, 1, len(ink))[:, None, None]
    paper = share * (0.85, 0.75, 0.45) + (1 - share) * (0.4, 0.65, 0.85)
    return Image(np.concatenate([np.where(ink > 0, (0.03, 0.02, 0.05), paper), np.ones_like(ink)], axis=2))


def globe(image: Image, rows: int = 256) -> TriangleMesh:
    """The unit sphere with longitude and latitude as texture coordinates, and a closed seam."""
    lon, lat = np.meshgrid(np.linspace(0, 1, 2 * rows + 1), np.linspace(0, 1, rows + 1))
    angle, height = 2 * np.pi * lon, np.pi * (lat - 0.5)
    points = np.stack([np.cos(height) * np.cos(angle), np.cos(height) * np.sin(angle), np.sin(height)], axis=2)
    index = np.arange(lon.size).reshape(lon.shape)
    a, b, c, d = (index[i : i + rows, j : j + 2 * rows].ravel() for i, j in ((0, 0), (0, 1), (1, 1), (1, 0)))
    triangles = np.concatenate([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)])
    uvs = np.stack([lon.ravel(), lat.ravel()], axis=1)[triangles]
    points, surface = points.reshape(-1, 3), Surface(Channel((1.0, 1.0, 1.0, 1.0), Texture(image)))
    return TriangleMesh(points, triangles, points[triangles], corner_uvs=uvs, surfaces=(surface,))


def scene_of(surfels, image: Image) -> Scene:
    return Scene((Instance(surfels, textures=(SurfaceTexture(image),)),), world=(0.2, 0.2, 0.2))


def without_uvs(surfels):
    return replace(surfels, uvs=None, uv_along_x=None, uv_along_y=None)
