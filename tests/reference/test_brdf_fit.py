# SPDX-License-Identifier: GPL-3.0-or-later
"""The shipped table has the values that its fit gives: the lobe's albedo and mean direction for some entries."""

import numpy as np
import pytest

from splat_addon.rendering.upload.brdf_table import brdf_table


@pytest.mark.parametrize(("row", "column"), [(47, 0), (30, 10), (16, 20)])
def test_albedo_and_mean_direction_are_those_of_the_lobe(row, column):
    pytest.importorskip("scipy")
    from splat_addon.reference.brdf_fit import ANGLES, LEAST_ROUGHNESS, ROUGHNESS, Lobe, albedo_and_mean

    roughness = LEAST_ROUGHNESS + (1 - LEAST_ROUGHNESS) * row / (ROUGHNESS - 1)
    scale, bias, mean = albedo_and_mean(Lobe(roughness, 1 - (column / (ANGLES - 1)) ** 2))
    np.testing.assert_allclose(brdf_table()[row, column, 4:], (scale, bias, mean[0], mean[2]), atol=1e-6)
