# SPDX-License-Identifier: GPL-3.0-or-later
"""Triangles that reach far beyond all others are left out of a conversion, and counted."""

import numpy as np
import trimesh

from splat_addon.sampling import TriangleMesh, drop_strays, drop_unusable

BALL = trimesh.creation.icosphere(subdivisions=3, radius=0.6)


def with_tips(*tips):
    faces = [(k, k + 1, len(BALL.vertices) + k) for k in range(len(tips))]
    mesh = TriangleMesh(
        np.vstack([BALL.vertices, *([tip] for tip in tips)]), np.vstack([BALL.faces, *([f] for f in faces)])
    )
    return drop_unusable(mesh)[0]


def test_few_that_reach_far_are_dropped_with_their_vertices():
    for far in (1e4, 1e7, 1e12):
        mesh, count = drop_strays(with_tips((far, 0, 0), (0, -far, 3)))
        assert count == 2 and len(mesh) == len(BALL.faces) and np.abs(mesh.positions).max() < 1


def test_others_stay():
    for mesh in (with_tips(), with_tips((50, 0, 0)), with_tips(*np.full((40, 3), 1e7))):
        assert drop_strays(mesh) == (mesh, 0)
    floor = TriangleMesh([(0, 0, 0), (1, 0, 0), (1e7, 1e7, 0)], [(0, 1, 2)])
    assert drop_strays(floor) == (floor, 0)
