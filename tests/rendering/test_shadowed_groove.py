# SPDX-License-Identifier: GPL-3.0-or-later
"""Merged surfels in shadow maps close no narrow grooves: these would wear dashes of shadow."""

import numpy as np
import trimesh

from splat_addon.rendering import Camera, Instance, Light, Material, Scene, Settings, look_at
from splat_addon.sampling import DEFAULT_CREASE_ANGLE, TriangleMesh
from tests.plain import sample_mesh

TEXELS = 128
#: Of the map, which covers a plate of two units and a margin.
TEXEL = 2.05 / TEXELS
CAMERA = Camera.orthographic(look_at((0.15, -0.1, 5), (0, 0, 0), (0, 1, 0)), 1.6, (128, 128), 0.05, 20)
SUN = Light("sun", energy=3, direction=(0.7, 0.13, -1), casts_shadow=True)


def grooved(width: float, depth: float) -> trimesh.Trimesh:
    """A plate of 2 x 2 with a groove through its middle, along y."""
    profile = [(-1, 0), (-width / 2, 0), (-width / 2, -depth), (width / 2, -depth), (width / 2, 0), (1, 0)]
    places = [(x, y, z) for y in (-1, 1) for x, z in profile]
    faces = [t for k in range(5) for t in ((k, k + 1, k + 7), (k, k + 7, k + 6))]
    return trimesh.Trimesh(places, faces, process=False)


def test_a_groove_is_shadowed_as_without_merged_surfels(render):
    """The grooves have six widths. Measured: 0.016 of the shadow, and 0.029 in one groove; it was 0.022 and 0.038 when
    narrow strips were merged, and 0.071 and 0.12 when merged surfels did not end at edges."""
    squares = [(off_by(render, texels) ** 2).mean() for texels in (1.5, 2, 2.5, 3, 3.5, 4)]
    assert np.sqrt(np.mean(squares)) < 0.02 and np.sqrt(np.max(squares)) < 0.034


def off_by(render, texels):
    """The change of a shadow by merging in a groove of that many texels."""
    mesh = grooved(texels * TEXEL, texels * TEXEL)
    edges = {"crease_angle": DEFAULT_CREASE_ANGLE, "fits_blending": True}
    surfels = sample_mesh(TriangleMesh(mesh.vertices, mesh.faces), resolution=512, **edges)
    scene = Scene([Instance(surfels, np.eye(4), (Material(roughness=1.0, ior=1.0),))], [SUN])

    def shadow(tolerance):
        settings = Settings(detail_tolerance=tolerance, shadow_resolution=TEXELS, outputs=("color", "shadow"))
        return render(scene, CAMERA, settings).shadow[:, 50:78, 0].astype(float)

    return shadow(Settings.detail_tolerance) - shadow(0.0)
