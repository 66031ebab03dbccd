# SPDX-License-Identifier: GPL-3.0-or-later
"""In a real Blender window the operator, the sidebar's tab and the rendered view work."""

import numpy as np
import pytest
from PIL import Image

#: test_a_day.py looks at a view with both drivers.
pytestmark = pytest.mark.parametrize("in_a_window", ["opengl"], indirect=True)


@pytest.fixture(scope="module")
def session(in_a_window):
    """(report, screenshot as (h, w, 3) array) of one run of convert_and_view.py."""
    report, picture = in_a_window("convert_and_view.py", "--window-geometry", "0", "0", "1000", "700")
    return report, np.asarray(Image.open(picture("view")).convert("RGB"), np.float32) / 255


def test_the_operator_runs_from_the_interface(session):
    report, _ = session
    assert report.get("operator") == ["RUNNING_MODAL"], report
    assert 5_000 < report["first"] < 15_000
    assert report["source_hidden"]


def test_the_last_operation_can_be_adjusted(session):
    report, _ = session
    assert len(report["surfels"]) == 1
    assert 3.5 * report["first"] < report["surfels"][0] < 4.5 * report["first"]


def test_the_rendered_view_shows_the_surfels_without_holes(session):
    _, shot = session
    view = shot[490:970, 60:480]  # beside the sidebar, in a window at the foot of the screen
    red = (view[..., 0] > 0.25) & (view[..., 0] > 1.4 * view[..., 1])
    assert red.mean() > 0.1
    rows, columns = np.nonzero(red)
    row, column = int(np.median(rows)), int(np.median(columns))
    assert red[row - 40 : row + 40, column - 40 : column + 40].mean() > 0.99
