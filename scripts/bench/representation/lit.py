# SPDX-License-Identifier: GPL-3.0-or-later
"""How close lit pictures of surfels are to the mesh, with normals that change over each surfel and without.

The truth shades 6 x 6 samples a pixel of the mesh's interpolated normals by Blinn's formula in float64, under one sun
that casts no shadow, seen by a parallel camera. "now": surfels whose normal is one for each, at this resolution;
"fields": normals change by half of what is stored; "whole": by all of it, as the paper has it; "half": fields at half
the resolution; with --fitted, these after a fit to all that is seen, of the normals alone, and of their changes, too
(`fitted`). PSNR: of the picture, and inside of the mesh's outline, two pixels away from it. Frame: median ratio of the
processor time of a frame to that of "now".
"""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from unittest.mock import patch

import numpy as np
from scipy.ndimage import binary_erosion

from bench.representation.error import over_grey
from bench.representation.fitted import fitted, seen_by_rays
from bench.representation.meshes import view
from measuring.models import short
from measuring.timing import Spread, in_turn, processor
from splat_addon.reference.metrics import psnr, srgb
from splat_addon.reference.triangles import render_triangles
from splat_addon.rendering import Camera, Instance, Light, Material, Scene, Settings
from splat_addon.rendering.features import normal_fields
from splat_addon.sampling import sample_mesh

COLUMNS = "model", "resolution", "view", "roughness", "picture", "surfels", "PSNR", "inside", "frame"
SETTINGS = Settings(shading="phong", shadow_resolution=0, transparent_film=True, outputs=("color",))
SUN, STRENGTH, BASE, REFLECTANCE = np.array((-0.5, -0.6, -1.0)), 3.0, 0.6, 0.04
OUTLINE = 2  # pixels


def rows(meshes, renderer, options):
    light = Light("sun", direction=tuple(SUN), energy=STRENGTH)
    for name, mesh in meshes.items():
        grey = np.full(mesh.corner_colors.shape, BASE, np.float32)
        grey[..., 3] = 1
        mesh = replace(mesh, corner_colors=grey)
        for resolution in options.resolution:
            sampled = {
                "now": sample_mesh(mesh, resolution=resolution),
                "fields": sample_mesh(mesh, resolution=resolution, normal_fields=True),
                "half": sample_mesh(mesh, resolution=resolution / 2, normal_fields=True),
            }
            if options.fitted:
                seen = seen_by_rays(sampled["half"], mesh)
                sampled |= {
                    "half, fitted normals": fitted(sampled["half"], seen, False),
                    "half, fitted": fitted(sampled["half"], seen, True),
                }
            for k in range(options.views):
                camera = parallel(mesh, k, options.size)
                for roughness in (0.3, 0.8):
                    shade = partial(blinn, roughness=roughness, to_eye=camera.matrix_world[:3, 2])
                    corners = mesh.positions[mesh.triangles], mesh.corner_normals
                    truth = render_triangles(*corners, camera, samples=6, shade=shade)
                    inside = binary_erosion(truth.coverage > 0.999, iterations=OUTLINE)
                    material = (Material(roughness=roughness),)
                    scenes = {how: Scene((Instance(s, materials=material),), (light,)) for how, s in sampled.items()}
                    jobs = {how: partial(renderer.render, scene, camera, SETTINGS) for how, scene in scenes.items()}
                    jobs["whole"] = partial(with_whole_fields, jobs["fields"])
                    turns = in_turn(jobs, options.turns, processor)
                    for how, frame in turns.results.items():
                        shown = over_grey(frame.color[..., :3], frame.color[..., 3])
                        true = over_grey(truth.color, truth.coverage)
                        off = srgb(shown[inside]) - srgb(true[inside])
                        yield (
                            short(name), resolution, k, roughness, how, f"{len(sampled.get(how, sampled['fields'])):,}",
                            f"{psnr(shown, true):.1f}", f"{-10 * np.log10(np.mean(off**2)):.1f}",
                            f"{Spread.of(turns.ratios(how, 'now')).median:.2f}",
                        )  # fmt: skip


def with_whole_fields(draw):
    """A picture in which normals change by all that is stored; everything else is as usual."""
    with patch.object(normal_fields, "share_of", lambda as_printed: 1.0):
        return draw()


def parallel(mesh, number: int, size: int) -> Camera:
    """A parallel camera that sees 0.85 diagonals of the box from one of the directions of `view`."""
    low, high = mesh.bounds()
    diagonal = float(np.linalg.norm(high - low))
    matrix = view(mesh, number, size).matrix_world
    return Camera.orthographic(matrix, 0.85 * diagonal, (size, size), diagonal / 100, diagonal * 10)


def blinn(normals: np.ndarray, roughness: float, to_eye: np.ndarray) -> np.ndarray:
    """(n, 3) radiance towards the eye, (3,) unit, of surfaces with (n, 3) normals of any length.

    Akenine-Moeller et al., "Real-Time Rendering", 3rd edition, section 7.5.7."""
    normals = normals / np.linalg.norm(normals, axis=1, keepdims=True)
    to_light = -SUN / np.linalg.norm(SUN)
    halfway = (to_eye + to_light) / np.linalg.norm(to_eye + to_light)
    exponent = 2 / roughness**4 - 2
    lobe = (exponent + 8) / (8 * np.pi) * np.maximum(normals @ halfway, 0) ** exponent
    light = STRENGTH * np.maximum(normals @ to_light, 0)
    return np.repeat(((BASE / np.pi + REFLECTANCE * lobe) * light)[:, None], 3, axis=1)
