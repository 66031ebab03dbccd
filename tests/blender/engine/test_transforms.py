# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfels under an object's transform look the same as surfels that were transformed one by one in float64."""

import bpy
import numpy as np
import pytest
from mathutils import Euler, Matrix

from splat_addon.blender.geometry.attributes import write_surfels
from splat_addon.blender.geometry.stored_surfels import read_surfels
from splat_addon.quaternions import axes_quaternions
from splat_addon.surfels import Surfels

TURN = Euler((0.5, 0.7, -0.4)).to_matrix().to_4x4()
#: name: the parent's and the object's own matrix
TRANSFORMS = {
    "moved and turned": (Matrix(), Matrix.Translation((0.3, -0.5, 0.7)) @ TURN),
    "scaled": (Matrix(), Matrix.Scale(1.7, 4) @ TURN),
    "mirrored": (Matrix(), TURN @ Matrix.Diagonal((-1, 1, 1, 1))),
    "non-uniform": (Matrix(), TURN @ Matrix.Diagonal((1.6, 0.5, 1.1, 1))),
    "mirrored and non-uniform": (Matrix(), TURN @ Matrix.Diagonal((1.3, -0.7, 0.9, 1))),
    "parented": (Matrix.Translation((0.5, 0, 1)) @ TURN, TURN @ Matrix.Diagonal((1.3, 0.7, 0.9, 1))),
    "sheared by its parent": (Matrix.Diagonal((1.6, 0.6, 1, 1)), TURN @ Matrix.Diagonal((0.7, 1.2, 1, 1))),
    "mirrored and sheared": (Matrix.Diagonal((1.6, 0.6, -1, 1)), TURN @ Matrix.Diagonal((0.7, 1.2, 1, 1))),
    "tiny": (Matrix(), Matrix.Translation((0, 0, 10 - 1e-3)) @ TURN @ Matrix.Scale(1e-4, 4)),
    "huge": (Matrix(), Matrix.Translation((0, 0, 10 - 1e5)) @ TURN @ Matrix.Scale(1e4, 4)),
}


@pytest.fixture
def shell(scene, add_camera, add_surfels):
    """A closed shell of colourful surfels below a camera, lit from the side."""
    scene.render.resolution_x = scene.render.resolution_y = 48
    scene.surfel_splatting.shading = "principled"
    add_camera(clip_start=1e-4, clip_end=1e6)
    sun = bpy.data.objects.new("sun", bpy.data.lights.new("sun", "SUN"))
    sun.rotation_euler = (0.6, 0.4, 0)
    scene.collection.objects.link(sun)
    k = np.arange(2000) + 0.5
    ring, angle = np.sqrt(1 - (1 - k / 1000) ** 2), k * np.pi * (3 - np.sqrt(5))
    points = np.stack([ring * np.cos(angle), ring * np.sin(angle), 1 - k / 1000], axis=1)
    colors = np.concatenate([points / 2 + 0.5, np.ones((2000, 1))], axis=1)
    return add_surfels(points, points, [0.09, 0.07], colors)


@pytest.mark.parametrize("name", TRANSFORMS)
def test_a_transform_moves_every_surfel(name, scene, shell, add_object, picture, assert_same_picture):
    shell.parent = bpy.data.objects.new("parent", None)
    scene.collection.objects.link(shell.parent)
    shell.parent.matrix_basis, shell.matrix_basis = TRANSFORMS[name]
    bpy.context.view_layer.update()
    matrix = np.array(shell.matrix_world, np.float64)
    drawn = picture()
    shell.hide_render = True
    moved = add_object(write_surfels("moved", mapped(read_surfels(shell.data)[0], matrix[:3, :3])))
    moved.location = matrix[:3, 3]
    assert_same_picture(drawn, picture(), ties=np.count_nonzero(drawn[..., 3]) // 30)


@pytest.mark.parametrize("size", [1e-5, 1e-3, 1e5, 1e25])
def test_a_scene_of_any_size_looks_the_same(size, scene, shell, picture, assert_same_picture):
    scene.camera.location = (0, 0, 0)
    shell.location = (0.1, 0.2, -10)
    expected = picture()
    shell.location, shell.scale = np.multiply(size, (0.1, 0.2, -10)), (size,) * 3
    scene.camera.data.clip_start, scene.camera.data.clip_end = 1e-6 * max(size, 1), 20 * size
    assert_same_picture(expected, picture(), ties=3)


def mapped(surfels: Surfels, linear: np.ndarray) -> Surfels:
    """The surfels under a (3, 3) map.

    An ellipse's image is an ellipse; its axes are the singular vectors of the mapped ones.
    """
    axes = np.stack(surfels.half_axes(), axis=2).astype(np.float64)
    directions, lengths, _ = np.linalg.svd(linear @ axes, full_matrices=False)
    x, y = directions[..., 0], directions[..., 1]
    outward = np.einsum("ij,ij->i", np.cross(x, y), surfels.geometric_normals() @ np.linalg.inv(linear))
    y = y * np.sign(outward)[:, None]
    normals = surfels.normals @ np.linalg.inv(linear)
    return Surfels(
        positions=surfels.positions @ linear.T,
        rotations=axes_quaternions(x, y, np.cross(x, y)),
        scales=lengths,
        normals=normals / np.linalg.norm(normals, axis=1, keepdims=True),
        colors=surfels.colors,
        materials=surfels.materials,
    )
