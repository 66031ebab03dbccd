# SPDX-License-Identifier: GPL-3.0-or-later
"""A scene is measured alike at any scale and any distance from the origin, so that an error or a time chooses alike."""

from itertools import accumulate, cycle

import numpy as np
import pytest

from splat_addon.reference import scenes
from splat_addon.reference.extremes import transformed
from splat_addon.rendering import Renderer, Settings
from splat_addon.trade import Survey, Target

SETTINGS = Settings(shading="flat", outputs=("color",))
PLACES = (1.0, 0.0), (1e-18, 0.0), (1e18, 0.0), (1.0, 1e8)


def measured(device, scale, offset):
    """(FLIP of what was drawn, what the targets choose). Frames take the same times in each place."""
    matrix = np.diag([scale, scale, scale, 1.0])
    matrix[:3, 3] = offset * np.array((1.0, -1.0, 0.5))
    scene, camera = transformed(*scenes.torus(800, (16, 16)), matrix)
    ticks = accumulate(cycle((1.0, 3.0, 2.0, 7.0, 5.0)))
    survey = Survey(Renderer(device), scene, camera, SETTINGS, clock=lambda: next(ticks))
    targets = Target(seconds=4.0), Target(seconds=40.0), Target(flip=1.5 * min(row.flip for row in survey.rows))
    return [row.flip for row in survey.rows], [survey.promise(target).choice for target in targets]


def test_an_error_and_a_time_choose_alike_at_any_scale_and_any_distance(on_device):
    (flips, chosen), *others = on_device(lambda device: [measured(device, *place) for place in PLACES])
    assert len(set(chosen)) > 1 and min(flips) > 0
    for other_flips, other_chosen in others:
        assert other_flips == pytest.approx(flips, rel=0.01)
        assert other_chosen == chosen
