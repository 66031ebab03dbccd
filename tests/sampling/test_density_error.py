# SPDX-License-Identifier: GPL-3.0-or-later
"""A density and its error belong together, both ways, within what was measured."""

from itertools import pairwise

import pytest

from splat_addon.sampling import LARGEST_ERROR, LEAST_ERROR, error_at, pixels_for
from splat_addon.sampling.density_error import MEASURED


@pytest.mark.parametrize("error", [LEAST_ERROR, 1.5 * LEAST_ERROR, LARGEST_ERROR / 2, LARGEST_ERROR])
def test_the_density_for_an_error_has_that_error(error):
    typical, worst = error_at(pixels_for(error))
    assert typical == pytest.approx(error) and worst > typical


def test_coarser_surfels_are_farther_off():
    assert all(a < b for first, second in pairwise(MEASURED.values()) for a, b in zip(first, second, strict=True))


def test_what_was_never_measured_is_not_made_up():
    assert error_at(0.3) is None and error_at(4.0) is None
    with pytest.raises(ValueError, match="must be"):
        pixels_for(2 * LARGEST_ERROR)
