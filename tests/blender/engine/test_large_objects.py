# SPDX-License-Identifier: GPL-3.0-or-later
"""An object with more surfels than one set holds is drawn as several sets, and looks the same."""

import bpy
import numpy as np
import pytest

from splat_addon.blender.export import scene
from splat_addon.blender.export.live_meshes import LiveMeshes
from splat_addon.rendering.upload import packing
from splat_addon.surfels import portions


@pytest.fixture
def sheet(add_camera, add_surfels):
    """A closed sheet of 400 overlapping surfels of changing colour."""
    add_camera(location=(0, 0, 10))
    x, y = np.meshgrid(np.linspace(-2, 2, 20), np.linspace(-2, 2, 20))
    positions = np.stack([x.ravel(), y.ravel(), 0.1 * np.sin(x.ravel())], axis=1)
    colors = np.concatenate([positions * 0.2 + 0.5, np.ones((400, 1))], axis=1)
    return add_surfels(positions, size=0.3, colors=colors)


def test_the_picture_of_several_sets_is_that_of_one(sheet, picture, monkeypatch):
    whole = picture()
    monkeypatch.setattr(scene, "LARGEST_SET", 150)
    assert whole[..., 3].max() == 1 and np.abs(picture() - whole).max() < 1e-5


def test_merged_surfels_fit_beside_those_of_the_largest_set(add_camera, add_surfels, picture, monkeypatch):
    """The limits are lowered: 8,281 surfels and their merged ones exceed one texture, so two sets hold them."""
    add_camera(location=(0, 0, 60))
    x, y = np.meshgrid(np.linspace(-2, 2, 91), np.linspace(-2, 2, 91))
    add_surfels(np.stack([x.ravel(), y.ravel(), 0 * x.ravel()], axis=1), size=0.06)
    bpy.context.scene.surfel_splatting.detail_tolerance, bpy.context.scene.surfel_splatting.samples = 1.25, 16
    monkeypatch.setattr(packing, "MAX_SPLATS", 8704)
    monkeypatch.setattr(scene, "LARGEST_SET", 8704)
    with pytest.raises(RuntimeError, match="can hold 8,704 surfels"):
        picture()
    monkeypatch.setattr(scene, "LARGEST_SET", 8704 // 2)
    assert picture()[..., 3].max() > 0


def test_the_sets_stay_the_same_from_frame_to_frame(sheet, monkeypatch):
    """The renderer recognises uploaded sets by their identity, so other objects would be uploaded again."""
    monkeypatch.setattr(scene, "LARGEST_SET", 150)
    store, live = scene.SurfelStore(), LiveMeshes()
    frames = []
    for _ in range(2):
        store.begin_frame()
        exported, _ = scene.export_scene(bpy.context.evaluated_depsgraph_get(), store, live)
        frames.append([instance.surfels for instance in exported.surfels])
    assert [len(surfels) for surfels in frames[0]] == [150, 150, 100]
    assert all(a is b for a, b in zip(*frames, strict=True))


def test_a_set_that_is_held_is_not_split(random_surfels):
    surfels = random_surfels(10)
    assert portions(surfels, 10) == (surfels,)
    parts = portions(surfels, 4)
    assert [len(part) for part in parts] == [4, 4, 2]
    assert (np.concatenate([part.normals for part in parts]) == surfels.normals).all()
    assert all(np.shares_memory(part.colors, surfels.colors) for part in parts)
