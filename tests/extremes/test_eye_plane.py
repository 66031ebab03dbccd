# SPDX-License-Identifier: GPL-3.0-or-later
"""Splats that cross the near plane or the eye's plane show their part in front of it, even if their centre is
behind.
"""

import numpy as np
import pytest

from splat_addon.reference.extremes import discs, sheet
from splat_addon.reference.metrics import psnr

SPLATS = {
    "cut by the near plane": discs((0.1, -0.05, -0.011), (1, 0, 0), (0, 0.3, -1)),
    "through the eye's plane": discs((0.1, -0.2, 0), (2, 0, 0), (0, 0.3, -2)),
    "centre behind the camera": discs((0.1, -0.2, 0.5), (2, 0, 0), (0, 0.2, -2)),
    "centre far behind": discs((0.1, -0.2, 90), (50, 0, 0), (0, 1, -100)),
    "through the eye": discs((0, 0, 0), (2, 0, 0), (0, 0.3, -2)),
    "wholly behind": discs((0, 0, 3), (1, 0, 0), (0, 1, 0)),
}


UNSEEN = ("through the eye", "wholly behind")


@pytest.mark.parametrize("name", SPLATS)
def test_what_lies_before_the_near_plane_alone_is_cut(name, hold, lit, camera):
    ((frame, _),) = hold({name: (lit(SPLATS[name]), camera(near=1e-2))}).values()
    assert frame.coverage.any() == (name not in UNSEEN)


@pytest.mark.parametrize("name", SPLATS)
def test_a_splat_across_the_eye_hides_nothing_beyond_its_rim(name, hold, lit, camera):
    beyond = discs((0, 0, -30), (40, 0, 0), (0, 40, 0), (0, 1, 0))
    hold({name: (lit(SPLATS[name], beyond), camera(near=1e-2))})


@pytest.mark.parametrize("depth", [0.9, 0.95, 0.99])
def test_a_splat_before_the_near_plane_hides_nothing_when_moved_back(depth, hold, lit, camera):
    """Epsilon moves it behind the near plane, where the visibility pass must ignore it."""
    before = discs((0, 0, -depth), (0.15, 0, 0), (0, 0.15, 0), (1, 0, 0))
    ((frame, truth),) = hold({"before": (lit(before, sheet(20, 2.0, 0, 3.0)), camera(near=1.0))}).values()
    assert np.abs(frame.depth[truth.coverage == 1] - 3).max() < 1e-3


@pytest.mark.parametrize("spin", [0, 20, 40, 60, 80, 100])
def test_a_splat_across_the_near_plane_keeps_its_rim(spin, hold, lit, camera):
    """The near plane cuts a disc. The rest of its rim is right, however its half-axes are turned in its own plane."""
    angle, tilt = np.radians(spin), np.radians(60)
    across, along = np.array((1, 0, 0)), np.array((0, np.cos(tilt), np.sin(tilt)))
    u, v = (
        0.5 * (np.cos(angle) * across + np.sin(angle) * along),
        0.5 * (np.cos(angle) * along - np.sin(angle) * across),
    )
    disc = lit(discs((0, 0, -1), u, v, (0.9, 0.9, 0.9)))
    ((frame, truth),) = hold({"disc": (disc, camera(90, near=0.6))}).values()
    assert psnr(frame.color, truth.color) > 30
