# SPDX-License-Identifier: GPL-3.0-or-later
"""With epsilon from 0 to 100 radii the picture is the true one for that epsilon, and no splat hides itself."""

from importlib import import_module

import numpy as np
import pytest

from splat_addon.reference import scenes
from splat_addon.reference.extremes import sheet
from splat_addon.rendering import Settings

#: (epsilon, dB): below 1e-5 radii neighbours that intersect are told apart by less than the depth resolves.
EPSILONS = [(0, 40), (1e-7, 40), (1e-4, 45), (1e-2, 60), (0.1, 60), (0.5, 60), (1, 60), (5, 60), (20, 60), (100, 60)]


@pytest.mark.parametrize(("epsilon", "least"), EPSILONS)
def test_any_epsilon_gives_its_true_picture(epsilon, least, hold):
    hold({f"epsilon {epsilon}": (*scenes.torus(6000, (64, 64)), Settings(supersampling=2, epsilon=epsilon))}, least)


@pytest.mark.parametrize("epsilon", [0, 1e-7, 1e-6])
@pytest.mark.parametrize("angle", [0, 60, 85])
def test_no_splat_hides_itself(angle, epsilon, hold, lit, camera, is_unfiltered):
    """With an epsilon below rounding, a splat could hide parts of itself.

    Which of several coplanar splats is seen is undefined.
    """
    settings = Settings(supersampling=2, epsilon=epsilon)
    ((frame, truth),) = hold(
        {"sheet": (lit(sheet(30, 1.0, angle, 2.0)), camera(size=(64, 64)), settings)}, least=0
    ).values()
    assert not is_unfiltered or np.count_nonzero(frame.coverage < truth.coverage) <= 2


@pytest.mark.parametrize("angle", [0, 60, 85])
def test_no_splat_hides_itself_in_linear_depth(angle, hold, lit, camera, is_unfiltered, monkeypatch):
    monkeypatch.setattr(import_module("splat_addon.rendering.passes.decisions"), "MAX_HARDWARE_DEPTH_RATIO", 0)
    settings = Settings(supersampling=2, epsilon=0)
    ((frame, truth),) = hold(
        {"sheet": (lit(sheet(30, 1.0, angle, 2.0)), camera(size=(64, 64)), settings)}, least=0
    ).values()
    assert not is_unfiltered or np.count_nonzero(frame.coverage < truth.coverage) <= 2
