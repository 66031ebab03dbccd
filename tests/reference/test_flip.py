# SPDX-License-Identifier: GPL-3.0-or-later
"""FLIP gives the values that its authors define."""

import numpy as np
import pytest

from splat_addon.reference.metrics import mean_flip


@pytest.mark.parametrize(
    ("a", "b"), [((0, 0, 0), (1, 1, 1)), ((0.2, 0.5, 0.1), (0.2, 0.4, 0.3)), ((0.5,) * 3, (0.5,) * 3)]
)
def test_flip_of_two_plain_colours_is_the_papers(a, b):
    """Without detail only the colour part of the metric is left (Andersson et al. 2020)."""
    pictures = (np.broadcast_to(np.float64(color), (32, 32, 3)) for color in (a, b))
    assert mean_flip(*pictures) == pytest.approx(flip_of_colours(a, b), abs=2e-4)


def flip_of_colours(a, b):
    """The FLIP of two linear colours by sections 4.1 and 4.3 of the paper.

    It is the HyAB distance in Hunt-adjusted CIELAB to the power 0.7; values beyond 0.4 of the distance between green
    and blue are compressed to 0.95 to 1.
    """
    to_xyz = np.array([(0.4123908, 0.3575843, 0.1804808), (0.2126390, 0.7151687, 0.0721923),
                       (0.0193308, 0.1191948, 0.9505322)])  # fmt: skip

    def hunt_lab(color):
        ratio = to_xyz @ np.float64(color) / to_xyz.sum(axis=1)
        f = np.where(ratio > (6 / 29) ** 3, np.cbrt(ratio), ratio / (3 * (6 / 29) ** 2) + 4 / 29)
        lightness = 116 * f[1] - 16
        return np.array([lightness, 0.01 * lightness * 500 * (f[0] - f[1]), 0.01 * lightness * 200 * (f[1] - f[2])])

    def distance(a, b):
        difference = hunt_lab(a) - hunt_lab(b)
        return (abs(difference[0]) + np.hypot(*difference[1:])) ** 0.7

    most = distance((0, 1, 0), (0, 0, 1))
    least, knee, height = distance(a, b), 0.4 * most, 0.95
    return height * least / knee if least < knee else height + (least - knee) / (most - knee) * (1 - height)
