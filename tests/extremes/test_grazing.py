# SPDX-License-Identifier: GPL-3.0-or-later
"""A surface seen from 60 degrees to edge-on has no holes, spill or NaN; exactly edge-on it is invisible."""

import numpy as np
import pytest

from splat_addon.reference.extremes import floor_below, sheet

#: Gaps of sprites are narrow.
SIZE = (64, 64)
ANGLES = [*range(60, 86), 86, 86.5, 87, 87.5, 88, 88.5, 89, 89.2, 89.4, 89.6, 89.8, 89.9, 89.99, 89.999]


@pytest.mark.parametrize("angle", ANGLES)
def test_a_grazing_sheet_is_the_true_one(angle, hold, lit, camera):
    hold({f"{angle} degrees": (lit(sheet(30, 1.0, angle, 2.0)), camera(size=SIZE))})


@pytest.mark.parametrize("height", [0.3, 0.1, 0.03, 0.01])
def test_a_sheet_that_reaches_past_the_viewer_has_no_holes(height, hold, lit, camera):
    """The sheet is a floor that begins under the eye; the eye gets lower and lower."""
    hold({f"height {height}": (lit(floor_below(height)), camera(near=1e-4))})


def test_edge_on_nothing_is_drawn(render_all, lit, camera):
    (frame,) = render_all([(lit(sheet(30, 1.0, 90.0, 2.0)), camera(size=SIZE), None)])
    assert not np.any(frame.coverage)
