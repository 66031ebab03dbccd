# SPDX-License-Identifier: GPL-3.0-or-later
"""A picture larger than the largest target is drawn in tiles without seams, also if only a part of it is drawn."""

from importlib import import_module

import numpy as np
import pytest

from splat_addon.reference import scenes
from splat_addon.reference.metrics import psnr
from splat_addon.rendering import Settings, plan


@pytest.mark.parametrize("edge", [40, 100])
def test_a_tiled_picture_equals_the_whole(edge, render_all, monkeypatch):
    scene, camera = scenes.torus(6000, (93, 61))
    (whole,) = render_all([(scene, camera, None)])
    monkeypatch.setattr(import_module("splat_addon.rendering.plan.tiles"), "MAX_TARGET_EDGE", edge)
    (tiled,) = render_all([(scene, camera, None)])
    assert len(whole.stats["plan"].tiles) == 1 < len(tiled.stats["plan"].tiles)
    assert psnr(tiled.color, whole.color) > 60
    assert np.count_nonzero(tiled.coverage != whole.coverage) <= 1


def test_parts_are_the_whole_picture_bit_by_bit_where_their_tiles_are(render, monkeypatch):
    """Each part uses the shadow maps and depths of the whole picture."""
    monkeypatch.setattr(import_module("splat_addon.rendering.plan.tiles"), "MAX_TARGET_EDGE", 80)
    scene, camera = scenes.torus(3000, (93, 61))
    settings = Settings(outputs=("color", "depth", "position", "object_index", "cryptomatte"))
    whole = render(scene, camera, settings)
    for part in ((0, 0, 93, 40), (40, 0, 53, 61), (40, 40, 40, 21)):
        x, y, width, height = part
        drawn = render(scene, camera, settings, part=part)
        for name in ("color", "depth", "position", "object_index"):
            assert np.array_equal(getattr(drawn, name), getattr(whole, name)[y : y + height, x : x + width]), name
        shares = whole.cryptomatte.ranks(2)[y : y + height, x : x + width]
        assert np.array_equal(drawn.cryptomatte.ranks(2), shares) and shares.any()


def test_sixteen_parts_of_a_huge_picture_have_its_own_tiles():
    """So 16,384 x 16,384 pixels drawn by 4 x 4 machines equal, bit by bit, what one machine draws."""
    scene, camera = scenes.torus(100, (16384, 16384))
    settings, edge = Settings(), 16384 // 4
    parts = [(edge * x, edge * y, edge, edge) for x in range(4) for y in range(4)]
    tiles = [tile for part in parts for tile in plan(scene, camera, settings, part=part).tiles]
    assert sorted(tiles) == sorted(plan(scene, camera, settings).tiles) and len(tiles) == 64
