# SPDX-License-Identifier: GPL-3.0-or-later
"""Of small instances each sample shows the nearest splat: with all that they have, among all else that is seen."""

import numpy as np
import pytest

from splat_addon.rendering import Camera, Light, Scene, Settings, look_at, make_polygons
from splat_addon.rendering.detail import steps
from splat_addon.rendering.scene import Instance, Material, PolygonInstance
from splat_addon.sampling import TriangleMesh, sample_mesh

CAMERA = Camera.perspective(look_at((0, 0, 20), (0, 0, 0)), 0.35, (48, 32))
CORNERS, FACES = np.array([(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0)], float), [(0, 1, 2), (0, 2, 3)]
MATERIALS = Material(index=1), Material(roughness=0.1, metallic=1.0, emission=(0.2, 0.0, 0.1), index=2)
OUTPUTS = "color", "depth", "normal", "coverage", "object_index", "material_index", "emission", "diffuse_color"
SETTINGS = Settings(outputs=OUTPUTS)


@pytest.fixture(scope="module")
def square():
    return sample_mesh(TriangleMesh(CORNERS, np.array(FACES)), resolution=32)


def field(square) -> Scene:
    """Tilted squares of two materials and light sets side by side, every third of them a hole; a splat that covers
    pixels before one of them, and a polygon that goes through others."""
    placed = []
    for number in range(40):
        matrix, angle = np.eye(4), 0.1 * (number % 5)
        matrix[1:3, 1:3] = (np.cos(angle), -np.sin(angle)), (np.sin(angle), np.cos(angle))
        matrix[:2, 3] = 2.2 * (number % 8) - 7.7, 2.2 * (number // 8) - 4.4
        material = (MATERIALS[number % 2],)
        given = {"light_set": number % 2, "is_holdout": number % 3 == 2, "index": number, "name": f"{number}"}
        placed.append(Instance(square, matrix, material, **given))
    near = np.diag((0.1, 0.1, 0.1, 1.0))
    near[:3, 3] = 0.5, 0.3, 5
    wall = make_polygons([(-3, -9, -1), (-2, -9, 1), (-2, 9, 1), (-3, 9, -1)], FACES, color=(0.1, 0.2, 0.9, 1.0))
    lights = (
        Light("sun", energy=2, direction=(0.3, 0.2, -1.0), casts_shadow=True),
        Light("sun", energy=1, direction=(-0.5, 0.0, -1.0), receivers=(1,)),
    )
    alone = Instance(sample_mesh(TriangleMesh(CORNERS, np.array(FACES)), resolution=2), near, name="near", index=99)
    return Scene((*placed, alone), lights, (0.1,) * 3, polygons=(PolygonInstance(wall, name="wall", index=98),))


@pytest.mark.parametrize("least", [4, 20])
def test_flat_surfaces_are_as_if_splats_blended(least, square, render, monkeypatch):
    """Where a pixel sees one of them, all arrays are the same: of many alike, and of different ones from a pool."""
    monkeypatch.setattr(steps, "LEAST_TOGETHER", least)
    scene = field(square)
    nearest = render(scene, CAMERA, SETTINGS)
    assert "nearest_splats" in [p.name for p in nearest.stats["plan"].passes]
    monkeypatch.setattr(steps, "MOST_NEAREST", 0.0)
    blended = render(scene, CAMERA, SETTINGS)
    inside = (nearest.coverage > 0.999) & (blended.coverage > 0.999) & (nearest.object_index == blended.object_index)
    assert inside.mean() > 0.15 and len(np.unique(nearest.object_index[inside])) > 10
    for name in OUTPUTS:
        differs = np.abs(getattr(nearest, name) - getattr(blended, name))[inside]
        assert np.quantile(differs, 0.9) < 1e-3, name
    assert np.abs(nearest.coverage - blended.coverage).mean() < 0.05
