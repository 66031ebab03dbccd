# SPDX-License-Identifier: GPL-3.0-or-later
"""1 to 5000 splats over every sample: the sums keep their digits."""

import numpy as np
import pytest

from splat_addon.reference.extremes import discs


@pytest.mark.parametrize(("layers", "least"), [(1, 100), (10, 100), (100, 100), (1000, 90), (5000, 80)])
def test_many_layers_give_their_mean(layers, least, hold, lit, camera):
    random = np.random.default_rng(1)
    centers = np.concatenate([random.normal(0, 0.02, (layers, 2)), -3 - 1e-3 * random.random((layers, 1))], axis=1)
    hold({f"{layers} layers": (lit(discs(centers, (1.5, 0, 0), (0, 1.5, 0))), camera(size=(12, 12)))}, least)
