# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfels that stand alone and discs that are too large are strays; even sparse regions and edges are none."""

import numpy as np
import pytest

from splat_addon.sampling.points.strayness import strayness

UP = (0.0, 0, 1)


def found_in(points, radii=1.0):
    """The strayness of surfels that face up."""
    return strayness(points, np.broadcast_to(radii, len(points)), np.broadcast_to(UP, (len(points), 3)))


def sheet(spacing=1.0, start=0.0):
    x, y = (axis.ravel() for axis in np.meshgrid(np.arange(30), np.arange(30)))
    noise = np.random.default_rng(2).normal(size=(900, 3)) * 0.1
    return spacing * (np.stack([x, y, 0 * x], axis=1) + noise) + (start, 0, 0)


def test_points_in_the_air_are_strays_and_edges_and_sparser_sheets_are_none():
    alone = np.array([(15.0, 15, 12), (60, 15, 25)])
    points = np.concatenate([sheet(), sheet(2.0, 35.0), alone])
    found = found_in(points)
    assert (found[-2:] > 1).all() and (found[:-2] < 1).all()


def test_discs_that_are_too_large_are_strays():
    radii = np.ones(900)
    radii[450] = 6.0
    found = found_in(sheet(), radii)
    assert np.flatnonzero(found > 1).tolist() == [450] and found[450] == pytest.approx((6 - 1) / (5 - 1))


def test_a_high_strength_does_not_select_what_is_like_its_neighbours():
    """The operator selects what is above 1 / strength."""
    found = found_in(np.concatenate([sheet(), [(15.5, 15.5, 1.0)]]))
    assert found[900] > 1 and (found[:900] > 1 / 5).mean() < 0.1 and np.median(found[:900]) < 0.02


def test_points_just_off_a_noisy_surface_are_strays():
    """They are no farther from others than these are."""
    points = np.concatenate([sheet(), [(15.5, 15.5, 1.0), (4.5, 8.5, -1.0)]])
    assert np.flatnonzero(found_in(points) > 1).tolist() == [900, 901]


@pytest.mark.parametrize("count", [0, 1, 12])
def test_too_few_are_no_strays(count):
    assert not found_in(np.arange(3.0 * count).reshape(count, 3)).any()


def test_of_several_in_one_place_the_others_are_no_strays():
    points = np.concatenate([sheet(), np.tile((15.0, 15, 12), (3, 1))])
    assert found_in(points)[901:].tolist() == [0, 0]
