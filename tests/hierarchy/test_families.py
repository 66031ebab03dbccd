# SPDX-License-Identifier: GPL-3.0-or-later
"""Families that merge are gathered by size, each child once, and sums and extremes are those of the runs."""

import numpy as np
import pytest

from splat_addon.hierarchy.families import Families, families, largest, total
from splat_addon.hierarchy.merging import merged
from splat_addon.hierarchy.nodes import Leaves
from splat_addon.hierarchy.runs import Runs

from .conftest import make_surfels, sheet

RANDOM = np.random.default_rng(3)


def runs_of(counts):
    counts = np.asarray(counts)
    return Runs(np.cumsum(counts) - counts, counts)


@pytest.mark.parametrize(
    "counts",
    [[2], [9] * 4000, RANDOM.integers(2, 30, 5000), [3, 2, 300, 65, 64, 70_000], RANDOM.integers(2, 2000, 40)],
    ids=["one", "alike", "mixed", "large", "wide"],
)
def test_sums_and_extremes_are_those_of_the_runs(counts):
    runs = runs_of(counts)
    values = RANDOM.normal(size=runs.counts.sum()).astype(np.float32)
    sums, extremes, numbers = np.full((3, len(counts)), np.nan)
    for some in families(runs, 1 << 14):
        own = values[some.children]
        sums[some.parents] = total(own if some.counted is None else own * some.counted)
        extremes[some.parents] = largest(own)
        numbers[some.parents] = len(own) if some.counted is None else some.counted.sum(axis=0)
        assert some.children.size <= max(1 << 14, 2 * max(counts))
    exact = np.add.reduceat(values.astype(np.float64), runs.starts)
    assert np.abs(sums - exact).max() < 1e-6 * np.sqrt(max(counts)) * 4
    assert np.array_equal(extremes, np.maximum.reduceat(values, runs.starts))
    assert np.array_equal(numbers, counts)


def test_sums_of_very_many_do_not_drift():
    many = np.full((1 << 17, 2), 0.1, np.float32)
    assert np.abs(total(many) / len(many) - 0.1).max() < 1e-6


def test_few_families_share_few_groups():
    """A level of a hundred families of twenty sizes is not worth twenty times as many calls."""
    assert len(list(families(runs_of(np.tile(np.arange(2, 22), 5)), 1 << 14))) <= 4


def test_fillers_do_not_show():
    """Parents of three children are the same in a group with places for five."""
    positions, normals = sheet(count=12)
    colors = np.column_stack([RANDOM.uniform(size=(len(positions), 3)), RANDOM.uniform(size=len(positions))])
    leaves = Leaves(make_surfels(positions, normals, colors=colors))
    children = np.arange(len(positions)).reshape(-1, 3).T
    filled = np.vstack([children, children[:1], children[:1]])
    counted = np.repeat(np.float32([1, 1, 1, 0, 0])[:, None], children.shape[1], axis=1)
    some = [Families(np.arange(children.shape[1]), *own) for own in ((children, None), (filled, counted))]
    alone, among = (merged(leaves.take(f.children.ravel()).in_families(f), 0.1) for f in some)
    for name, values in alone.arrays.items():
        assert np.allclose(values, among[name], rtol=1e-5, atol=1e-6), name
