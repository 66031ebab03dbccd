# SPDX-License-Identifier: GPL-3.0-or-later
"""A view's large sets come to the device in slices; meanwhile others stand for them, and in the end the picture is that
of a render, bit by bit.
"""

import gc
from dataclasses import replace
from importlib import import_module

import numpy as np
import pytest

from splat_addon.reference import scenes
from splat_addon.rendering import Renderer
from splat_addon.rendering.upload import loading, pools
from tests.rendering.loading.views import COUNT, FEWER, SETTINGS, SIZE, Clock, begun, clipped, rough, shown, torus, two

SHOTS = (torus, rough, clipped, two, scenes.textured_plane)


@pytest.mark.parametrize(("storage", "tolerance"), [("float32", 0.0), ("16-bit", 1.5)])
@pytest.mark.parametrize("shot", SHOTS, ids=lambda shot: shot.__name__)
def test_the_whole_picture_is_that_of_a_render_bit_by_bit(
    shot, storage, tolerance, small_steps, on_device, monkeypatch
):
    scene, camera = shot()
    if shot is scenes.textured_plane:
        monkeypatch.setattr(loading, "AT_ONCE", 40)
    settings = replace(SETTINGS, storage=storage, detail_tolerance=tolerance)

    def draw(device):
        view, thread = begun(device)
        shown(device, view, scene, camera, settings)
        assert view.loading.left[0] >= sum(len(i.surfels) for i in scene.surfels)
        for _ in range(200):
            thread.work()
            picture = shown(device, view, scene, camera, settings)
            assert view.loading.bytes_written <= loading.MOST_BYTES
            if not view.loading.left[0]:
                break
        return picture, Renderer(device).render(scene, camera, settings).color

    picture, whole = on_device(draw)
    np.testing.assert_array_equal(picture, whole)


def test_a_set_of_a_million_comes_in_several_pictures(on_device):
    """The limits are those of a view."""
    scene, camera = scenes.torus(1_000_000, SIZE)

    def draw(device):
        (view, thread), written = begun(device), []
        shown(device, view, scene, camera, SETTINGS)
        while view.loading.left[0] and len(written) < 50:
            thread.work()
            picture = shown(device, view, scene, camera, SETTINGS)
            written.append(view.loading.bytes_written)
        return picture, written, Renderer(device).render(scene, camera, SETTINGS).color

    picture, written, whole = on_device(draw)
    assert 64e6 < sum(written) < 80e6 and len(written) >= 3
    assert max(written) <= loading.MOST_BYTES
    np.testing.assert_array_equal(picture, whole)


def test_meanwhile_few_show_the_whole_object(small_steps, on_device):
    scene, camera = torus(60_000)
    settings = replace(SETTINGS, transparent_film=True, shadow_resolution=0)

    def draw(device):
        view, _ = begun(device)
        first = shown(device, view, scene, camera, settings)
        renderer = view.refinement.renderer
        return first, renderer.resources.loading.left, Renderer(device).render(scene, camera, settings).color

    first, left, whole = on_device(draw)
    assert left == (COUNT, COUNT)
    inside = whole[..., 3] > 0.999
    assert inside.sum() > 300 and first[inside, 3].min() > 0.99
    assert np.abs(first - whole)[inside, :3].mean() < 0.05


def test_what_has_arrived_is_shown_beside_what_has_not(small_steps, on_device):
    scene, camera = two()

    def draw(device):
        view, thread = begun(device)
        counts, draw_scene = [], view.refinement.draw

        def noted(scene, *rest, **options):
            counts.append([len(i.surfels) for i in scene.surfels])
            return draw_scene(scene, *rest, **options)

        view.refinement.draw = noted
        shown(device, view, scene, camera, SETTINGS)
        thread.work(1)
        while len(counts) < 3 or counts[-1][0] < COUNT:
            shown(device, view, scene, camera, SETTINGS)
        return counts

    counts = on_device(draw)
    assert counts[0] == [COUNT, FEWER] and counts[1][0] < COUNT and counts[-1][1] < FEWER


def test_a_picture_stops_writing_when_its_time_is_up(small_steps, on_device):
    scene, camera = torus()

    def draw(device):
        view, thread = begun(device, Clock(0.02))
        view.loading.compiles_in_slices = False
        shown(device, view, scene, camera, SETTINGS)
        thread.work()
        shown(device, view, scene, camera, SETTINGS)
        return view.loading.bytes_written

    assert on_device(draw) == 2 * loading.SLICE_BYTES


def test_stand_ins_are_drawn_once_while_slices_are_written(small_steps, on_device, monkeypatch):
    scene, camera = torus()

    def draw(device):
        (view, thread), drawn, written = begun(device), [], []
        draw_all = view.refinement.renderer.draw
        monkeypatch.setattr(
            view.refinement.renderer, "draw", lambda *of, **how: (drawn.append(of[0]), draw_all(*of, **how))[1]
        )
        first = shown(device, view, scene, camera, SETTINGS)
        thread.work()
        drawn.clear()
        while view.is_late:
            picture = shown(device, view, scene, camera, SETTINGS)
            written.append(view.loading.bytes_written)
            if view.is_late:
                np.testing.assert_array_equal(picture, first)
        return drawn, written

    drawn, written = on_device(draw)
    assert len(written) >= 3 and all(written) and drawn[0] is scene


def test_a_picture_may_wait_for_everything(small_steps, on_device):
    """While an animation plays, sets change with each picture, so that they would never be whole."""
    scene, camera = torus()

    def draw(device):
        view, thread = begun(device)
        view.loading.is_in_background = False
        first = shown(device, view, scene, camera, SETTINGS)
        return first, len(thread.jobs), Renderer(device).render(scene, camera, SETTINGS).color

    first, jobs, whole = on_device(draw)
    assert jobs == 0
    np.testing.assert_array_equal(first, whole)


def test_small_sets_are_in_the_first_picture(on_device):
    scene, camera = torus()

    def draw(device):
        view, thread = begun(device)
        first = shown(device, view, scene, camera, SETTINGS)
        return first, len(thread.jobs), Renderer(device).render(scene, camera, SETTINGS).color

    first, jobs, whole = on_device(draw)
    assert jobs == 0
    np.testing.assert_array_equal(first, whole)


def test_many_small_sets_are_a_large_one(small_steps, on_device, monkeypatch):
    """A first picture prepares no more than its share, however it is divided; sets that share textures are made at
    once, up to `MOST_POOLED`."""
    monkeypatch.setattr(pools, "MOST_SPLATS", 0)
    scene, camera = torus(2000)
    (instance,) = scene.surfels
    scene = replace(scene, surfels=tuple(replace(instance.surfels) for _ in range(9)))

    def draw(device):
        view, thread = begun(device)
        shown(device, view, scene, camera, SETTINGS)
        return len(thread.jobs)

    assert on_device(draw) == 9 - loading.AT_ONCE // len(instance.surfels)


def test_what_is_gone_is_not_made(small_steps, on_device):
    _, camera = torus()

    def draw(device):
        (view, thread), scene = begun(device), two()[0]
        shown(device, view, scene, camera, SETTINGS)
        other = replace(scene, surfels=(scene.surfels[0],))  # a slice would keep what it is a slice of
        del scene
        gc.collect()
        shown(device, view, other, camera, SETTINGS)
        gc.collect()
        # what nobody has any more is no progress to be shown, before the next picture withdraws it
        assert view.loading.left[0] == COUNT
        shown(device, view, other, camera, SETTINGS)
        one = [future.cancelled() for future, _ in thread.jobs]
        left = view.loading.left[0]
        view.refinement.renderer.release()
        return one, left, [future.cancelled() for future, _ in thread.jobs], view.loading.left

    assert on_device(draw) == ([False, True], COUNT, [True, True], (0, 0))


def test_rows_that_are_written_are_those_of_a_texture_made_whole(on_device):
    texels = np.random.default_rng(3).random((40, 16, 4)).astype(np.float32)

    def draw(device):
        pictures = []
        for format in ("RGBA32F", "RGBA16"):
            values = texels if format == "RGBA32F" else np.rint(texels * 65535) / np.float32(65535)
            written = device.texture((16, 40), format)
            for first, last in ((0, 13), (13, 40)):
                device.write(written, first, values[first:last])
            device.restore()
            whole = device.texture((16, 40), format, values)
            pictures += [device.target([texture]).read(0) for texture in (written, whole)]
        return pictures

    float32, whole, unorm, whole_unorm = on_device(draw)
    np.testing.assert_array_equal(float32, texels)
    np.testing.assert_array_equal(whole, texels)
    np.testing.assert_array_equal(unorm, whole_unorm)


def test_tiles_are_whole_while_surfels_arrive(small_steps, on_device, monkeypatch):
    """What is late is asked for before the first tile is shown, so that no tile is shown twice."""
    monkeypatch.setattr(import_module("splat_addon.rendering.plan.tiles"), "MAX_TARGET_EDGE", 40)
    scene, camera = two()

    def draw(device):
        view, _ = begun(device)
        return sum(part.place[2] * part.place[3] for part in view.draw(scene, camera, SETTINGS))

    assert on_device(draw) == SIZE[0] * SIZE[1]
