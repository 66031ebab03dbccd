# SPDX-License-Identifier: GPL-3.0-or-later
"""A picture larger than the largest target is made of tiles, and nothing shows it."""

from importlib import import_module

import numpy as np
import pytest

from splat_addon.reference import scenes
from splat_addon.reference.metrics import psnr


@pytest.mark.parametrize("edge", [40, 100])
def test_a_tiled_picture_equals_the_whole(edge, render_all, monkeypatch):
    scene, camera = scenes.torus(6000, (93, 61))
    (whole,) = render_all([(scene, camera, None)])
    monkeypatch.setattr(import_module("splat_addon.rendering.plan"), "MAX_TARGET_EDGE", edge)
    (tiled,) = render_all([(scene, camera, None)])
    assert len(whole.stats["plan"].tiles) == 1 < len(tiled.stats["plan"].tiles)
    assert psnr(tiled.color, whole.color) > 60
    assert np.count_nonzero(tiled.coverage != whole.coverage) <= 1
