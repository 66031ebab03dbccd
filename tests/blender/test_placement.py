# SPDX-License-Identifier: GPL-3.0-or-later
"""A surfel object lies exactly over its source, however the source is placed."""

import bpy
import numpy as np
import pytest
from mathutils import Matrix
from mathutils.bvhtree import BVHTree

from splat_addon.blender.conversion.placement import without_shear

PLACES = {
    "offset": Matrix.Translation((100, -200, 300)),
    "turned": Matrix.Rotation(1.0, 4, (1, 2, 3)),
    "unevenly scaled": Matrix.Diagonal((3, 0.5, 0.01, 1)),
    "mirrored": Matrix.Diagonal((-1, 1, 1, 1)),
    "all together": Matrix.LocRotScale((5, 6, 7), Matrix.Rotation(2.0, 3, (3, 1, 2)), (-2, 0.3, 4)),
}


@pytest.fixture
def distances(convert, world_positions):
    """distances(source) -> the distances of its whole surfels' centres from its surface, in the source's own space.

    In that space the mesh is as it was modelled; elsewhere trimesh, which is used to measure, would suffer from
    slivers.
    """

    def measure(source):
        made = convert(resolution=24, clips_edges=False)[0]
        to_source = np.linalg.inv(np.array(source.matrix_world, np.float64))
        positions = world_positions(made) @ to_source[:3, :3].T + to_source[:3, 3]
        tree = BVHTree.FromObject(source, bpy.context.evaluated_depsgraph_get())
        return np.array([tree.find_nearest(position)[3] for position in positions])

    return measure


@pytest.fixture
def suzanne():
    bpy.ops.mesh.primitive_monkey_add()
    monkey = bpy.context.object
    monkey.modifiers.new("triangles", "TRIANGULATE")
    return monkey


@pytest.mark.parametrize("place", PLACES)
def test_surfels_lie_on_the_surface_of_their_source(suzanne, distances, place):
    suzanne.matrix_world = PLACES[place]
    distance = distances(suzanne)
    # Suzanne is 2 wide; float32 rounds her location by 6e-8 of it.
    rounding = 6e-8 * suzanne.location.length / min(abs(s) for s in suzanne.scale)
    assert len(distance) > 300
    assert distance.max() < 1e-6 + 2 * rounding


def test_surfels_follow_a_source_that_its_parent_shears(suzanne, distances):
    shear(suzanne)
    assert distances(suzanne).max() < 2e-6


def shear(source):
    """Turn the object below an unevenly scaled parent."""
    parent = bpy.data.objects.new("parent", None)
    bpy.context.collection.objects.link(parent)
    parent.scale = (3, 1, 0.5)
    source.parent, source.rotation_euler = parent, (0.5, 0.6, 0.7)
    bpy.context.view_layer.update()


def test_normals_follow_the_shear_too(convert, surfels_of):
    bpy.ops.mesh.primitive_cube_add()
    shear(bpy.context.object)
    surfels = surfels_of(convert(resolution=16)[0])
    # The box is flat-shaded, so its shading normals equal the ellipses' normals.
    assert np.einsum("ij,ij->i", surfels.normals, surfels.geometric_normals()).min() > 0.99999


def test_a_frozen_copy_has_no_parent(suzanne, convert):
    suzanne.parent = bpy.data.objects.new("parent", None)
    assert convert(resolution=8, follow=False)[0].parent is None


def test_a_place_does_not_hang_on_an_evaluated_object_s_memory(suzanne):
    """An object's matrix is a view of the object's memory, which Blender frees while a conversion is still running."""
    evaluated = suzanne.evaluated_get(bpy.context.evaluated_depsgraph_get())
    assert evaluated.matrix_world.owner is not None
    assert without_shear(evaluated.matrix_world)[0].owner is None
