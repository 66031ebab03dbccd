# SPDX-License-Identifier: GPL-3.0-or-later
"""Discs along the edges between a mesh's polygons and its splats, where one mesh is drawn as both."""

import numpy as np
import pytest

from splat_addon.sampling import Channel, Surface, TriangleMesh, VertexColors, edge_samples, transition_edges

#: Two squares that meet along x = 0 in a roof, each of two triangles.
ROOF = np.array([(-1.0, 0, -1), (0, 0, 0), (0, 2, 0), (-1, 2, -1), (1, 0, -1), (1, 2, -1)])
LEFT = np.array([(0, 1, 2), (0, 2, 3)])
RIGHT = np.array([(1, 4, 5), (1, 5, 2)])


def part(triangles, **fields):
    return TriangleMesh(ROOF, triangles, **fields)


def test_they_lie_on_the_edge_evenly_and_face_between_both_parts():
    samples = edge_samples(part(LEFT), part(RIGHT), 0.3, 0.2, origin=(0, 1, 0))
    places = samples.positions + samples.origin
    assert len(samples) == 7 and np.allclose(places[:, [0, 2]], 0)
    along = np.sort(places[:, 1])
    assert np.allclose(np.diff(along), 2 / 7) and np.isclose(along[0], 1 / 7)
    assert np.allclose(samples.geometric_normals(), (0, 0, 1), atol=1e-6)
    assert np.allclose(samples.normals, (0, 0, 1), atol=1e-6)
    assert (samples.scales == np.float32(0.2)).all()


def test_only_edges_of_both_parts_are_sampled():
    triangles, number = transition_edges(part(LEFT), part(RIGHT))
    edges = {frozenset(RIGHT[t][[k, (k + 1) % 3]].tolist()) for t, k in zip(triangles, number, strict=True)}
    assert edges == {frozenset((1, 2))}


def test_their_values_are_those_of_the_sampled_part():
    colors = np.zeros((2, 3, 4))
    colors[..., 3] = 1
    colors[..., 0] = ROOF[RIGHT][..., 1] / 2
    painted = part(
        RIGHT,
        corner_colors=colors,
        corner_normals=np.tile((0.0, 0.6, 0.8), (2, 3, 1)),
        surfaces=(Surface(Channel((1.0, 0.5, 1.0, 1.0), VertexColors()), roughness=Channel((0.5,))),),
    )
    samples = edge_samples(part(LEFT), painted, 0.3, 0.2)
    assert np.allclose(samples.colors[:, 0], samples.positions[:, 1] / 2, atol=1e-6)
    assert np.allclose(samples.normals, (0, 0.6, 0.8), atol=1e-6)


def test_parts_without_a_common_edge_are_refused():
    with pytest.raises(ValueError, match="no edge in common"):
        edge_samples(part(LEFT[:1]), part(LEFT[:0]), 0.3, 0.2)
