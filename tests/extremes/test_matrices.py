# SPDX-License-Identifier: GPL-3.0-or-later
"""Instances may be mirrored, sheared and scaled from 1e-3 to 1e3 along an axis."""

import numpy as np
import pytest

from splat_addon.reference import scenes
from splat_addon.rendering import Camera, Instance, Scene, look_at

TURN = np.linalg.qr(np.random.default_rng(0).normal(size=(3, 3)))[0]
LINEAR = {
    "mirrored": np.diag([-1.0, 1, 1]),
    "sheared": np.array([[1, 3, 0], [0, 1, -2], [0, 0, 1.0]]),
    "sheared by 100": np.array([[1, 100, 0], [0, 1, 0], [0, 0, 1.0]]),
    "flat": np.diag([1e3, 1e3, 1e-3]),
    "flat, turned and mirrored": TURN @ np.diag([1e3, -1e3, 1e-3]) @ TURN.T,
    "thin": np.diag([1e3, 1e-3, 1e-3]),
    "three scales": TURN @ np.diag([1e3, 1, 1e-3]),
}


def framed(linear):
    """A sphere under the map, with its longest axis across the picture and its shortest along the view.

    The window shows the whole of its middle axis.
    """
    scene, _ = scenes.sphere(4000)
    axes, lengths, _ = np.linalg.svd(linear)
    matrix = np.eye(4)
    matrix[:3, :3] = linear
    instance = Instance(scene.surfels[0].surfels, matrix, scene.surfels[0].materials)
    distance = 4 * lengths[0]
    eye = distance * (0.9 * axes[:, 2] + 0.3 * axes[:, 1])
    window = Camera.perspective(look_at(eye, (0, 0, 0), axes[:, 1]), 3 * lengths[1] / distance, (32, 32),
                                distance / 100, 10 * distance)  # fmt: skip
    return Scene((instance,), scene.lights, scene.world), window


@pytest.mark.parametrize("name", LINEAR)
def test_any_invertible_map_is_the_true_picture(name, hold):
    ((frame, _),) = hold({name: framed(LINEAR[name])}).values()
    assert frame.coverage.any()
    assert frame.stats["instances_degenerate"] == 0


def test_a_map_that_flattens_space_is_counted(render_all):
    (frame,) = render_all([(*framed(np.diag([1.0, 1.0, 0.0])), None)])
    assert frame.stats["instances_degenerate"] == 1


@pytest.mark.parametrize("gap", [1e-2, 1e-4, 1e-6, 1e-8])
def test_axes_that_are_all_but_collinear_break_nothing(gap, render_all):
    """Beyond a ratio of 1e-7, float32 cannot distinguish the axes: any picture without NaN is accepted."""
    (frame,) = render_all([(*framed(np.array([[1, 1, 0], [1, 1 + gap, 0], [0, 0, 1.0]])), None)])
    assert all(np.isfinite(getattr(frame, name)).all() for name in ("color", "depth", "normal", "coverage"))
