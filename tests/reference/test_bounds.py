# SPDX-License-Identifier: GPL-3.0-or-later
"""A splat's box in the picture contains all of it and no more."""

import math

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from splat_addon.reference.splats import Splats, projected_bounds
from splat_addon.rendering.scene.camera import Camera

CAMERAS = {
    "perspective": Camera.perspective(np.eye(4), 1.0, (8, 8), 0.1, 50),
    "orthographic": Camera.orthographic(np.eye(4), 4.0, (8, 8), 0.1, 50),
}
numbers = st.floats(-2, 2)
vectors = st.tuples(numbers, numbers, numbers).map(np.array)


def one_splat(center, u, v) -> Splats:
    rest = np.zeros((3, 1, 3))
    own = np.zeros(1, bool), *_NO_TEXTURE[:-3], np.tile((1.0, 0.0, 1.0), (1, 2, 1)), np.zeros(1, bool), np.ones(1)
    last = *_NO_TEXTURE[-3:], np.zeros(1), np.zeros((1, 2, 3))
    return Splats(center[None], u[None], v[None], np.cross(u, v)[None], *rest, *own, *last)


_NO_TEXTURE = (
    np.full(1, None),
    np.zeros((1, 2)),
    np.zeros((1, 2, 2)),
    np.zeros((1, 2)),
    np.ones(1),
    *np.zeros((2, 1), bool),
)


@pytest.mark.parametrize("kind", CAMERAS)
@given(center=vectors, u=vectors, v=vectors)
@settings(deadline=None, max_examples=150)
def test_boxes_are_exact(kind, center, u, v):
    camera = CAMERAS[kind]
    center = center - np.array((0, 0, 5))
    angle = np.linspace(0, 2 * math.pi, 2001)[:, None]
    rim = center + np.cos(angle) * u + np.sin(angle) * v
    assume(-rim[:, 2].max() > 0.2 and np.linalg.norm(np.cross(u, v)) > 1e-3)
    points = rim[:, :2] if camera.is_orthographic else rim[:, :2] / -rim[:, 2:]
    low, high = projected_bounds(one_splat(center, u, v), camera)
    span = np.ptp(points, axis=0).max()
    assert (low[0] <= points.min(axis=0) + 1e-12).all() and (high[0] >= points.max(axis=0) - 1e-12).all()
    np.testing.assert_allclose([low[0], high[0]], [points.min(axis=0), points.max(axis=0)], atol=1e-3 * span)


def test_a_splat_that_touches_the_near_plane_may_be_anywhere():
    low, high = projected_bounds(one_splat(np.array((0, -1.0, -1)), np.eye(3)[0], np.eye(3)[2]), CAMERAS["perspective"])
    assert (low == -np.inf).all() and (high == np.inf).all()


@pytest.mark.parametrize("kind", CAMERAS)
@pytest.mark.parametrize("depth", [-2.0, 52.0])
def test_a_splat_outside_the_clip_distances_is_nowhere(kind, depth):
    low, high = projected_bounds(one_splat(np.array((0, 0, -depth)), np.eye(3)[0], np.eye(3)[2]), CAMERAS[kind])
    assert (low > high).all()
