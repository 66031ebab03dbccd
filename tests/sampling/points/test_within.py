# SPDX-License-Identifier: GPL-3.0-or-later
"""Indoor scans are seen from within, though their walls are seen from outside, too."""

import numpy as np

from splat_addon.sampling.points.density import is_scanned_from_within
from splat_addon.sampling.points.neighbours import nearest_neighbours
from splat_addon.sampling.points.noise import spacings
from splat_addon.sampling.points.outside import seen_sides


def box(low, high, count: int, seed: int = 0) -> tuple[np.ndarray, np.ndarray]:
    """Random points on a box, evenly spread, and its outward normals."""
    random, size = np.random.default_rng(seed), np.subtract(high, low)
    areas = np.repeat(size.prod() / size, 2)
    side = random.choice(6, count, p=areas / areas.sum())
    points, normals = random.random((count, 3)), np.zeros((count, 3))
    rows, axis = np.arange(count), side // 2
    points[rows, axis], normals[rows, axis] = side % 2, 2 * (side % 2) - 1
    return low + points * size, normals


def of_room(count: int) -> tuple[np.ndarray, np.ndarray]:
    """(n, 3) points that a scanner in a closed room of 8 x 6 x 2.5 sees in all directions alike, and normals inward."""
    directions = np.random.default_rng(1).normal(size=(count, 3))
    with np.errstate(divide="ignore"):
        reach = (np.where(directions > 0, (7.2, 5.4, 1.2), (-0.8, -0.6, -1.3)) / directions).min(axis=1)
    points = reach[:, None] * directions
    axis = (np.abs(points - (3.2, 2.4, -0.05)) / (4, 3, 1.25)).argmax(axis=1)
    return points, -np.sign(directions) * np.eye(3)[axis]


def right(points: np.ndarray, normals: np.ndarray, count: int | None = None) -> float:
    """Share of the first points of which more is seen of the side that their geometric normals face."""
    near, distances = nearest_neighbours(points, 12)
    more, _ = seen_sides(points, normals, near, spacings(distances))
    return (more[:count] > 0).mean()


def test_furniture_that_walls_hide_shows_that_a_room_is_seen_from_within():
    walls, outward = box((0, 0, 0), (5, 4, 3), 16000)
    table, of_table = box((2, 1.5, 0.8), (3, 2.5, 1.2), 1000, seed=1)
    assert right(np.concatenate([walls, table]), np.concatenate([-outward, of_table])) > 0.95


def test_a_room_is_seen_from_within_if_it_is_denser_near_a_place_there():
    points, inward = of_room(10000)
    assert right(points, inward) > 0.95


def test_a_body_is_seen_from_outside_though_strays_hide_it():
    points, outward = box((0, 0, 0), (5, 4, 3), 9000)
    strays = np.random.default_rng(2).uniform(-4, 9, (400, 3))
    every = np.concatenate([outward, np.tile((0.0, 0, 1), (400, 1))])
    assert right(np.concatenate([points, strays]), every, len(points)) > 0.95


def test_even_density_shows_no_scanner():
    points, normals = box((0, 0, 0), (5, 4, 3), 4000)
    assert not is_scanned_from_within(points, normals, spacings(nearest_neighbours(points, 12)[1]))
