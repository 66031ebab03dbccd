# SPDX-License-Identifier: GPL-3.0-or-later
"""Leaves and blades that stand apart become one merged surfel each, which covers as much as they do."""

import numpy as np
import pytest

from splat_addon.hierarchy import build_hierarchy, refit_hierarchy
from splat_addon.hierarchy.nodes import LEAST_SHOWN
from splat_addon.surfels import concatenate

from .conftest import ball, leaves_of, make_surfels, sheet

SPACING = 0.04


def leaf(count, place, turned, half=1.25 * SPACING, **fields):
    """A square of count x count surfels."""
    positions, _ = sheet(count, spacing=SPACING)
    frame = np.linalg.qr(np.random.default_rng(turned).normal(size=(3, 3)))[0]
    frame[:, 2] = np.cross(frame[:, 0], frame[:, 1])
    positions = (positions - positions.mean(axis=0)) @ frame.T + place
    return make_surfels(positions, np.tile(frame[:, 2], (count**2, 1)), half, **fields)


def leaves(number, count=8, apart=1.0):
    """Leaves on a line, turned at random."""
    return concatenate([leaf(count, (apart * k, 0.013 * k, 0), k) for k in range(number)])


def test_a_leaf_becomes_one_surfel_although_cells_cut_it():
    surfels = leaves(6)
    below, *_ = leaves_of(surfels)
    whole = [set(rows.tolist()) for rows in below.values()]
    assert all(set(range(64 * k, 64 * k + 64)) in whole for k in range(6))


def test_leaves_that_cross_are_told_apart():
    surfels = concatenate([leaf(8, (0, 0, 0), 1), leaf(8, (0.1, 0, 0), 2)])
    below, *_ = leaves_of(surfels)
    mixed = [rows for rows in below.values() if len(rows) < 64 and len(np.unique(rows // 64)) > 1]
    assert not mixed


def test_a_leaf_covers_its_own_area_where_renderers_shorten_it():
    hierarchy, (below, nodes, *_) = build_hierarchy(surfels := leaves(4, count=10)), leaves_of(leaves(4, count=10))
    (row,) = (k - len(surfels) for k, rows in below.items() if set(rows.tolist()) == set(range(100)))
    covered = (9 * SPACING + 2 * 1.25 * SPACING) ** 2 - (4 - np.pi) * (1.25 * SPACING) ** 2
    shown = np.pi * nodes.scales[row].prod() * LEAST_SHOWN
    assert hierarchy.sizes[row] < 1 and shown == pytest.approx(covered, rel=0.05)


def test_what_merges_from_leaves_behind_one_another_covers_no_more_than_they_do():
    places = np.random.default_rng(0).uniform(-2, 2, (40, 3))
    hierarchy = build_hierarchy(concatenate([leaf(6, place, 1) for place in places]))
    one = (5 * SPACING + 2.5 * SPACING) ** 2
    top = hierarchy.nodes.scales[-1].prod() * np.pi * LEAST_SHOWN
    assert hierarchy.sizes[-1] < 0.7 and 0.5 * 40 * one < top < 1.1 * 40 * one


@pytest.mark.parametrize(
    "surfels", [make_surfels(*sheet()), make_surfels(*ball(), half=0.06)], ids=["a sheet", "a ball"]
)
def test_surfaces_that_go_on_are_not_shrunk(surfels):
    assert (build_hierarchy(surfels).sizes == 1).all()


def test_a_portion_of_a_set_may_go_on_elsewhere():
    assert (build_hierarchy(leaves(6), is_portion=True).sizes == 1).all()


def test_leaves_that_moved_keep_their_sizes():
    surfels = leaves(6)
    hierarchy = build_hierarchy(surfels)
    moved = refit_hierarchy(hierarchy, surfels)
    assert (hierarchy.sizes < 1).any() and np.array_equal(moved.nodes.scales, hierarchy.nodes.scales)
    assert (moved.errors >= hierarchy.errors).all()
