# SPDX-License-Identifier: GPL-3.0-or-later
"""A view that moves too slowly is drawn coarser until it reaches its rate; at rest it is drawn as the settings say."""

from dataclasses import replace

import numpy as np
import pytest

from splat_addon.reference import scenes
from splat_addon.rendering import Pace, Refinement, Renderer, Settings
from splat_addon.rendering.pace import COARSEST

SETTINGS = Settings(outputs=("color",), detail_tolerance=1.25, shadow_resolution=0)


class Clock:
    """A clock whose seconds a test sets."""

    now = 0.0

    def __call__(self) -> float:
        return self.now


def tolerances(seconds, settings=SETTINGS, pictures=20, rate=10.0):
    """The tolerances chosen for successive pictures; `seconds` gives a picture's time for a tolerance."""
    clock, found = Clock(), []
    pace = Pace(rate, clock)
    for _ in range(pictures):
        drawn = pace.begin(settings)
        found.append(drawn.detail_tolerance)
        clock.now += seconds(drawn.detail_tolerance)
        pace.end(settings)
    return np.array(found)


def test_a_slow_view_becomes_coarser_until_it_holds_the_rate():
    found = tolerances(lambda tolerance: 0.6 * (1.25 / tolerance) ** 2)
    assert found[0] == 1.25 and (np.diff(found) >= -1e-9).all() and found[-1] == found[-2]
    assert 0.05 < 0.6 * (1.25 / found[-1]) ** 2 <= 0.1


def test_a_fast_view_stays_as_fine_as_the_settings_say():
    assert (tolerances(lambda _: 0.01) == 1.25).all()


def test_it_is_never_coarser_than_the_limit_nor_where_nothing_is_merged():
    assert tolerances(lambda _: 5.0).max() == COARSEST
    assert not tolerances(lambda _: 5.0, replace(SETTINGS, detail_tolerance=0.0)).any()
    assert (tolerances(lambda _: 5.0, replace(SETTINGS, detail_tolerance=20.0)) == 20).all()
    assert (tolerances(lambda _: 5.0, rate=None) == 1.25).all()


def test_it_becomes_finer_again():
    clock = Clock()
    pace = Pace(10.0, clock)
    for seconds in [1.0] * 4 + [0.001] * 12:
        drawn = pace.begin(SETTINGS)
        clock.now += seconds
        pace.end(SETTINGS)
    assert drawn is SETTINGS


@pytest.mark.parametrize("samples", [1, 3])
def test_at_rest_the_picture_is_that_of_the_settings(samples, on_device):
    """Before, each picture takes 0.4 s by the clock, so that moving pictures are coarser."""
    scene, camera = scenes.torus(80_000, (48, 40))
    settings, clock = replace(SETTINGS, samples=samples), Clock()

    def draw(device):
        renderer = Renderer(device)
        view, tolerances, drawing = Refinement(renderer, Pace(10.0, clock)), [], renderer.draw

        def noted(scene, camera, settings):
            tolerances.append(settings.detail_tolerance)
            return drawing(scene, camera, settings)

        def show(moved):
            for shown in view.draw(scene, moved, settings):
                clock.now += 0.4
                (left, bottom, width, height), texels = shown.part, device.target([shown.texture]).read(0)
                picture = texels[bottom : bottom + height, left : left + width] * shown.scale
            return picture

        renderer.draw = noted
        for step in range(6):
            last = replace(camera, window=tuple(edge + 0.001 * step for edge in camera.window))
            show(last)
            assert view.wants_more == (samples > 1 or step > 1)
        while view.wants_more:
            picture = show(last)
        return tolerances, picture, Renderer(device).render(scene, last, settings).color

    tolerances, picture, whole = on_device(draw)
    assert tolerances[:2] == [1.25, 1.25] and 2 < tolerances[5] <= COARSEST
    assert tolerances[6:] == ([1.25] if samples == 1 else [])
    np.testing.assert_allclose(picture, whole, atol=2e-6)
