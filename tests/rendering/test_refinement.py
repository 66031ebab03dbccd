# SPDX-License-Identifier: GPL-3.0-or-later
"""A view at rest becomes the render; while it changes, it is drawn with a single sample."""

from dataclasses import replace
from importlib import import_module
from itertools import pairwise
from unittest.mock import patch

import numpy as np
import pytest

from splat_addon.reference import scenes
from splat_addon.rendering import Environment, Lens, Light, Pace, Refinement, Renderer, Scene, Settings, plan
from splat_addon.rendering.assembly.accumulation import sample_camera
from splat_addon.rendering.passes import drawing
from splat_addon.rendering.plan import executor
from splat_addon.rendering.plan.graph import Pause
from splat_addon.rendering.shadows.receivers import viewers

SETTINGS = Settings(method="quad", samples=4, outputs=("color",))


def shown_picture(renderer, parts, size):
    """(h, w, 4) of what a viewport shows: all parts, cropped and scaled, with every pixel covered once."""
    picture, count = np.zeros((size[1], size[0], 4), np.float32), np.zeros(size[::-1], int)
    for part in parts:
        (x, y, width, height), (left, bottom, *_) = part.place, part.part
        pixels = renderer.device.target([part.texture]).read(0)
        if part.texture.size == (1, 1):
            pixels = np.broadcast_to(pixels, (height, width, 4))
        picture[y : y + height, x : x + width] = pixels[bottom : bottom + height, left : left + width] * part.scale
        count[y : y + height, x : x + width] += 1
    assert (count == 1).all()
    return picture


@pytest.fixture
def redraws(on_device):
    """redraws([(scene, camera, settings), ...]) -> pictures, with Refinement.samples and wants_more after each."""

    def run(views):
        def job(device):
            made = Refinement(Renderer(device))
            seen = []
            for scene, camera, settings in views:
                picture = shown_picture(made.renderer, made.draw(scene, camera, settings), camera.size)
                seen.append((picture, made.samples, made.wants_more))
            return seen

        return on_device(job)

    return run


@pytest.fixture
def small_tiles(monkeypatch):
    monkeypatch.setattr(import_module("splat_addon.rendering.plan.tiles"), "MAX_TARGET_EDGE", 40)


@pytest.fixture
def drawn(monkeypatch):
    """The names of the passes of the last frame."""
    names = []
    run = executor.run_pass

    def noting(tile, p):
        if p.name in ("shading", "resolve"):
            names.append(p.name)
        return run(tile, p)

    monkeypatch.setattr(executor, "run_pass", noting)
    return names


def torus(**changes):
    scene, camera = scenes.torus(count=4000, size=(64, 48))
    return scene, replace(camera, **changes)


def after_samples(render, scene, camera, settings, count):
    """The picture of the first `count` samples: their mean."""
    one, cameras = replace(settings, samples=1), (sample_camera(camera, n, settings.samples) for n in range(count))
    return np.mean([render(scene, moved, one).color for moved in cameras], axis=0, dtype=np.float64)


@pytest.mark.parametrize("method", ["quad", "mip"])
@pytest.mark.parametrize("lens", [None, Lens(0.1, 4.0)])
def test_a_view_at_rest_becomes_the_render(method, lens, redraws, render):
    scene, camera = torus(lens=lens)
    settings = replace(SETTINGS, method=method)
    seen = redraws([(scene, camera, settings)] * 6)
    assert [(samples, more) for _, samples, more in seen] == [
        (0, True),
        (1, True),
        (2, True),
        (3, True),
        (4, False),
        (4, False),
    ]
    one = replace(camera, lens=None)
    np.testing.assert_array_equal(seen[0][0], render(scene, one, replace(settings, samples=1)).color)
    for number in (2, 3):
        expected = after_samples(render, scene, camera, settings, number)
        np.testing.assert_allclose(seen[number][0], expected, atol=2e-6)
    np.testing.assert_allclose(seen[4][0], render(scene, camera, settings).color, atol=2e-6)
    np.testing.assert_array_equal(seen[5][0], seen[4][0])
    assert np.abs(seen[4][0] - seen[0][0]).max() > 0.05


@pytest.mark.parametrize("method", ["quad", "mip"])
def test_a_view_of_several_tiles_has_no_seams(method, small_tiles, redraws, render):
    """Margins are not shown: each pixel is shown once, by the tile that it belongs to."""
    scene, camera = torus()
    settings = replace(SETTINGS, method=method, transparent_film=True)
    assert len(plan(scene, camera, settings).tiles) > 3
    seen = redraws([(scene, camera, settings)] * 5)
    first = render(scene, camera, replace(settings, samples=1)).color
    np.testing.assert_array_equal(seen[0][0], first)
    np.testing.assert_allclose(seen[4][0], render(scene, camera, settings).color, atol=2e-6)


class Looks:
    """A clock that each look moves on by a second, so that every slice is as short as it can be."""

    now = 0.0

    def __call__(self):
        self.now += 1.0
        return self.now


def rest(device, scene, cameras, settings, pace=None):
    """The pictures of a view with a rate, from the first camera on until it wants no more, and what it was."""
    made, pictures = Refinement(Renderer(device), pace or Pace(10.0, Looks())), []
    for turn in range(2000):
        camera = cameras[min(turn, len(cameras) - 1)]
        pictures.append(shown_picture(made.renderer, made.draw(scene, camera, settings), camera.size))
        if turn >= len(cameras) and not made.wants_more:
            return pictures, made
    raise AssertionError("It is never complete.")


def distinct(pictures):
    """The pictures without those that are as the one before."""
    return pictures[:1] + [b for a, b in pairwise(pictures) if not np.array_equal(a, b)]


@pytest.mark.parametrize("samples", [2, 3])
@pytest.mark.parametrize("method", ["quad", "mip"])
def test_at_rest_slices_change_nothing_until_the_picture_is_complete(method, samples, on_device, render, monkeypatch):
    monkeypatch.setattr(drawing, "AT_ONCE", 300)
    scene, camera = torus()
    settings = replace(SETTINGS, method=method, samples=samples, shadow_resolution=128)
    pictures, made = on_device(lambda device: rest(device, scene, [camera], settings))
    seen = distinct(pictures)
    assert len(pictures) > 20 * samples and made.samples == samples
    first = render(scene, camera, replace(settings, samples=1)).color
    expected = [first, *(after_samples(render, scene, camera, settings, n) for n in range(1, samples + 1))]
    np.testing.assert_array_equal(seen[0], first)
    for picture in seen:
        assert min(np.abs(picture - other).max() for other in expected) < 2e-6
    np.testing.assert_allclose(pictures[-1], render(scene, camera, settings).color, atol=2e-6)


def test_a_camera_that_moves_ends_what_was_begun(on_device, render, monkeypatch):
    monkeypatch.setattr(drawing, "AT_ONCE", 300)
    scene, camera = torus()
    moved = replace(camera, window=tuple(v + 0.1 for v in camera.window))
    pictures, _ = on_device(lambda device: rest(device, scene, [camera] * 9 + [moved], SETTINGS))
    assert len(distinct(pictures[:9])) == 1
    np.testing.assert_allclose(pictures[-1], render(scene, moved, SETTINGS).color, atol=2e-6)


class Fine(Pace):
    """The pace of a view that never becomes coarser."""

    def end(self, settings, streamed=0):
        pass


def test_a_camera_that_moves_on_is_shown_behind_but_whole(on_device, render, monkeypatch):
    monkeypatch.setattr(drawing, "AT_ONCE", 1000)
    scene, camera = torus()
    cameras = [replace(camera, window=tuple(v + 0.003 * k for v in camera.window)) for k in range(60)]
    settings = replace(SETTINGS, samples=1)
    pictures, made = on_device(lambda device: rest(device, scene, cameras, settings, Fine(10.0, Looks())))
    expected = np.array([render(scene, one, settings).color for one in cameras])
    seen = [np.flatnonzero((expected == picture).all(axis=(1, 2, 3))) for picture in pictures]
    assert all(len(which) == 1 for which in seen)
    numbers = np.concatenate(seen)
    assert (np.diff(numbers) >= 0).all() and 4 < len(set(numbers.tolist())) < 20
    assert (numbers[:60] <= np.arange(60)).all() and numbers[-1] == 59 and not made.is_drawing


def test_a_scene_that_changes_with_each_picture_is_shown_at_once(on_device, render, monkeypatch):
    monkeypatch.setattr(drawing, "AT_ONCE", 1000)
    scene, camera = torus()
    settings = replace(SETTINGS, samples=1)
    scenes_of = [replace(scene, world=(0.1 * k, 0, 0)) for k in range(5)]

    def job(device):
        made = Refinement(Renderer(device), Fine(10.0, Looks()))
        return [shown_picture(made.renderer, made.draw(one, camera, settings), camera.size) for one in scenes_of]

    for found, one in zip(on_device(job), scenes_of, strict=True):
        np.testing.assert_array_equal(found, render(one, camera, settings).color)


def test_tiles_of_a_picture_at_rest_are_shown_together(small_tiles, on_device, render):
    """The sum of the samples is shown while another is drawn, so that no tile may be ahead."""
    scene, camera = torus()
    settings = replace(SETTINGS, samples=3)
    pictures, _ = on_device(lambda device: rest(device, scene, [camera], settings))
    first = render(scene, camera, replace(settings, samples=1)).color
    expected = [first, *(after_samples(render, scene, camera, settings, n) for n in range(1, 4))]
    for picture in pictures:
        assert min(np.abs(picture - other).max() for other in expected) < 2e-6


def test_whatever_changes_starts_anew(redraws, render):
    scene, camera = torus()
    moved = replace(camera, window=tuple(v + 0.1 for v in camera.window))
    flat = replace(SETTINGS, shading="flat")
    views = [(scene, camera, SETTINGS)] * 3 + [(scene, moved, SETTINGS), (scene, moved, flat)]
    views += [(replace(scene, world=(0.5, 0, 0)), moved, flat)] * 5
    seen = redraws(views)
    assert [samples for _, samples, _ in seen] == [0, 1, 2, 0, 0, 0, 1, 2, 3, 4]
    for turn in (3, 4, 5):
        expected = render(*views[turn][:2], replace(views[turn][2], samples=1)).color
        np.testing.assert_array_equal(seen[turn][0], expected)
    np.testing.assert_allclose(seen[9][0], render(*views[9]).color, atol=2e-6)


def test_what_is_done_is_not_drawn_again(redraws, drawn):
    scene, camera = torus()
    redraws([(scene, camera, SETTINGS)] * 9)
    assert len(drawn) == 5


def test_one_sample_never_asks_for_more(redraws):
    scene, camera = torus()
    assert [more for *_, more in redraws([(scene, camera, replace(SETTINGS, samples=1))] * 2)] == [False, False]


def test_an_even_background_never_asks_for_more(redraws):
    _, camera = torus()
    scene = Scene(world=(0.1, 0.2, 0.3))
    seen = redraws([(scene, camera, SETTINGS)] * 3)
    assert not seen[1][2] and not seen[2][2]
    for picture, *_ in seen:
        np.testing.assert_allclose(picture, np.broadcast_to(np.float32((0.1, 0.2, 0.3, 1)), picture.shape))


def test_a_picture_as_background_refines(redraws, render):
    _, camera = torus()
    pixels = np.random.default_rng(0).uniform(size=(8, 16, 3))
    scene = Scene(world=(1, 1, 1), environment=Environment(pixels))
    seen = redraws([(scene, camera, SETTINGS)] * 5)
    np.testing.assert_allclose(seen[4][0], render(scene, camera, SETTINGS).color, atol=2e-6)


def test_shadow_maps_are_drawn_once_while_nothing_changes(redraws, monkeypatch):
    count, run = [], executor.run_pass
    monkeypatch.setattr(executor, "run_pass", lambda t, p: (p.name == "shadow_maps" and count.append(1)) or run(t, p))
    scene, camera = torus()
    sun = Light("sun", energy=2.0, direction=(1, -0.5, -1), casts_shadow=True)
    lit = replace(scene, lights=(sun,))
    redraws([(lit, camera, replace(SETTINGS, shadow_resolution=64))] * 5)
    assert len(count) == 1


def test_only_a_view_that_refines_keeps_a_sum():
    scene, camera = torus()
    plain, refined = plan(scene, camera, SETTINGS), plan(scene, camera, SETTINGS, is_added_up=True)
    assert refined.passes[:-1] == plain.passes
    assert set(refined.textures) - set(plain.textures) == {"combined_sum", "odd_sum"}
    assert refined.size(refined.filled["combined_sum"], (7, 7)) == camera.size and "added up" in str(refined)


def test_a_call_may_end_between_compiling_a_program_and_drawing_splats_with_it(on_device):
    scene, camera = torus()

    def job(device):
        renderer, events, pipeline, draw = Renderer(device), [], device.pipeline, device.draw_triangles

        def compiled(description):
            events.append("program")
            return pipeline(description)

        def drawn(program, target, triangles, *others, **named):
            if triangles > 1:  # one fills a picture
                events.append("draw")
            draw(program, target, triangles, *others, **named)

        with patch.object(device, "pipeline", compiled), patch.object(device, "draw_triangles", drawn):
            for part in renderer.draw(scene, camera, Settings(), in_slices=True):
                events.append("pause" if isinstance(part, Pause) else "picture")
        return events

    events = on_device(job)
    after = [events[k + 1] for k, event in enumerate(events[:-1]) if event == "program"]
    assert "draw" in events and "pause" in after and "draw" not in after


@pytest.mark.parametrize("kind", ["draw", "add_sample"])
def test_a_picture_given_up_at_a_pause_leaves_the_device_alone(kind, on_device):
    """When Blender ends, the device is gone before the pictures that were begun."""
    scene, camera = scenes.torus(3000, (32, 24))

    def job(device):
        renderer = Renderer(device)
        if kind == "draw":
            parts = renderer.draw(scene, camera, SETTINGS, in_slices=True)
        else:
            parts = renderer.add_sample(scene, camera, viewers(camera, camera), SETTINGS, True)
        assert isinstance(next(parts), Pause)
        device.restore()
        with patch.object(device, "restore") as restore:
            parts.close()
        return restore.call_count

    assert on_device(job) == 0
