# SPDX-License-Identifier: GPL-3.0-or-later
"""A view that moves too slowly is drawn coarser until it reaches its rate; at rest it is drawn as the settings say."""

from dataclasses import replace
from importlib import import_module

import numpy as np
import pytest

from splat_addon.reference import scenes
from splat_addon.rendering import Pace, Refinement, Renderer, Settings
from splat_addon.rendering.viewport.pace import COARSEST, LEAST_STREAMED, LONGEST_SLICE, SLICE, WIDEST

SIZE = (240, 160)
CAMERA = scenes.torus(100, SIZE)[1]
SETTINGS = Settings(outputs=("color",), detail_tolerance=1.25, shadow_resolution=0)


class Clock:
    """A clock whose seconds a test sets."""

    now = 0.0

    def __call__(self) -> float:
        return self.now


def choices(seconds, settings=SETTINGS, pictures=20, rate=10.0):
    """The tolerances and widths of pixels chosen for successive pictures; `seconds` gives a picture's time for both."""
    clock, found = Clock(), []
    pace = Pace(rate, clock)
    for _ in range(pictures):
        camera, drawn = pace.begin(CAMERA, settings)
        found.append((drawn.detail_tolerance, CAMERA.size[0] / camera.size[0]))
        clock.now += seconds(*found[-1])
        pace.end(settings)
    return np.array(found).T


def test_a_slow_view_becomes_coarser_until_it_holds_the_rate():
    found, widths = choices(lambda tolerance, _: 0.6 * (1.25 / tolerance) ** 2)
    assert found[0] == 1.25 and (np.diff(found) >= -1e-9).all() and found[-1] == found[-2]
    assert 0.05 < 0.6 * (1.25 / found[-1]) ** 2 <= 0.1 and (widths == 1).all()


def test_a_fast_view_stays_as_fine_as_the_settings_say():
    assert (choices(lambda *_: 0.01) == [[1.25], [1]]).all()


@pytest.mark.parametrize(
    ("between", "wanted"), [(0.0, SLICE / 10), (0.03, SLICE / 10), (0.06, 0.06), (5.0, LONGEST_SLICE / 10)]
)
def test_a_slice_takes_as_long_as_what_comes_between_slices_within_limits(between, wanted):
    clock = Clock()
    pace = Pace(10.0, clock)
    assert pace.slice_end() == pytest.approx(SLICE / 10)
    pace.pause()
    clock.now += between
    assert pace.slice_end() - clock.now == pytest.approx(wanted)
    pace.go_on()
    assert pace.slice_end() - clock.now == pytest.approx(SLICE / 10)


def test_it_is_never_coarser_than_the_limits():
    tolerances, widths = choices(lambda tolerance, width: 1e4 / (tolerance * width) ** 2)
    assert tolerances.max() == COARSEST and widths.max() == WIDEST
    tolerances, widths = choices(lambda *_: 5.0, replace(SETTINGS, detail_tolerance=20.0))
    assert (tolerances == 20).all() and widths.max() == WIDEST
    assert (choices(lambda *_: 5.0, rate=None) == [[1.25], [1]]).all()


def test_where_the_fewest_pixels_are_too_many_there_are_fewer_splats_even_if_that_saves_little():
    tolerances, widths = choices(lambda tolerance, _: 2 * (1.25 / tolerance) ** 0.25)
    assert widths[-1] == WIDEST and tolerances[-1] == COARSEST


def test_a_picture_that_takes_many_times_its_time_is_followed_by_a_far_coarser_one():
    found, _ = choices(lambda tolerance, _: 2 * (1.25 / tolerance) ** 2, pictures=2)
    assert found[1] == pytest.approx(1.25 * 4)
    found, _ = choices(lambda tolerance, _: 0.3 * (1.25 / tolerance) ** 2, pictures=2)
    assert found[1] < 1.25 * 2


@pytest.mark.parametrize("tolerance", [0.0, 1.25])
def test_where_merging_does_not_help_there_are_fewer_pixels(tolerance):
    """The time is that of pixels: of many lights, or of large surfels in front of one another."""
    settings = replace(SETTINGS, detail_tolerance=tolerance)
    tolerances, widths = choices(lambda _, width: 0.02 + 0.5 / width**2, settings)
    assert tolerances[-1] == tolerance and widths[-1] == widths[-2]
    assert 0.05 < 0.02 + 0.5 / widths[-1] ** 2 <= 0.1
    # one picture tries whether fewer surfels help
    assert (tolerances > tolerance).sum() <= 1


def test_both_help_where_each_does_for_a_part():
    tolerances, widths = choices(lambda tolerance, width: 400 / tolerance**2 / width**2, pictures=30)
    assert tolerances[-1] == COARSEST and widths[-1] > 1 and 400 / tolerances[-1] ** 2 / widths[-1] ** 2 <= 0.1


def streamed(seconds, pictures=40, there=10**6):
    """How many surfels of a file successive pictures have; `seconds` gives a picture's time for them."""
    clock, found = Clock(), []
    pace = Pace(10.0, clock)
    for _ in range(pictures):
        pace.begin(CAMERA, SETTINGS)
        found.append(min(pace.most, there))
        clock.now += seconds(found[-1])
        pace.end(SETTINGS, found[-1])
    return found


def test_a_view_takes_as_many_surfels_from_files_as_its_rate_allows():
    found = streamed(lambda count: 0.01 + count / 2e6)
    assert found[0] == LEAST_STREAMED and found == sorted(found) and 0.06 <= 0.01 + found[-1] / 2e6 <= 0.1
    assert streamed(lambda count: 1e-3)[-1] == 10**6
    assert set(streamed(lambda count: 5.0)) == {LEAST_STREAMED}


def test_a_view_that_becomes_slow_takes_fewer_at_once():
    clock = Clock()
    pace = Pace(10.0, clock)
    for seconds in (*[0.01] * 10, 1.0, 1.0, 1.0):
        before = pace.most
        pace.begin(CAMERA, SETTINGS)
        clock.now += seconds
        pace.end(SETTINGS, before)
        assert (pace.most >= before) if seconds < 0.1 else pace.most == max(before // 4, LEAST_STREAMED)
    assert Pace(None).most is None


@pytest.mark.parametrize("slow", [lambda width: 1.0, lambda width: 1.0 / width**2])
def test_it_becomes_finer_again(slow):
    clock = Clock()
    pace = Pace(10.0, clock)
    for turn in range(30):
        camera, drawn = pace.begin(CAMERA, SETTINGS)
        clock.now += slow(CAMERA.size[0] / camera.size[0]) if turn < 6 else 0.001
        pace.end(SETTINGS)
        assert turn != 5 or camera is not CAMERA
    assert drawn is SETTINGS and camera is CAMERA


def test_a_first_picture_that_others_follow_begins_with_few_pixels():
    clock = Clock()
    clock.now, pace, widths = 1.0, Pace(10.0, clock), []
    for _ in range(4):
        pace.begin_coarsely()
        camera, _ = pace.begin(CAMERA, SETTINGS)
        widths.append(CAMERA.size[0] / camera.size[0])
        clock.now += 0.001
        pace.end(SETTINGS)
    assert widths == [WIDEST, 2, 1, 1]


@pytest.mark.parametrize(
    ("texels", "expected"), [(1024, [256, 512, 1024, 1024]), (96, [48, 48, 96, 96]), (50, [50] * 4), (0, [0] * 4)]
)
def test_shadow_maps_have_fewer_texels_where_pixels_are_wider(texels, expected):
    clock, found = Clock(), []
    clock.now, pace = 1.0, Pace(10.0, clock)
    pace.begin_coarsely()
    for _ in expected:
        found.append(pace.begin(CAMERA, replace(SETTINGS, shadow_resolution=texels))[1].shadow_resolution)
        clock.now += 0.001
        pace.end(SETTINGS)
    assert found == expected


@pytest.mark.parametrize("edge", [4096, 50])
def test_a_picture_of_fewer_pixels_fills_the_view(edge, on_device, monkeypatch):
    """In tiles too, each pixel of the view is shown once."""
    monkeypatch.setattr(import_module("splat_addon.rendering.plan.tiles"), "MAX_TARGET_EDGE", edge)
    scene, camera = scenes.torus(4000, SIZE)

    class Slow(Pace):
        def begin(self, camera, settings):
            return replace(camera, size=(61, 37)), settings

    def draw(device):
        view = Refinement(Renderer(device), Slow(10.0))
        count, drawn = np.zeros(SIZE[::-1], int), set()
        for shown in view.draw(scene, camera, SETTINGS, hurries=True):
            x, y, width, height = shown.place
            count[y : y + height, x : x + width] += 1
            drawn.add(shown.part[2:])
        return count, drawn, view.wants_more

    count, drawn, wants_more = on_device(draw)
    assert (count == 1).all() and wants_more
    assert drawn == {(61, 37)} if edge == 4096 else len(drawn) > 1


@pytest.mark.parametrize("does_merging_help", [True, False])
@pytest.mark.parametrize("samples", [1, 3])
def test_at_rest_the_picture_is_that_of_the_settings(samples, does_merging_help, on_device):
    """Before, pictures take 0.4 s by the clock, so that those of a moving view are coarser."""
    scene, camera = scenes.torus(80_000, (48, 40))
    settings, clock = replace(SETTINGS, samples=samples), Clock()

    def draw(device):
        renderer = Renderer(device)
        view, drawn, drawing = Refinement(renderer, Pace(10.0, clock)), [], renderer.draw

        def noted(scene, camera, settings, **how):
            drawn.append((settings.detail_tolerance, camera.size))
            return drawing(scene, camera, settings, **how)

        def show(moved):
            for shown in view.draw(scene, moved, settings):
                clock.now += 0.4 * (1.25 / drawn[-1][0]) ** 2 if does_merging_help else 0.4
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
        return drawn, picture, Renderer(device).render(scene, last, settings).color

    drawn, picture, whole = on_device(draw)
    fine = (1.25, camera.size)
    assert drawn[:2] == [fine] * 2
    assert 2 < drawn[5][0] <= COARSEST if does_merging_help else drawn[5][1] == (12, 10)
    assert drawn[6:] == ([fine] if samples == 1 else [])
    np.testing.assert_allclose(picture, whole, atol=2e-6)
