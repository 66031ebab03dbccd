# SPDX-License-Identifier: GPL-3.0-or-later
"""Numbers that scanners measure become colours of a ramp, and classes those of their kind."""

import numpy as np
import pytest

from splat_addon.interchange.scan_colors import CLASSES, GREYS, RAMP, UNKNOWN, of_classes, on_ramp

BLACK_TO_WHITE = np.array([(0, 0, 0), (1, 1, 1)])


def test_values_lie_on_the_ramp_between_two_ends_and_stay_beyond_them():
    seen = on_ramp(np.array([-5, 0, 2.5, 10, 99, np.nan]), BLACK_TO_WHITE, 0, 10)
    np.testing.assert_allclose(seen[:, 0], [0, 0, 0.25, 1, 1, UNKNOWN[0]], rtol=1e-6)


def test_without_ends_a_few_extreme_values_do_not_flatten_the_rest():
    values = np.concatenate([np.linspace(0, 1, 1000), [1e9, -1e9]])
    seen = on_ramp(values, BLACK_TO_WHITE)[:1000, 0]
    assert seen[500] == pytest.approx(0.5, abs=0.01) and seen[0] == 0 and seen[-1] == 1


@pytest.mark.parametrize("values", [[], [3, 3, 3], [np.nan, np.inf]])
def test_values_without_a_range_have_a_color(values):
    seen = on_ramp(np.array(values, np.float32), BLACK_TO_WHITE)
    assert seen.shape == (len(values), 3) and np.isfinite(seen).all()


def test_classes_have_the_colors_of_what_they_are():
    ground, tree, water, own = of_classes(np.array([2, 5, 9, 64]))
    assert ground.argmax() == 0 and tree.argmax() == 1 and water.argmax() == 2
    assert own == pytest.approx(UNKNOWN) and len(CLASSES) == 19
    assert of_classes(np.array([-1.0, np.nan])) == pytest.approx(np.array([UNKNOWN, UNKNOWN]))


@pytest.mark.parametrize("ramp", [RAMP, GREYS])
def test_the_own_ramps_rise_in_lightness_by_even_steps(ramp):
    lightness = np.cbrt(ramp @ np.array([0.2126, 0.7152, 0.0722]))
    assert (np.diff(lightness) > 0.08).all() and np.diff(lightness).max() < 2 * np.diff(lightness).min()
