# SPDX-License-Identifier: GPL-3.0-or-later
"""An object with more surfels than a texture holds is one set, and looks the same."""

import bpy
import numpy as np
import pytest

from splat_addon.blender.export.live_meshes import LiveMeshes
from splat_addon.blender.export.scene import export_scene
from splat_addon.blender.export.surfel_store import SurfelStore
from splat_addon.rendering.upload import parts
from splat_addon.surfels import portions

#: Splats of a texture in these tests.
FEW = 512


@pytest.fixture
def sheet(add_camera, add_surfels):
    """A closed sheet of 8,281 overlapping surfels of changing colour."""
    add_camera(location=(0, 0, 10))
    x, y = (column.ravel() for column in np.meshgrid(np.linspace(-2, 2, 91), np.linspace(-2, 2, 91)))
    positions = np.stack([x, y, 0.1 * np.sin(x)], axis=1)
    colors = np.concatenate([positions * 0.2 + 0.5, np.ones((len(x), 1))], axis=1)
    return add_surfels(positions, size=0.06, colors=colors)


def exported() -> list:
    """The sets of surfels that a render gets."""
    store = SurfelStore()
    store.begin_frame()
    found, _ = export_scene(bpy.context.evaluated_depsgraph_get(), store, LiveMeshes())
    return [instance.surfels for instance in found.surfels]


@pytest.mark.parametrize("tolerance", [0.0, 4.0])
def test_the_picture_from_several_textures_is_that_from_one(sheet, picture, monkeypatch, tolerance):
    """With merged surfels, too: they are of the object, whichever textures have them."""
    settings = bpy.context.scene.surfel_splatting
    settings.detail_tolerance, settings.samples = tolerance, 16
    whole = picture()
    monkeypatch.setattr(parts, "PART", FEW)
    assert [len(surfels) for surfels in exported()] == [8281]
    assert whole[..., 3].max() == 1 and np.abs(picture() - whole).max() < 2e-5


def test_the_picture_of_a_sampled_mesh_is_the_same(add_camera, picture, monkeypatch):
    add_camera(location=(0, 0, 4))
    bpy.ops.mesh.primitive_cube_add(size=1, rotation=(0.4, 0.3, 0.2))
    settings = bpy.context.scene.surfel_splatting
    settings.render_meshes, settings.mesh_resolution, settings.detail_tolerance = "SURFELS", 40, 0
    whole = picture()
    monkeypatch.setattr(parts, "PART", FEW)
    assert len(exported()) == 1 and len(exported()[0]) > 4 * FEW
    assert whole[..., 3].max() == 1 and np.abs(picture() - whole).max() < 2e-5


def test_a_set_that_is_held_is_not_split(random_surfels):
    surfels = random_surfels(10)
    assert portions(surfels, 10) == (surfels,)
    some = portions(surfels, 4)
    assert [len(part) for part in some] == [4, 4, 2]
    assert (np.concatenate([part.normals for part in some]) == surfels.normals).all()
    assert all(np.shares_memory(part.colors, surfels.colors) for part in some)
