# SPDX-License-Identifier: GPL-3.0-or-later
"""Ellipses given by their half-axes, and two simple cameras, for the tests of the reference."""

import math

import numpy as np
import pytest

from splat_addon.quaternions import axes_quaternions
from splat_addon.rendering.scene.camera import Camera
from splat_addon.surfels import Surfels


@pytest.fixture
def ellipses():
    """ellipses(centers, u, v, colors, normals) -> Surfels. u, v: orthogonal half-axes; each is rows or one vector for
    all.
    """

    def build(centers, u=(1, 0, 0), v=(0, 1, 0), colors=(1, 1, 1), normals=None):
        centers = np.atleast_2d(np.asarray(centers, float))
        u, v, colors = (np.broadcast_to(np.asarray(a, float), centers.shape) for a in (u, v, colors))
        lengths = np.stack([np.linalg.norm(u, axis=1), np.linalg.norm(v, axis=1)], axis=1)
        x, y = u / lengths[:, :1], v / lengths[:, 1:]
        z = np.cross(x, y)
        normals = z if normals is None else np.broadcast_to(np.asarray(normals, float), centers.shape)
        return Surfels(
            positions=centers,
            rotations=axes_quaternions(x, y, z),
            scales=lengths,
            normals=normals / np.linalg.norm(normals, axis=1, keepdims=True),
            colors=np.concatenate([colors, np.ones((len(colors), 1))], axis=1),
            materials=np.zeros(len(centers), int),
        )

    return build


@pytest.fixture
def perspective():
    """perspective(size, near, far) -> a camera at the origin, looking down -Z, with a window of +-1 at distance 1."""

    def build(size=(32, 32), near=0.1, far=100.0):
        return Camera.perspective(np.eye(4), math.pi / 2, size, near, far)

    return build


@pytest.fixture
def orthographic():
    """orthographic(size, height) -> a camera at the origin, looking down -Z."""

    def build(size=(32, 32), height=2.0, near=0.1, far=100.0):
        return Camera.orthographic(np.eye(4), height, size, near, far)

    return build
