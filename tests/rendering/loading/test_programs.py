# SPDX-License-Identifier: GPL-3.0-or-later
"""While programs are compiled, a view shows a draft or its last picture, and in the end that of a render."""

from dataclasses import replace

import numpy as np

from splat_addon.rendering import Environment, Renderer, look_at
from tests.rendering.loading.views import SETTINGS, Clock, begun, shown, shown_texels, torus, two


def test_a_draft_is_there_long_before_the_programs_of_the_picture(small_steps, on_device):
    scene, camera = torus(4000)

    def draw(device):
        (view, _), pictures = begun(device, Clock(0.06)), []
        # an empty scene shows nothing that could vanish again
        list(view.draw(replace(scene, surfels=()), camera, SETTINGS))
        while True:
            parts = view.draw(scene, camera, SETTINGS)
            pictures.append([shown_texels(device, part) for part in parts])
            if not view.is_compiling:
                break
            assert len(pictures) < 50
        last = shown(device, view, scene, camera, SETTINGS)
        return pictures, len(view._stand_ins), last, Renderer(device).render(scene, camera, SETTINGS).color

    pictures, kept, last, whole = on_device(draw)
    assert not kept
    first = next(number for number, seen in enumerate(pictures) if seen)
    assert 1 < first < 5 and len(pictures) > first + 4
    assert all(pictures[first:])
    (draft,) = pictures[first]
    # it shows the object where it is, lit, without shadows
    is_seen = np.abs(whole - whole[0, 0]).max(axis=2) > 0.02
    is_drafted = np.abs(draft - draft[0, 0]).max(axis=2) > 0.02
    assert (is_seen & is_drafted).sum() > 0.8 * is_seen.sum() and is_drafted.sum() < 1.3 * is_seen.sum()
    np.testing.assert_array_equal(last, whole)


def test_the_last_picture_stays_while_programs_of_the_next_are_compiled(small_steps, on_device):
    scene, camera = torus(4000)
    turned = replace(camera, matrix_world=look_at((4, 3, 6), (0, 0, 0)))
    flat = replace(SETTINGS, shading="flat", method="ewa", supersampling=2)

    def draw(device):
        view, pictures = begun(device, Clock(0.0))[0], []
        (before,) = view.draw(scene, camera, SETTINGS)
        texels = shown_texels(device, before)
        view.loading._clock.step = 0.06
        while True:
            # the camera moves meanwhile
            pictures.append(shown(device, view, scene, turned, flat))
            if not view.is_compiling:
                break
            assert len(pictures) < 50
        return pictures, texels, Renderer(device).render(scene, turned, flat).color

    pictures, before, whole = on_device(draw)
    assert len(pictures) > 2
    assert all((picture == before).all() for picture in pictures[:-1])
    np.testing.assert_array_equal(pictures[-1], whole)


def test_the_last_picture_stays_where_a_new_set_is_late_and_needs_programs(small_steps, on_device):
    (few, camera), (both, _) = torus(4000), two()
    more = replace(both, surfels=(*few.surfels, both.surfels[1]))

    def draw(device):
        view, thread = begun(device, Clock(0.0))
        before, pictures = shown(device, view, few, camera, SETTINGS), []
        view.loading._clock.step = 0.02
        view.loading._programs.clear()
        while not pictures or view.is_compiling or view.is_late:
            pictures.append(shown(device, view, more, camera, SETTINGS))
            thread.work(1)
            assert len(pictures) < 80
        return before, pictures, Renderer(device).render(more, camera, SETTINGS).color

    before, pictures, whole = on_device(draw)
    assert (pictures[0] == before).all() and len(pictures) > 3
    np.testing.assert_array_equal(pictures[-1], whole)


def test_a_scene_with_nothing_but_a_world_is_drawn_in_the_end(small_steps, on_device):
    """Its draft shows no more than it does."""
    scene, camera = torus(4000)
    sky = Environment(np.random.default_rng(1).random((8, 16, 3), np.float32))
    empty = replace(scene, surfels=(), environment=sky, world=(1, 1, 1))

    def draw(device):
        view, calls = begun(device, Clock(0.06))[0], 0
        while view.is_compiling or not calls:
            list(view.draw(empty, camera, SETTINGS))
            calls += 1
            assert calls < 20
        return shown(device, view, empty, camera, SETTINGS), Renderer(device).render(empty, camera, SETTINGS).color

    np.testing.assert_array_equal(*on_device(draw))


def test_a_draft_follows_the_camera_and_is_drawn_once_for_each(small_steps, on_device, monkeypatch):
    scene, camera = torus(4000)
    turned = replace(camera, matrix_world=look_at((0, 0, 12), (0, 0, 0)))

    def draw(device):
        view, drawn = begun(device, Clock(0.06))[0], []
        while not (parts := list(view.draw(scene, camera, SETTINGS))):
            pass
        monkeypatch.setattr(
            view.refinement.renderer,
            "draw",
            lambda *args, draw_all=view.refinement.renderer.draw, **how: drawn.append(args) or draw_all(*args, **how),
        )
        again, moved = list(view.draw(scene, camera, SETTINGS)), list(view.draw(scene, turned, SETTINGS))
        drafts = [args for args in drawn if args[2].method == "quad"]
        return view.is_compiling, parts, again, moved, drafts

    is_compiling, parts, again, moved, drafts = on_device(draw)
    assert is_compiling and len(moved) == 1 and again[0] is parts[0]
    assert len(drafts) == 1 and drafts[0][1] is turned


def test_pictures_go_on_where_they_paused_to_compile_a_program(small_steps, on_device, monkeypatch):
    """The first picture begins again only after the draft, which is drawn with the same resources."""
    scene, camera = torus(4000)

    def draw(device):
        view, begun_with, calls = begun(device, Clock(0.06))[0], [], 0
        draw_all = view.refinement.renderer.draw
        monkeypatch.setattr(
            view.refinement.renderer, "draw", lambda *of, **how: (begun_with.append(of[2]), draw_all(*of, **how))[1]
        )
        while view.is_compiling or not calls:
            last = [shown_texels(device, part) for part in view.draw(scene, camera, SETTINGS)]
            calls += 1
        return begun_with, calls, last, Renderer(device).render(scene, camera, SETTINGS).color

    begun_with, calls, (last,), whole = on_device(draw)
    assert [settings == SETTINGS for settings in begun_with] == [True, False, True] and calls > 6
    np.testing.assert_array_equal(last, whole)
