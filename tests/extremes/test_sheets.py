# SPDX-License-Identifier: GPL-3.0-or-later
"""Of two sheets in line, those closer than epsilon blend evenly; otherwise the front one hides the back one."""

import numpy as np
import pytest

from splat_addon.reference.extremes import sheet
from splat_addon.rendering import Scene, Settings

FLAT = Settings(supersampling=2, shading="flat")
DEPTH = 3.0
RED, GREEN = (1, 0, 0), (0, 1, 0)


def sheets(gap):
    """A red sheet in front of a green one, with a gap given in radii; also returns the radius."""
    front = sheet(20, 1.0, 0, DEPTH, RED)
    radius = float(front.radius[0])
    return Scene((front, sheet(20, 1.0, 0, DEPTH + gap * radius, GREEN)))


@pytest.mark.parametrize("gap", [0, 1e-6, 1e-3, 0.1, 0.25, 0.45, 0.55, 0.75, 1, 2])
def test_sheets_at_any_distance_are_the_true_ones(gap, hold, camera):
    hold({f"{gap} radii": (sheets(gap), camera(), FLAT)})


def test_coincident_sheets_mix_evenly(render_all, camera):
    (frame,) = render_all([(sheets(0), camera(), FLAT)])
    inner = frame.color[12:20, 12:20, :3]
    np.testing.assert_allclose(inner, np.broadcast_to((0.5, 0.5, 0), inner.shape), atol=1e-5)


@pytest.mark.parametrize("gap", [0.6, 1, 2])
def test_beyond_epsilon_nothing_bleeds_through(gap, render_all, camera):
    (frame,) = render_all([(sheets(gap), camera(), FLAT)])
    assert frame.color[12:20, 12:20, 1].max() == 0
