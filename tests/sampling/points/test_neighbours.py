# SPDX-License-Identifier: GPL-3.0-or-later
"""The grid finds the same neighbours as a kd-tree, however the points are spread."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from scipy.spatial import cKDTree

from splat_addon.sampling.points.neighbours import nearest_neighbours

RANDOM = np.random.default_rng(1)


def on_a_sphere(count):
    points = RANDOM.normal(size=(count, 3))
    return points / np.linalg.norm(points, axis=1, keepdims=True)


CLOUDS = {
    "a sphere": on_a_sphere(4000),
    "a cube": RANDOM.random((3000, 3)),
    "a line": np.outer(RANDOM.random(2000), (1, 2, 3)),
    "a plane grid": np.stack((*np.divmod(np.arange(2500.0), 50), np.zeros(2500)), axis=1),
    "densities from 1 to 1e8": on_a_sphere(4000) * np.exp(3 * RANDOM.normal(size=(4000, 1))),
    "two far strays": np.concatenate([on_a_sphere(2000), [(1e9, 0, 0), (0, 1e12, 5)]]),
    "two clusters far apart": np.concatenate([on_a_sphere(1000), 1e6 * on_a_sphere(1000) + 5e17]),
    "strays at the end of the range": np.concatenate([on_a_sphere(2000), [(-5e17, 0, 0), (0, 1e18, 5)]]),
    "a dense cluster in the open": np.concatenate([RANDOM.random((1000, 3)), 1e-6 * RANDOM.random((1000, 3))]),
    "far from the origin": on_a_sphere(2000) + 1e7,
    "20 points": RANDOM.random((20, 3)),
}


@pytest.mark.parametrize("cloud", CLOUDS)
@pytest.mark.parametrize("count", [1, 16])
def test_distances_are_those_of_a_kd_tree(cloud, count):
    points = CLOUDS[cloud]
    _, distances = nearest_neighbours(points, count)
    exact = cKDTree(points).query(points, count + 1)[0][:, 1:]
    assert np.allclose(distances, exact, rtol=2e-5, atol=0)


@pytest.mark.parametrize("cloud", CLOUDS)
def test_neighbours_lie_at_their_distances_and_are_others(cloud):
    points = CLOUDS[cloud]
    neighbours, distances = nearest_neighbours(points, 8)
    assert (neighbours != np.arange(len(points))[:, None]).all()
    assert all(len(set(row)) == 8 for row in neighbours.tolist())
    measured = np.linalg.norm(points[neighbours] - points[:, None], axis=2)
    assert np.allclose(distances, measured, rtol=2e-5, atol=0)


@settings(max_examples=settings.default.max_examples // 2)
@given(arrays(np.int64, (40, 3), elements=st.integers(0, 30)), st.integers(0, 40), st.integers(1, 6))
def test_any_points_have_the_neighbours_of_a_plain_search(cells, exponent, count):
    points = np.unique(cells, axis=0) * 2.0**exponent
    if len(points) <= count:
        return
    _, distances = nearest_neighbours(points, count)
    exact = np.sort(np.linalg.norm(points[:, None] - points[None], axis=2), axis=1)[:, 1 : count + 1]
    assert np.allclose(distances, exact, rtol=1e-6)


@pytest.mark.parametrize("count", [0, 5])
def test_too_few_points_are_an_error_with_both_numbers(count):
    with pytest.raises(ValueError, match=f"5 points do not have {count} neighbours each"):
        nearest_neighbours(np.random.default_rng(0).random((5, 3)), count)
