# SPDX-License-Identifier: GPL-3.0-or-later
"""Merged surfels of small objects without clip lines: ellipses of what lines keep, with measured errors."""

import math
from dataclasses import replace

import numpy as np
import pytest

from splat_addon.clip_lines import pack_lines
from splat_addon.hierarchy import build_hierarchy, without_lines
from splat_addon.quaternions import quaternion_axes
from splat_addon.sampling import TriangleMesh, sample_mesh

#: A blade of grass, narrower than its surfels are long.
CORNERS = [(-0.02, 0, 0), (0.02, 0, 0), (0.015, 0, 0.3), (-0.015, 0, 0.3), (0, 0.05, 0.5)]
BLADE = sample_mesh(TriangleMesh(np.array(CORNERS), np.array([(0, 1, 2), (0, 2, 3), (3, 2, 4)])), resolution=24)


@pytest.fixture(scope="module")
def clipped():
    return build_hierarchy(BLADE)


def test_what_a_line_halves_has_the_moments_of_half_an_ellipse(clipped):
    half, whole = (pack_lines(np.array([line])) for line in ((0, 1, 0), (0, 1, 2)))
    lines = np.repeat(half, len(clipped), axis=0)
    lines[1:] = whole
    nodes = replace(clipped.nodes, clip_line=lines, clip_line_2=None)
    made = without_lines(replace(clipped, nodes=nodes), BLADE).nodes
    (su, sv), away = nodes.scales[0].astype(float), 4 / (3 * math.pi)
    axes = [axis[0] for axis in quaternion_axes(nodes.rotations.astype(float))]
    np.testing.assert_allclose(made.positions[0], nodes.positions[0] + axes[1] * sv * away, atol=0.01 * sv)
    expected = sorted([su, 2 * sv * math.sqrt(0.25 - away**2)], reverse=True)
    np.testing.assert_allclose(made.scales[0], expected, rtol=0.02)
    np.testing.assert_array_equal(made.scales[1:], nodes.scales[1:])
    normals = [quaternion_axes(each.rotations.astype(float))[2] for each in (made, nodes)]
    np.testing.assert_allclose(*normals, atol=1e-6)


def test_no_merged_surfel_has_lines_and_errors_rise(clipped):
    made = without_lines(clipped, BLADE)
    assert clipped.nodes.clipped_count and not made.nodes.is_clipped
    assert (made.errors <= clipped.errors).all()
    assert np.count_nonzero(made.errors[:, 1] < 0.8 * clipped.errors[:, 1]) >= len(made) / 3
    # each level's entries stand for runs of those below
    children, at = made.entries[: made.surfels], 0
    own = np.concatenate([np.zeros(made.surfels, np.float32), made.errors[:, 1]])
    while at < len(made.counts):
        last = at + int(np.searchsorted(np.cumsum(made.counts[at:]), len(children))) + 1
        parents = made.entries[made.surfels + at : made.surfels + last]
        assert (np.repeat(own[parents], made.counts[at:last]) >= own[children]).all()
        children, at = parents, last


def test_what_surfels_show_is_within_the_error(clipped):
    """All of the blade, whose corners bound it, is near the ellipse of the one that stands for all of it."""
    made = without_lines(clipped, BLADE)
    node = int(np.argmax(made.errors[:, 1]))
    axes = np.stack([axis[node] for axis in quaternion_axes(made.nodes.rotations.astype(float))[:2]])
    corners = (np.array(CORNERS) - BLADE.origin - made.nodes.positions[node]) @ axes.T
    reach = np.linalg.norm(corners / made.nodes.scales[node], axis=1)
    beyond = np.linalg.norm(corners, axis=1) * (1 - 1 / np.maximum(reach, 1))
    assert 0 < beyond.max() <= made.errors[node, 1]


def test_merged_surfels_with_textures_keep_their_lines():
    many = len(BLADE)
    textured = replace(BLADE, uvs=np.zeros((many, 2)), uv_along_x=np.ones((many, 2)), uv_along_y=np.ones((many, 2)))
    made = build_hierarchy(textured)
    assert without_lines(made, textured) is made
