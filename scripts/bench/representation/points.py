# SPDX-License-Identifier: GPL-3.0-or-later
"""Representation error of bare points: random points on a mesh, without normals, converted with and without creases.

Noise moves them by a normal distribution in spacings. Surfels are coloured by their estimated normals, turned to the
mesh's side, so that wrong normals count as they do in light.
"""

from __future__ import annotations

from dataclasses import replace
from functools import partial

import numpy as np

from bench.representation.error import over_grey, picture_error
from bench.representation.meshes import view
from measuring.models import short
from measuring.timing import processor
from splat_addon.reference.triangles import render_triangles
from splat_addon.rendering import Scene, Settings
from splat_addon.sampling import surfels_from_points
from splat_addon.sampling.points import DEFAULT_CREASE_ANGLE

COLUMNS = (
    "model",
    "points",
    "noise",
    "creases",
    "view",
    "PSNR",
    "FLIP",
    "largest blob",
    "wrong",
    "bare",
    "spilled",
    "cut",
)


def random_points(mesh, count: int, noise: float) -> tuple[np.ndarray, np.ndarray]:
    """(N, 3) points on a mesh's triangles and (N, 3) unit normals of these. noise: in spacings."""
    random, corners = np.random.default_rng(0), mesh.positions[mesh.triangles]
    vectors = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    doubled = np.linalg.norm(vectors, axis=1)
    on = random.choice(len(corners), count, p=doubled / doubled.sum())
    u, v = np.sort(random.random((2, count, 1)), axis=0)
    points = (corners[on] * np.stack([u, v - u, 1 - v], axis=1)).sum(axis=1)
    points += noise * np.sqrt(doubled.sum() / 2 / count) * random.normal(size=points.shape)
    return points, vectors[on] / doubled[on, None]


def rows(meshes, renderer, options, report):
    settings = Settings(shading="flat", transparent_film=True)
    for name, mesh in meshes.items():
        cameras = [view(mesh, k, options.size) for k in range(options.views)]
        corners, colors = mesh.positions[mesh.triangles], mesh.corner_colors[..., :3]
        truths = [render_triangles(corners, colors, camera) for camera in cameras]
        for noise in options.noise:
            points, normals = random_points(mesh, options.points, noise)
            for creases, angle in (("no", None), ("yes", DEFAULT_CREASE_ANGLE)):
                seconds, (surfels, found) = processor(
                    partial(surfels_from_points, points, isolated="keep", crease_angle=angle)
                )
                outward = surfels.normals * np.sign((surfels.normals * normals).sum(axis=1, keepdims=True))
                shown = replace(surfels, colors=np.pad(outward / 2 + 0.5, ((0, 0), (0, 1)), constant_values=1))
                for k, (camera, truth) in enumerate(zip(cameras, truths, strict=True)):
                    color = renderer.render(Scene((shown,)), camera, settings).color
                    pictures = over_grey(color[..., :3], color[..., 3]), over_grey(truth.color, truth.coverage)
                    error = picture_error(*pictures, color[..., 3], truth.coverage)
                    report.picture(f"{short(name)}_points_{noise}_{creases}_{k}", [*pictures, error.difference])
                    yield (
                        short(name), f"{options.points:,}", noise, creases, k, f"{error.psnr:.1f}", f"{error.flip:.4f}",
                        error.blob, error.wrong, error.bare, error.spilled, f"{found.creases:,}",
                        f"{seconds:.1f}",
                    )  # fmt: skip
