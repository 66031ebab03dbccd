# SPDX-License-Identifier: GPL-3.0-or-later
"""Polygons have normal maps in tangent space, as the exact picture has them and as surfels have them."""

from dataclasses import replace

import numpy as np
import pytest

from splat_addon.images import Image
from splat_addon.reference import render_exact
from splat_addon.reference.metrics import psnr
from splat_addon.rendering import (
    Camera,
    Light,
    NormalTexture,
    PolygonInstance,
    Polygons,
    Scene,
    Settings,
    look_at,
    plan,
)
from splat_addon.rendering.plan.programs import composed
from splat_addon.sampling import Channel, NormalMap, Surface, Texture, TriangleMesh, corner_values

CAMERA = Camera.perspective(look_at((0.4, -2.4, 1.8), (0, 0, 0)), 0.75, (80, 80))
SUN = Light("sun", energy=2.0, direction=(0.5, 0.6, -1), casts_shadow=False)


def waves(size=32) -> np.ndarray:
    """(size, size, 4) a normal map of waves, steeper along u."""
    u, v = np.meshgrid(*2 * [(np.arange(size) + 0.5) / size * 2 * np.pi])
    normals = np.stack([0.6 * np.sin(2 * u), 0.3 * np.sin(3 * v + u), np.ones_like(u)], axis=2)
    normals /= np.linalg.norm(normals, axis=2, keepdims=True)
    return np.concatenate([normals / 2 + 0.5, np.ones((size, size, 1))], axis=2)


def bent_sheet(mirrored=False) -> TriangleMesh:
    """An arched sheet with smooth normals whose texture is turned and, if asked, mirrored; its map is of waves."""
    x, y = (a.ravel() for a in np.meshgrid(np.linspace(-1, 1, 9), np.linspace(-1, 1, 9)))
    z, up = 0.3 * np.cos(1.2 * x), np.stack([0.36 * np.sin(1.2 * x), 0 * x, np.ones_like(x)], axis=1)
    first = (np.arange(8)[:, None] * 9 + np.arange(8)).ravel()
    quads = np.stack([first, first + 1, first + 10, first + 9], axis=1)
    triangles = np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
    uvs = np.stack([0.4 * x - 0.2 * y, 0.2 * x + 0.4 * y], axis=1) * ((-1, 1) if mirrored else (1, 1))
    bump = NormalMap(Channel((1.0, 1.0, 1.0), Texture(Image(waves()), uses_alpha=False)))
    surface = Surface(Channel((0.7, 0.6, 0.5, 1.0)), normal_map=bump)
    corner = {"corner_normals": up[triangles], "corner_uvs": uvs[triangles]}
    return TriangleMesh(np.stack([x, y, z], axis=1), triangles, surfaces=(surface,), **corner)


def polygons_of(mesh, strength=1.0, matrix=None, **fields) -> PolygonInstance:
    corners = mesh.triangles.ravel()
    normals, values = mesh.corner_normals.reshape(-1, 3), corner_values(mesh)
    shape = Polygons(mesh.positions[corners], normals, materials=np.zeros(len(corners), np.int32), **values)
    maps = (NormalTexture(mesh.surfaces[0].normal_map.color.factors[0].image, strength),)
    matrix = np.eye(4) if matrix is None else matrix
    return PolygonInstance(shape, matrix, textures=(None,), normal_maps=maps, **fields)


MATRICES = {
    "as it is": np.eye(4),
    "mirrored": np.diag((-1.0, 1, 1, 1)),
    "stretched": np.diag((1.0, 0.6, 1.7, 1)),
    "from below": np.diag((1.0, -1, -1, 1)),
}


@pytest.mark.parametrize("matrix", MATRICES)
@pytest.mark.parametrize("is_mirrored", [False, True])
def test_normals_are_bent_as_in_the_exact_picture(is_mirrored, matrix, render):
    instance = polygons_of(bent_sheet(is_mirrored), matrix=MATRICES[matrix])
    scene, settings = Scene(polygons=(instance,), lights=(SUN,)), Settings(method="quad", supersampling=4)
    frame, exact = render(scene, CAMERA, settings), render_exact(scene, CAMERA, settings, samples=4)
    inside = exact.coverage > 0.9999
    assert inside.sum() > 800
    assert psnr(frame.color[inside][None], exact.color[inside][None]) > 42
    smooth = render(replace(scene, polygons=(replace(instance, normal_maps=(None,)),)), CAMERA, settings)
    assert psnr(smooth.color[inside][None], exact.color[inside][None]) < 27


def test_strength_scales_the_slopes(render):
    mesh, settings = bent_sheet(), Settings(method="quad", outputs=("color", "normal"))
    flat, half, whole = (
        render(Scene(polygons=(polygons_of(mesh, strength),)), CAMERA, settings).normal for strength in (0.0, 0.5, 1.0)
    )
    plain = render(Scene(polygons=(replace(polygons_of(mesh), normal_maps=()),)), CAMERA, settings).normal
    assert np.abs(flat - plain).max() < 1e-5
    steep = [np.abs(bent - plain).mean() for bent in (half, whole)]
    assert 1.5 * steep[0] < steep[1] < 2.5 * steep[0]


def test_without_normal_maps_nothing_is_looked_up():
    """Polygons without them have the programs of a frame that has none."""
    bumped = Scene(polygons=(polygons_of(bent_sheet()),))
    plain = Scene(polygons=(replace(bumped.polygons[0], normal_maps=()),))
    plans = [plan(scene, CAMERA, Settings()) for scene in (plain, bumped)]
    passes = [next(p for p in made.passes if p.name == "polygons") for made in plans]
    texts = [composed(made, p, "polygons.vert") for made, p in zip(plans, passes, strict=True)]
    assert texts[0] == texts[1] and "bump" not in "".join(texts[0])
    assert "normal_maps_bend(normal);" in composed(plans[1], passes[1], "polygons.vert", "bumped")[1]


def test_there_are_as_many_normal_maps_as_textures():
    instance = polygons_of(bent_sheet())
    with pytest.raises(ValueError, match="as many normal maps as textures, which may be None: 2, not 1"):
        replace(instance, textures=(None, None))
