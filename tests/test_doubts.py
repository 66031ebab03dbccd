# SPDX-License-Identifier: GPL-3.0-or-later
"""Sets of surfels that nobody would see, or that would hide everything, are told."""

import re

import numpy as np
import pytest

from splat_addon.doubts import doubts
from splat_addon.surfels import Surfels, empty_surfels


def surfels(count=20, alpha=1.0, size=0.1, extent=1.0, place=0.0):
    positions = np.linspace(0, extent, count)[:, None] * (1, 0, 0) + (place, 0, 0)
    colors = np.ones((count, 4))
    colors[:, 3] = alpha
    frames = {"rotations": [[1, 0, 0, 0]] * count, "normals": [[0, 0, 1]] * count, "materials": np.zeros(count)}
    return Surfels(positions=positions, scales=np.full((count, 2), size), colors=colors, **frames)


MANY, FEW = np.arange(20) >= 16, np.arange(20) >= 4


@pytest.mark.parametrize(
    ("made", "sentence"),
    [
        (surfels(alpha=0), "20 of 20 surfels are fully transparent"),
        (surfels(alpha=1e-3), "20 of 20 surfels are fully transparent"),
        (surfels(alpha=MANY), "16 of 20 surfels are fully transparent"),
        (surfels(size=1e-9), "half-axis of 1e-09, which is too small to be seen beside their extent of 1$"),
        (surfels(size=1.02, extent=0.5), "half-axes above 1.02, more than the extent of all, 0.5"),
        (surfels(place=1e20, extent=1e19, size=1e18), "20 of 20 surfels lie beyond 1e\\+18"),
    ],
)
def test_what_looks_like_a_mistake_is_one_sentence(made, sentence):
    [said] = doubts(made)
    assert re.search(sentence, said)


@pytest.mark.parametrize("made", [surfels(), surfels(alpha=FEW), surfels(count=1, size=9), empty_surfels()])
def test_what_may_be_meant_is_not_doubted(made):
    assert doubts(made) == []
