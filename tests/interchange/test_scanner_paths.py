# SPDX-License-Identifier: GPL-3.0-or-later
"""The scanner's path is where the file says, or where the rays of pulses with several returns come from."""

import numpy as np
import pytest

from splat_addon.interchange.points import Points
from splat_addon.interchange.scanner_paths import scanner_path

START, SPEED = np.array([481000.0, 3620000.0, 900.0]), np.array([55.0, 20.0, -1.0])


def flight(seconds: float, rounding: float = 0.001, wrong: float = 0.02) -> Points:
    """Pulses from a scanner that flies in a straight line and sweeps 20 degrees to both sides, over ground near z = 0
    with canopies up to 25 above. wrong: share of pulses whose first return is elsewhere."""
    random = np.random.default_rng(3)
    times = np.sort(random.uniform(0, seconds, int(4000 * seconds)))
    place = START + times[:, None] * SPEED
    angle = np.radians(20) * np.sin(2 * np.pi * 40 * times)
    side = np.cross(SPEED / np.linalg.norm(SPEED), (0, 0, 1))
    along = np.sin(angle)[:, None] * side - np.cos(angle)[:, None] * np.array([0, 0, 1.0])
    heights = random.uniform(0, 25, (len(times), 2))
    heights.sort(axis=1)
    both = [
        place + along * ((height - place[:, 2]) / along[:, 2])[:, None] for height in (heights[:, 1], heights[:, 0])
    ]
    both[0][random.random(len(times)) < wrong] += (3, 1, 0)
    positions = np.round(np.concatenate(both) / rounding) * rounding
    order = random.permutation(2 * len(times))
    columns = {
        "gps_time": 3e8 + np.tile(times, 2),
        "return_number": np.repeat([1, 2], len(times)).astype(np.uint8),
        "number_of_returns": np.full(2 * len(times), 2, np.uint8),
    }
    return Points(positions[order], None, None, None, {name: column[order] for name, column in columns.items()})


@pytest.mark.parametrize("rounding", [0.001, 0.01])
def test_a_flight_is_found_from_its_rays(rounding):
    path, is_estimated = scanner_path(flight(12.0, rounding))
    assert is_estimated and len(path) > 10
    truth = START + (path[:, 3:] - 3e8) * SPEED
    # of 900 m
    assert np.linalg.norm(path[:, :3] - truth, axis=1).max() < 10
    assert np.abs(np.diff(path[:, 3])).max() < 2


def test_pulses_that_do_not_meet_give_no_flight():
    points = flight(4.0)
    shuffled = points.attributes | {"gps_time": np.random.default_rng(1).permutation(points.attributes["gps_time"])}
    assert scanner_path(Points(points.positions, None, None, None, shuffled)) is None
    assert scanner_path(Points(points.positions, None, None, None, {})) is None


def test_places_that_a_file_names_come_first():
    positions = np.random.default_rng(2).normal(size=(90, 3))
    scan, places = np.repeat([0, 1, 2], 30), {0: np.zeros(3), 1: np.array([1.0, 2, 0]), 2: np.array([1e6, 0, 0])}
    path, is_estimated = scanner_path(Points(positions, None, None, None, {"scan": scan}, places))
    assert not is_estimated and path.tolist() == [[0, 0, 0, 0], [1, 2, 0, 1]]  # the third is no place of a scanner
