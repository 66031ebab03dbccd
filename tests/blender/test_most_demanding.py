# SPDX-License-Identifier: GPL-3.0-or-later
"""Of thousands of places of a mesh, few are looked at to find the spacing that the most demanding one needs."""

import bpy
import numpy as np
import pytest

from splat_addon.blender.conversion import camera_density
from splat_addon.blender.conversion.camera_density import most_demanding, seen_spacing
from splat_addon.sampling import NotSeenError, Outline

SURFACE = Outline(np.random.default_rng(5).uniform(-0.2, 0.2, (50, 3)), 0.01, 0.1)


def spacing_at(matrix, depsgraph):
    try:
        return seen_spacing(1.5, SURFACE, matrix, depsgraph)
    except NotSeenError:
        return np.inf


@pytest.mark.parametrize("kind", ["PERSP", "ORTHO", "PANO"])
def test_the_most_demanding_place_is_found_and_one_that_is_not_seen(kind, monkeypatch):
    scene, data = bpy.context.scene, bpy.data.cameras.new("camera")
    data.type = kind
    scene.camera = bpy.data.objects.new("camera", data)
    scene.collection.objects.link(scene.camera)
    random = np.random.default_rng(6)
    matrices = np.tile(np.eye(4), (300, 1, 1))
    matrices[:, :3, :3] *= random.uniform(0.5, 2, (300, 1, 1))
    matrices[:, :3, 3] = random.uniform((-6, -6, -9), (6, 6, 9), (300, 3))
    depsgraph = bpy.context.evaluated_depsgraph_get()
    expected = np.array([spacing_at(matrix, depsgraph) for matrix in matrices])
    asked, find = [], camera_density.seen_spacing
    monkeypatch.setattr(camera_density, "seen_spacing", lambda *given: asked.append(given) or find(*given))
    found = [spacing_at(matrix, depsgraph) for matrix in most_demanding(1.5, SURFACE, matrices, depsgraph)]
    assert found == [expected.min(), np.inf][: 1 + np.isinf(expected).any()]
    assert 0 < len(asked) < 60


def test_without_a_camera_one_place_is_enough():
    bpy.context.scene.camera = None
    matrices = np.tile(np.eye(4), (9, 1, 1))
    assert len(most_demanding(1.5, SURFACE, matrices, bpy.context.evaluated_depsgraph_get())) == 1
