# SPDX-License-Identifier: GPL-3.0-or-later
"""Merged surfels have the mean of numbers that lie beside surfels, and the class that most of their area has."""

from itertools import chain

import numpy as np

from splat_addon.hierarchy import build_hierarchy, most_common, rounded_means
from splat_addon.hierarchy.refitting import by_level

from .conftest import make_surfels, sheet


def stood_for(hierarchy):
    """node -> the surfels that it stands for, listed one by one."""
    entries, counts = by_level(hierarchy)
    level, found = [[row] for row in entries[0].tolist()], {}
    for numbers, own in zip(entries[1:], counts, strict=True):
        ends = np.cumsum(own).tolist()
        level = [list(chain.from_iterable(level[end - n : end])) for end, n in zip(ends, own.tolist(), strict=True)]
        found.update(zip(numbers.tolist(), level, strict=True))
    return found


def test_means_and_classes_are_those_of_the_surfels_by_area():
    random = np.random.default_rng(3)
    positions, normals = sheet(30)
    surfels = make_surfels(positions, normals, random.uniform(0.03, 0.06, (len(positions), 2)))
    areas = surfels.scales.astype(np.float64).prod(axis=1)
    hierarchy = build_hierarchy(surfels)
    values = random.integers(0, 256, len(surfels)).astype(np.uint8)
    classes = random.choice(np.uint8([2, 5, 255]), len(surfels))
    means, most = rounded_means(hierarchy, areas, values), most_common(hierarchy, areas, classes)
    assert means.dtype == most.dtype == np.uint8 and len(means) == len(most) == len(surfels) + len(hierarchy)
    assert np.array_equal(means[: len(surfels)], values) and np.array_equal(most[: len(surfels)], classes)
    found, by_number = stood_for(hierarchy), 0
    assert set(range(len(surfels), len(means))) <= found.keys()
    for node in range(len(surfels), len(means)):
        own = found[node]
        assert abs(means[node] - np.average(values[own], weights=areas[own])) < 0.5001
        assert most[node] == np.bincount(classes[own], areas[own]).argmax()
        by_number += most[node] != np.bincount(classes[own]).argmax()
    assert by_number  # the area decides, not the number


def test_without_surfels_or_merged_ones_nothing_is_added():
    positions, normals = sheet(1)
    for count in (0, 1):
        hierarchy = build_hierarchy(make_surfels(positions[:count], normals[:count]))
        for made in (rounded_means, most_common):
            assert made(hierarchy, np.ones(count), np.full(count, 7, np.uint8)).tolist() == [7] * count
