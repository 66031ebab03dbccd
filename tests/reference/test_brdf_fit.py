# SPDX-License-Identifier: GPL-3.0-or-later
"""The shipped table has the values that its fit gives: the lobe's albedo and mean direction for some entries."""

import numpy as np
import pytest

from splat_addon.rendering.shading_models.brdf_table import brdf_table, edge_table


@pytest.mark.parametrize(("row", "column"), [(47, 0), (30, 10), (16, 20)])
def test_albedo_and_mean_direction_are_those_of_the_lobe(row, column):
    pytest.importorskip("scipy")
    from splat_addon.reference.brdf_fit import Lobe, albedo_and_mean, cosine_of, edge_term, roughness_of

    lobe = Lobe(roughness_of(row), cosine_of(column))
    scale, bias, mean = albedo_and_mean(lobe)
    np.testing.assert_allclose(brdf_table()[row, column, 4:], (scale, bias, mean[0], mean[2]), atol=1e-6)
    assert edge_table()[row, column] == pytest.approx(edge_term(lobe), rel=1e-5)
