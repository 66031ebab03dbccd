# SPDX-License-Identifier: GPL-3.0-or-later
"""Points in files of neighbours become the surfels that they become all at once."""

import numpy as np
import pytest

from splat_addon.sampling import surfels_from_points
from splat_addon.streaming.point_files import PointFiles


@pytest.fixture(scope="module")
def terrain():
    """(9000, 3) points of a hill, denser on one side, with a stray far away."""
    random = np.random.default_rng(4)
    x, y = random.beta(1, 2.5, 9000) * 60, random.uniform(0, 40, 9000)
    points = np.stack([x, y, 3 * np.sin(x / 9) * np.cos(y / 7)], axis=1)
    points[7] = 1e7, -3e6, 50
    return points


@pytest.fixture(scope="module")
def files(terrain, tmp_path_factory):
    told = []
    parts = [
        {"positions": part, "number": np.arange(9000)[k::4]} for k, part in enumerate(terrain[k::4] for k in range(4))
    ]
    parts[0]["positions"] = parts[0]["positions"].copy()
    made = PointFiles(parts, terrain[::5], len(terrain), 1500, tmp_path_factory.mktemp("points"), told.append)
    assert told == [2250, 4500, 6750, 9000]
    return made


def test_every_point_is_in_one_file_and_files_are_alike(files, terrain):
    found = [files.with_surroundings(number, 0) for number in range(len(files))]
    counts = [own for _, own in found]
    assert sum(counts) == len(terrain) and len(counts) == 6 and max(counts) < 2000
    numbers = np.concatenate([arrays["number"][:own] for arrays, own in found])
    assert np.array_equal(np.sort(numbers), np.arange(9000))


def test_surfels_at_seams_are_those_of_the_whole(files, terrain):
    whole, report = surfels_from_points(terrain, neighbours=12, viewpoint=(30, 20, 1e4))
    scales = np.full((len(terrain), 2), np.nan)
    scales[report.kept] = whole.scales
    normals = np.full((len(terrain), 3), np.nan)
    normals[report.kept] = whole.normals
    worst = 0
    for number in range(len(files)):
        arrays, own = files.with_surroundings(number, 12)
        made, report = surfels_from_points(arrays["positions"], neighbours=12, viewpoint=(30, 20, 1e4))
        mine = report.kept < own
        rows = arrays["number"][report.kept[mine]]
        assert (rows != 7).all() and np.isfinite(scales[rows]).mean() > 0.999
        is_same = np.isclose(made.scales[mine], scales[rows], rtol=1e-3).all(axis=1)
        is_same &= np.isclose(made.normals[mine], normals[rows], atol=1e-3).all(axis=1)
        worst = max(worst, 1 - is_same.mean())
        assert len(arrays["positions"]) < 2.5 * own
    assert worst < 0.01


def test_points_without_a_place_are_counted(tmp_path):
    positions = np.random.default_rng(0).normal(size=(50, 3))
    positions[3] = np.nan
    files = PointFiles([{"positions": positions}], positions, 50, 10, tmp_path, lambda done: None)
    assert files.skipped == 1
    assert sum(files.with_surroundings(number, 4)[1] for number in range(len(files))) == 49
