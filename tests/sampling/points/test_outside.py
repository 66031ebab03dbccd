# SPDX-License-Identifier: GPL-3.0-or-later
"""The sides of bodies are seen from outside; sheets are seen from both sides and left to their neighbours."""

import numpy as np

from splat_addon.sampling.points.neighbours import nearest_neighbours
from splat_addon.sampling.points.orientation import consistent_signs
from splat_addon.sampling.points.outside import seen_sides


def ball(count: int) -> np.ndarray:
    """Random points on a sphere of radius 1."""
    points = np.random.default_rng(0).normal(size=(count, 3))
    return points / np.linalg.norm(points, axis=1, keepdims=True)


def test_a_ball_is_seen_from_outside_whatever_the_signs_of_its_normals():
    points = ball(4000)
    signs = np.random.default_rng(1).choice((-1, 1), 4000)
    more, both = seen_sides(points, signs[:, None] * points, nearest_neighbours(points, 12)[0], np.full(4000, 0.056))
    assert (signs * more / both > 0.95).all()


def test_a_sheet_is_seen_from_both_sides():
    points = 64 * np.random.default_rng(0).random((4000, 3)) * (1, 1, 0)
    more, both = seen_sides(
        points, np.tile((0.0, 0.0, 1.0), (4000, 1)), nearest_neighbours(points, 12)[0], np.ones(4000)
    )
    assert np.abs(more).sum() < 0.05 * both.sum()


def test_what_is_seen_from_outside_decides_between_parts_that_disagree():
    """Towards the southern half of a ball normals turn to the inside, in steps that neighbours follow with doubt."""
    points = ball(4000)
    south = np.cross(np.cross(points, (0, 0, -1)), points)
    turned = np.radians(45) * np.digitize(-points[:, 2], (-0.24, -0.08, 0.08, 0.24))[:, None]
    normals = np.cos(turned) * points + np.sin(turned) * south / np.linalg.norm(south, axis=1, keepdims=True)
    near = nearest_neighbours(points, 12)[0]
    sides = seen_sides(points, normals, near, np.full(4000, 0.056))
    far = np.abs(points[:, 2]) > 0.3
    facing = []
    for told in (None, sides):
        signs, _, faces_outside = consistent_signs(points, normals, near, told)
        facing.append(((signs[:, None] * normals * points).sum(axis=1)[far] > 0).mean())
    assert 0.4 < facing[0] < 0.6 and facing[1] == 1 and faces_outside.all()
