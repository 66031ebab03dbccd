# SPDX-License-Identifier: GPL-3.0-or-later
"""With 1 to 5000 splats over every sample the sums stay precise."""

import numpy as np
import pytest

from splat_addon.reference.extremes import pile
from splat_addon.rendering import Scene, Settings

LAYERS = [
    *(("float32", *row) for row in ((1, 100), (10, 100), (100, 100), (1000, 90), (5000, 80))),
    # float16 sums lose splats below 1/2048 of what is there: beyond 1000 layers they are no longer the mean
    *(("float16", *row) for row in ((1, 80), (10, 75), (100, 65), (300, 50), (1000, 30), (5000, 0))),
]


@pytest.mark.parametrize(("sum_format", "layers", "least"), LAYERS)
def test_many_layers_give_their_mean(sum_format, layers, least, hold, lit, camera):
    settings = Settings(supersampling=2, sum_format=sum_format)
    hold({f"{layers} layers": (lit(pile(layers)), camera(size=(12, 12)), settings)}, least)


@pytest.mark.parametrize("brightness", [1e-6, 1e6, 1e20])
def test_float16_sums_hold_any_brightness(brightness, render_all, camera):
    colors = np.random.default_rng(2).random((100, 3))
    settings = Settings(supersampling=2, sum_format="float16", shading="flat")
    dim, bright = render_all(
        [(Scene((pile(100, colors * factor),)), camera(size=(12, 12)), settings) for factor in (1.0, brightness)]
    )
    np.testing.assert_allclose(bright.color[..., :3] / brightness, dim.color[..., :3], rtol=0, atol=4e-3)
