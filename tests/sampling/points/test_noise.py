# SPDX-License-Identifier: GPL-3.0-or-later
"""Noisy points have the normals of their surface, those on no surface that of their surroundings, and strays beside a
surface are found."""

import numpy as np
import pytest

from splat_addon.sampling import surfels_from_points


def sheet(count: int, noise: float, shape=lambda x, y: 0 * x) -> np.ndarray:
    """Random points whose spacing is 1, over a square; noise: in spacings."""
    random = np.random.default_rng(0)
    x, y = random.random((2, count)) * np.sqrt(count)
    return np.stack([x, y, shape(x - x.mean(), y - y.mean())], axis=1) + noise * random.normal(size=(count, 3))


def degrees(normals, true) -> np.ndarray:
    return np.degrees(np.arccos(np.clip((normals * true).sum(axis=1), -1, 1)))


@pytest.mark.parametrize(("noise", "is_noisy"), [(0.05, False), (0.5, True)])
def test_normals_under_noise(noise, is_noisy):
    surfels, report = surfels_from_points(sheet(4000, noise))
    assert (degrees(surfels.normals, (0, 0, 1)) < 10).mean() > 0.98
    assert report.isolated < 0.005 * 4000
    assert (report.noisy > 3900) == is_noisy and (report.noisy < 100) != is_noisy


def test_a_noisy_roof_keeps_its_ridge():
    """Two slopes of 45 degrees: a plane through both sides would be level."""
    surfels, _ = surfels_from_points(sheet(4000, 0.3, lambda x, y: -np.abs(x)))
    from_ridge = surfels.positions[:, 0] + surfels.origin[0] - np.sqrt(4000) / 2
    side = np.sign(from_ridge)[:, None] * (1, 0, 0) + (0, 0, 1)
    beside = (np.abs(from_ridge) > 2) & (np.abs(from_ridge) < 4)
    assert (degrees(surfels.normals, side / np.sqrt(2))[beside] < 20).mean() > 0.9


def test_points_close_to_a_noisy_ridge_take_the_plane_of_their_side():
    """Neighbourhoods that cross the ridge give a third of them normals that are more than ten degrees off."""
    surfels, _ = surfels_from_points(sheet(4000, 0.5, lambda x, y: -np.abs(x)))
    from_ridge = surfels.positions[:, 0] + surfels.origin[0] - np.sqrt(4000) / 2
    side = np.sign(from_ridge)[:, None] * (1, 0, 0) + (0, 0, 1)
    beside = (np.abs(from_ridge) > 1) & (np.abs(from_ridge) < 3)
    assert (degrees(surfels.normals, side / np.sqrt(2))[beside] < 10).mean() > 0.88


def test_leaves_are_lit_as_their_surroundings():
    """Points in a ball lie on no surface: neighbours must not have directions of their own."""
    ball = np.random.default_rng(0).uniform(-1, 1, (12_000, 3))
    ball = 10 * ball[np.linalg.norm(ball, axis=1) < 1]
    surfels, report = surfels_from_points(ball, viewpoint=(0, 0, 100))
    assert report.untrusted > 0.8 * len(ball)
    near = np.argsort(np.linalg.norm(surfels.positions, axis=1))[:20]
    alike = surfels.normals[near] @ surfels.normals[near].T
    assert np.median(alike) > 0.5


def test_strays_beside_a_noisy_surface_are_found():
    points = sheet(4000, 0.5)
    strays = np.random.default_rng(1).uniform((5, 5, 3), (58, 58, 6), (40, 3))
    _, report = surfels_from_points(np.concatenate([points, strays]))
    assert (~np.isin(np.arange(4000, 4040), report.kept)).sum() >= 36
    assert np.isin(np.arange(4000), report.kept).sum() > 3980


def test_a_valley_faces_up():
    surfels, _ = surfels_from_points(sheet(2000, 0.1, lambda x, y: 0.02 * (x * x + y * y)))
    assert (surfels.normals[:, 2] > 0).all()


def test_flattened_points_lie_on_the_surface():
    plain, flat = (surfels_from_points(sheet(4000, 0.5), flattens_noise=choice)[0] for choice in (False, True))
    heights = [np.std(surfels.positions[:, 2]) for surfels in (plain, flat)]
    assert heights[0] > 0.45 and heights[1] < 0.15


def test_what_a_nearer_scanner_saw_more_densely_is_left_out():
    """The far scan covers all of a sheet, the near one a corner of it, with eight times the density."""
    random = np.random.default_rng(2)
    far, near = 64 * random.random((2000, 3)) * (1, 1, 0), 32 * random.random((4000, 3)) * (1, 1, 0)
    points = np.concatenate([far, near])
    scanners = np.repeat([(32, 32, 100.0), (16, 16, 20.0)], (2000, 4000), axis=0)
    _, report = surfels_from_points(points, scanners=scanners)
    is_kept = np.isin(np.arange(6000), report.kept)
    inside, outside = (far[:, :2] < 30).all(axis=1), (far[:, :2] > 36).any(axis=1)
    assert is_kept[:2000][inside].mean() < 0.01 and is_kept[:2000][outside].all() and is_kept[2000:].all()
    assert report.overlapped == np.count_nonzero(~is_kept)
    _, report = surfels_from_points(points, scanners=scanners, thins_overlaps=False)
    assert report.overlapped == 0
