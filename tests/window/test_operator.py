# SPDX-License-Identifier: GPL-3.0-or-later
"""In a real Blender window the converting operator runs, and its settings can be changed afterwards."""

import pytest

#: test_a_day.py looks at the surfels with both drivers.
pytestmark = pytest.mark.parametrize("in_a_window", ["opengl"], indirect=True)


@pytest.fixture(scope="module")
def report(in_a_window):
    """The report of one run of convert_and_adjust.py."""
    return in_a_window("convert_and_adjust.py", "--window-geometry", "0", "0", "1000", "700")[0]


def test_the_operator_runs_from_the_interface(report):
    assert report.get("operator") == ["RUNNING_MODAL"], report
    assert 5_000 < report["first"] < 15_000
    assert report["source_hidden"]


def test_the_last_operation_can_be_adjusted(report):
    assert len(report["surfels"]) == 1
    assert 3.5 * report["first"] < report["surfels"][0] < 4.5 * report["first"]
