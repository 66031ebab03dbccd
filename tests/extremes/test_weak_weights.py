# SPDX-License-Identifier: GPL-3.0-or-later
"""A sample that only rims or backs of splats reach still has their colour, although its weights are near zero."""

import numpy as np
import pytest

from splat_addon.reference.extremes import discs
from splat_addon.rendering import Scene, Settings

COLOR = np.array((0.3, 0.6, 0.9), np.float32)


@pytest.mark.parametrize(("sum_format", "tolerance"), [("float32", 1e-5), ("float16", 4e-3)])
@pytest.mark.parametrize("side", [1, -1])
@pytest.mark.parametrize("radius", [0.02, 0.2, 1.0])
def test_one_splat_has_its_own_colour_up_to_its_rim(side, radius, sum_format, tolerance, render_all, camera):
    splat = discs((0.01, 0.02, -3), (radius, 0, 0), (0, side * radius, 0), COLOR)
    settings = Settings(supersampling=2, shading="flat", transparent_film=True, sum_format=sum_format)
    (frame,) = render_all([(Scene((splat,)), camera(size=(64, 64)), settings)])
    covered = frame.coverage > 0
    assert covered.any()
    colors = frame.color[covered][:, :3] / frame.color[covered][:, 3:]
    np.testing.assert_allclose(colors, np.broadcast_to(COLOR, colors.shape), rtol=tolerance)
