# SPDX-License-Identifier: GPL-3.0-or-later
"""All samples of a picture share their shadow maps, unless a lens changes the region that a sun's map must cover; and
so do following pictures, until anything changes that is in them."""

from dataclasses import replace

import numpy as np
import pytest

from splat_addon.reference import scenes
from splat_addon.rendering import Lens, Light, Renderer, Settings
from splat_addon.rendering.features import shadows
from splat_addon.rendering.plan import executor
from splat_addon.rendering.plan.shared import Shared

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
    monkeypatch.setattr(shadows, "contents", lambda *_: object())
    monkeypatch.setattr(Shared, "kept", lambda self, key, make: make())
    own = render(*under(SUN, LAMP), SETTINGS)
    assert len(drawn) == 5
    np.testing.assert_array_equal(shared.color, own.color)
    assert np.abs(shared.color - render(*under(), SETTINGS).color).max() > 0.1


@pytest.mark.parametrize(("lights", "times"), [((LAMP,), 1), ((SUN, LAMP), 4)])
def test_through_a_lens_maps_of_lamps_are_shared(lights, times, drawn, render):
    scene, camera = under(*lights)
    render(scene, replace(camera.cropped(20, 20, 8, 8), lens=Lens(0.1, 4.0)), SETTINGS)
    assert len(drawn) == times


def turned(camera, angle: float):
    """A camera that looks at the origin, on its way around it."""
    turn = np.eye(4)
    turn[:2, :2] = (np.cos(angle), -np.sin(angle)), (np.sin(angle), np.cos(angle))
    return replace(camera, matrix_world=turn @ camera.matrix_world)


def test_following_pictures_share_maps_until_their_contents_change(drawn, render, on_device):
    """They are shared by another scene with the same contents, too: a final render exports one for each frame."""
    (scene, camera), settings = under(SUN), replace(SETTINGS, samples=1)
    outer, inner = scene.surfels
    ball = replace(outer, matrix_world=np.diag((0.2, 0.2, 0.2, 1)))
    both = replace(scene, surfels=(outer, inner, ball))
    exported = replace(both, surfels=tuple(replace(one) for one in both.surfels))
    moved = replace(both, surfels=(outer, inner, replace(ball, matrix_world=np.diag((0.3, 0.2, 0.2, 1)))))
    low = replace(both, lights=(replace(SUN, direction=(1, -0.5, -0.7)),))
    flat = replace(settings, shadow_resolution=0)
    frames = [
        (both, camera, settings, 1),
        (both, turned(camera, 0.05), settings, 0),
        (exported, camera, settings, 0),
        (moved, camera, settings, 1),
        (both, camera, settings, 1),
        (low, camera, settings, 1),
        (low, camera, replace(settings, method="raycast"), 1),
        (low, camera, flat, 0),
        (low, camera, settings, 1),
        (replace(low, surfels=(outer, inner, replace(ball, casts_shadow=False))), camera, settings, 1),
    ]

    def rendered(device):
        renderer, colors, counts = Renderer(device), [], []
        for *frame, _ in frames:
            before = len(drawn)
            colors.append(renderer.render(*frame).color)
            counts.append(len(drawn) - before)
        return colors, counts

    colors, counts = on_device(rendered)
    assert counts == [count for *_, count in frames]
    for (*frame, _), color in zip(frames, colors, strict=True):
        np.testing.assert_array_equal(color, render(*frame).color)


def test_maps_that_were_given_up_are_drawn_again(drawn, render, on_device):
    (scene, camera), settings = under(SUN), replace(SETTINGS, samples=1)
    other = replace(scene, lights=(replace(SUN, direction=(-1, -0.5, -1)),))

    def rendered(device):
        renderer = Renderer(device)
        renderer.render(scene, camera, settings)
        parts = renderer.draw(other, camera, settings, in_slices=True)
        while len(drawn) < 2:
            next(parts)
        parts.close()
        device.restore()
        return renderer.render(scene, camera, settings).color

    np.testing.assert_array_equal(on_device(rendered), render(scene, camera, settings).color)
    assert len(drawn) == 4
