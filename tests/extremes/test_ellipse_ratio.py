# SPDX-License-Identifier: GPL-3.0-or-later
"""Ellipses may be round or up to a million times longer than wide."""

import pytest

from splat_addon.reference.extremes import stripes

RATIOS = [1, 10, 1e2, 1e3, 1e4, 1e5, 1e6]
TURN = 1.0
LEAST_PSNR = 50


@pytest.mark.parametrize("ratio", RATIOS)
@pytest.mark.parametrize("turn", [0, TURN])
def test_ellipses_that_get_thinner_are_the_true_ones(turn, ratio, hold, lit, camera):
    hold({"stripes": (lit(stripes(1, 1 / ratio, turn)), camera())})


@pytest.mark.parametrize("ratio", RATIOS)
def test_ellipses_that_get_longer_are_the_true_ones(ratio, hold, lit, camera):
    hold({"stripes": (lit(stripes(0.08 * ratio, 0.08, 0)), camera())})


@pytest.mark.parametrize("ratio", RATIOS)
def test_long_ellipses_at_an_angle_are_the_true_ones(ratio, hold, lit, camera):
    """Their corners are far outside the picture, where float32 leaves few digits for the short axis."""
    hold(
        {"stripes": (lit(stripes(0.08 * ratio, 0.08, TURN)), camera(size=(64, 64)))},
        least=35 if ratio > 1e5 else LEAST_PSNR,
    )
