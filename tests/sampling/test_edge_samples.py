# SPDX-License-Identifier: GPL-3.0-or-later
"""Discs along the edges between a mesh's polygons and its splats, where one mesh is drawn as both."""

from dataclasses import replace

import numpy as np
import pytest

from splat_addon.sampling import (
    Channel,
    Surface,
    TriangleMesh,
    VertexColors,
    edge_samples,
    joined_at_edges,
    transition_edges,
)
from splat_addon.sampling.edges.edge_samples import SAME_SIDE, TOO_CLOSE, too_close
from splat_addon.surfels import Surfels, concatenate
from tests.plain import sample_mesh

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


@pytest.mark.parametrize("origin", [(0, 0, 0), (3e4, -2e4, 1e4)])
def test_what_is_too_close_to_an_edge_is_what_distances_say(origin):
    """Among surfels at random, of which half face the other way."""
    rng = np.random.default_rng(3)
    edges = edge_samples(part(LEFT), part(RIGHT), 0.1, 0.1)
    count = 4000
    turned = np.where(rng.random(count) < 0.5, 0, np.pi / 2)
    rotations = np.stack([np.cos(turned), np.sin(turned), 0 * turned, 0 * turned], axis=1)
    places = rng.uniform((-0.3, -0.3, -0.3), (0.3, 2.3, 0.3), (count, 3))
    surfels = Surfels(
        positions=places,
        rotations=rotations,
        scales=np.full((count, 2), 0.1),
        normals=np.tile((0.0, 0, 1), (count, 1)),
        colors=np.ones((count, 4)),
        materials=np.zeros(count, np.int32),
    )
    surfels, edges = (replace(one, origin=np.array(origin, float)) for one in (surfels, edges))
    apart = np.linalg.norm(surfels.positions[:, None].astype(float) - edges.positions[None].astype(float), axis=2)
    facing = surfels.geometric_normals() @ edges.geometric_normals().T > SAME_SIDE
    expected = ((apart < 0.08) & facing).any(axis=1)
    assert 20 < expected.sum() < 1000 and ((apart < 0.08).any(axis=1) & ~expected).any()
    np.testing.assert_array_equal(too_close(surfels, edges, 0.08), expected)


def test_at_the_edge_samples_of_the_edge_take_the_place_of_others():
    """Guennebaud et al. 2006, section 5.2: the weights there are no larger for it, and nothing is left bare."""
    spacing, slanted = 0.1, ROOF + ROOF[:, 1:2] * (0.3, 0, 0)
    near, far = (TriangleMesh(slanted * (1, 1, 0), triangles) for triangles in (LEFT, RIGHT))
    alone = sample_mesh(far, spacing=spacing)
    samples = edge_samples(near, far, spacing, float(np.median(alone.scales)), alone.origin)
    both = joined_at_edges(alone, near, far, spacing)
    gone = too_close(alone, samples, TOO_CLOSE * spacing)
    assert 5 < gone.sum() == len(alone) + len(samples) - len(both)
    np.testing.assert_array_equal(both.positions[-len(samples) :], samples.positions)
    edge = np.linspace(0.1, 1.9, 200)[:, None] * (0.3, 1, 0)
    crowded, even = (weights(one, edge) for one in (concatenate([alone, samples]), both))
    assert weights(alone, edge).min() < 0.6 < 1.3 < even.min()
    assert (even <= crowded + 1e-9).all() and even.mean() < 0.9 * crowded.mean()
    beside = edge[10:-10, None] + np.linspace(0, 0.3, 20)[:, None] * (1, 0, 0)
    assert weights(both, beside.reshape(-1, 3)).min() > 1


def test_parts_without_a_common_edge_keep_their_surfels():
    alone = sample_mesh(part(RIGHT), spacing=0.2)
    assert joined_at_edges(alone, part(LEFT[:0]), part(RIGHT), 0.2) is alone


def weights(surfels: Surfels, places: np.ndarray) -> np.ndarray:
    """(n,) sums of the splats' Gaussians at places on their surface, by the distance to their centres."""
    apart = np.linalg.norm(places[:, None] - (surfels.positions + surfels.origin)[None], axis=2)
    share = (apart / surfels.scales.max(axis=1)) ** 2
    return np.where(share <= 1, np.exp(-2 * share), 0).sum(axis=1)
