# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfels of extreme sizes, places and colours never merge, and the others merge as if these were not there."""

import warnings
from dataclasses import replace

import numpy as np
import pytest

from splat_addon.hierarchy import build_hierarchy

from .conftest import ball, make_surfels


@pytest.fixture(scope="module")
def plain():
    return make_surfels(*ball(400))


def changed(surfels, rows, **values):
    fields = {name: getattr(surfels, name).copy() for name in values}
    for name, value in values.items():
        fields[name][rows] = value
    return replace(surfels, **fields)


SOME, ALL = slice(0, 400, 50), slice(None)


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize(
    ("rows", "values"),
    [
        (SOME, {"positions": 3e38, "scales": 1e-30}),
        (SOME, {"positions": -3e38, "scales": 3e38}),
        (SOME, {"scales": 1e-45}),
        (SOME, {"scales": 3e38}),
        (SOME, {"scales": (1e-45, 3e38)}),
        (SOME, {"colors": 3e38}),
        (SOME, {"materials": 2**31 - 1}),
        (ALL, {"scales": 3e38}),
        (ALL, {"positions": 3e38}),
        (ALL, {"colors": (3e38, -3e38, 1e-45, 1)}),
    ],
)
def test_they_are_there_and_never_merge(plain, rows, values):
    surfels = changed(plain, rows, **values)
    made = build_hierarchy(surfels)
    blocks, merged = made.blocks, made.entries[400 : 400 + len(made.counts)]
    leaves = blocks.first_child == blocks.last_child
    spans = [made.entries[a:b] for a, b in zip(blocks.first[leaves], blocks.last[leaves], strict=True)]
    assert np.array_equal(np.sort(np.concatenate(spans)), np.arange(400))
    assert all(np.isfinite(a).all() for a in (blocks.low, blocks.high, blocks.axes, blocks.angles, made.errors))
    ends = np.cumsum(made.counts)
    alone = np.zeros(400, bool)
    children = np.split(made.entries[: ends[-1]], ends[:-1]) if len(ends) else []
    alone[:] = True
    for parent, family in zip(merged, children, strict=True):
        if parent >= 400:
            alone[family[family < 400]] = False
    assert alone[rows].all()
    if rows is SOME:
        others = np.flatnonzero(~np.isin(np.arange(400), np.arange(400)[SOME]))
        expected = build_hierarchy(plain.take(others)).nodes
        assert np.array_equal(made.nodes.positions, expected.positions) and len(expected) > 50


def test_those_at_the_limits_merge(plain):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        for size in (1e-16, 1e14):
            grown = replace(plain, positions=plain.positions * np.float32(size), scales=plain.scales * np.float32(size))
            assert len(build_hierarchy(grown)) > 50
