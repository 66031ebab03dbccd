# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures of scanned models under a sun, beside those of the meshes themselves."""

from __future__ import annotations

from dataclasses import replace
from functools import partial

import numpy as np

from bench.representation.error import over_grey
from bench.representation.lit import BASE, SETTINGS, STRENGTH, SUN, blinn, parallel
from splat_addon.reference.metrics import srgb
from splat_addon.reference.triangles import render_triangles
from splat_addon.rendering import Instance, Light, Material, Scene

ROUGHNESS = 0.8
#: Farther from every hit of the scanner, in spacings, the mesh was not seen.
_FARTHEST = 2.0


class Views:
    """The mesh from a few directions."""

    def __init__(self, mesh, scan, options):
        self._cameras = [parallel(mesh, k, options.size) for k in range(options.views)]
        self._truths = [self._truth(mesh, scan, camera) for camera in self._cameras]

    def _truth(self, mesh, scan, camera) -> tuple[np.ndarray, np.ndarray]:
        """(h, w, 3) the picture, and (h, w) bool, where it counts: where the scanner saw the mesh, or there is none."""
        corners = mesh.positions[mesh.triangles]
        shade = partial(blinn, roughness=ROUGHNESS, to_eye=camera.matrix_world[:3, 2])
        lit = render_triangles(corners, mesh.corner_normals, camera, samples=4, shade=shade)
        middle = corners.mean(axis=(0, 1))
        places = render_triangles(corners, corners - middle, camera, samples=1, pixel_filter="box")
        covered = places.coverage > 0
        at = places.color[covered] / places.coverage[covered, None] + middle
        counts = np.ones(covered.shape, bool)
        counts[covered] = scan.seen.query(at)[0] < _FARTHEST * scan.spacing
        return over_grey(lit.color, lit.coverage), counts

    def compare(self, renderer, surfels) -> tuple[float, list[np.ndarray]]:
        """PSNR of all views together, in sRGB, and the first one's picture and truth."""
        grey = np.full((len(surfels), 4), BASE, np.float32)
        grey[:, 3] = 1
        instance = Instance(replace(surfels, colors=grey), materials=(Material(roughness=ROUGHNESS),))
        scene = Scene((instance,), (Light("sun", direction=tuple(SUN), energy=STRENGTH),))
        squares, shown = [], []
        for camera, (truth, counts) in zip(self._cameras, self._truths, strict=True):
            color = renderer.render(scene, camera, SETTINGS).color
            shown.append(over_grey(color[..., :3], color[..., 3]))
            squares.append((srgb(shown[-1])[counts] - srgb(truth)[counts]) ** 2)
        return float(-10 * np.log10(np.concatenate(squares).mean())), [shown[0], self._truths[0][0]]
