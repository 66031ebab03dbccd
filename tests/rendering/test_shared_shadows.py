# SPDX-License-Identifier: GPL-3.0-or-later
"""All samples of a picture share their shadow maps, unless a lens changes the region that a sun's map must cover."""

from dataclasses import replace

import numpy as np
import pytest

from splat_addon.reference import scenes
from splat_addon.rendering import Lens, Light, Settings, renderer
from splat_addon.rendering.plan import executor

SETTINGS = Settings(method="quad", samples=4, shadow_resolution=128)
SUN = Light("sun", energy=2.0, direction=(1, -0.5, -1), casts_shadow=True)
LAMP = Light("point", energy=60, position=(-2, 1, 2), casts_shadow=True)


@pytest.fixture
def drawn(monkeypatch):
    """The plans of the frames for which shadow maps were drawn."""
    plans, run = [], executor.run_pass

    def counting(tile, p):
        if p.name == "shadow_maps":
            plans.append(tile.plan)
        return run(tile, p)

    monkeypatch.setattr(executor, "run_pass", counting)
    return plans


def under(*lights):
    scene, camera = scenes.torus(count=4000, size=(48, 48))
    return replace(scene, lights=lights), camera


def test_maps_are_drawn_once_and_the_picture_is_as_with_each_its_own(drawn, render, monkeypatch):
    shared = render(*under(SUN, LAMP), SETTINGS)
    assert len(drawn) == 1
    monkeypatch.setattr(renderer, "same_maps", lambda *_: False)
    own = render(*under(SUN, LAMP), SETTINGS)
    assert len(drawn) == 5
    np.testing.assert_array_equal(shared.color, own.color)
    assert np.abs(shared.color - render(*under(), SETTINGS).color).max() > 0.1


@pytest.mark.parametrize(("lights", "times"), [((LAMP,), 1), ((SUN, LAMP), 4)])
def test_through_a_lens_maps_of_lamps_are_shared(lights, times, drawn, render):
    scene, camera = under(*lights)
    render(scene, replace(camera.cropped(20, 20, 8, 8), lens=Lens(0.1, 4.0)), SETTINGS)
    assert len(drawn) == times
