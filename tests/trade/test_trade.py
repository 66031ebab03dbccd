# SPDX-License-Identifier: GPL-3.0-or-later
"""What is measured in a scene is true of it, and what is promised from it is kept."""

import io
import re
from base64 import b64decode
from dataclasses import replace
from xml.etree import ElementTree

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from PIL import Image

from splat_addon.reference import render_exact, scenes
from splat_addon.reference.metrics import psnr
from splat_addon.rendering import Equirectangular, Panorama, RenderCancelled, Renderer, Settings, look_at, plan
from splat_addon.trade import (
    Choice,
    ExactPictures,
    Pace,
    Row,
    Target,
    choices_for,
    chosen,
    measure,
    page,
    series_of,
)
from splat_addon.trade.effects import Effects, Kind, tried_beside
from splat_addon.trade.exact import _places
from splat_addon.trade.page import frontier, png
from splat_addon.trade.target import samples_of, settled

FLAT = Settings(method="mip", shading="flat", outputs=("color",))


@pytest.fixture(scope="module")
def shot():
    return scenes.torus(2000, (32, 24))


@pytest.mark.parametrize(("name", "least"), [("box", 48), ("gaussian", 42)])
def test_exact_pictures_are_those_of_float64_rays(name, least, shot, on_device):
    exact = on_device(lambda device: ExactPictures.drawn(Renderer(device), *shot, FLAT))
    found = psnr(exact.colors[name], render_exact(*shot, FLAT, samples=8, pixel_filter=name).color)
    assert found > least
    assert abs(exact.converged[name] - found) < 12


@pytest.mark.parametrize("count", [8, 16, 64])
def test_the_gaussian_is_as_wide_in_all_directions(count):
    """The places of pictures have its variance beside that of the two samples along a pixel in each, without a mean."""
    places = _places("gaussian", count)
    np.testing.assert_allclose(places.mean(axis=0), 0, atol=1e-12)
    np.testing.assert_allclose(places.T @ places / count, (0.5 - 0.25**2) * np.eye(2), atol=1e-12)


def test_rows_tell_how_far_each_choice_is_off_and_what_it_takes(shot, on_device):
    choices = [Choice("coarse", {"method": "quad"}), Choice("fine", {"method": "quad", "supersampling": 4})]
    ticks = iter(np.cumsum([0, 1, 0, 2, 0, 3, 0, 1, 0, 4, 0, 8]))

    def draw(device):
        exact = ExactPictures.drawn(Renderer(device), *shot, FLAT, pictures=8)
        return list(measure(Renderer(device), *shot, FLAT, choices, exact, turns=2, clock=lambda: next(ticks)))

    coarse, fine = on_device(draw)
    assert fine.flip < coarse.flip / 2 and fine.psnr > coarse.psnr + 6 and fine.filter == "box"
    assert (coarse.seconds, coarse.least, fine.seconds, fine.least) == (2.5, 2, 6, 4)
    assert coarse.splats == 2000 and fine.bytes > coarse.bytes > 0
    assert coarse.difference.mean() == pytest.approx(coarse.flip, rel=1e-4)


def test_measuring_ends_when_nobody_wants_it(shot, on_device):
    with pytest.raises(RenderCancelled):
        on_device(lambda device: ExactPictures.drawn(Renderer(device), *shot, FLAT, told=lambda share: share < 0.3))


def test_a_panorama_is_refused(shot, on_device):
    camera = Panorama(look_at((0, 0, 3), (0, 0, 0)), Equirectangular(), (8, 4))
    with pytest.raises(ValueError, match="panorama"):
        on_device(lambda device: ExactPictures.drawn(Renderer(device), shot[0], camera, FLAT))


def test_only_what_the_scene_contains_is_tried(shot, on_device):
    scene, camera = shot
    shadowed = replace(scene, lights=tuple(replace(light, casts_shadow=True) for light in scene.lights))

    def names(device, scene):
        plan = Renderer(device).render(scene, camera, replace(FLAT, shading="principled")).stats["plan"]
        return {word for choice in choices_for(FLAT, plan) for word in choice.changes}

    without, with_shadow = on_device(lambda device: (names(device, scene), names(device, shadowed)))
    assert with_shadow - without == {"shadow_resolution"} and "layers" not in without
    spheres = scenes.transparent_spheres(count=300, size=(16, 16))[0]
    assert "layers" in on_device(lambda device: names(device, spheres))


def row(choice, flip, seconds, filter="box"):
    color = np.zeros((4, 6, 4), np.float32)
    return Row(choice, filter, 40.0, flip, (0.1, 30.0), seconds, seconds, 2**20, 10, color, color[..., 0])


@st.composite
def scenes_with_clocks(draw):
    """The true cost and error of any number of samples in some scene."""
    number = st.floats
    fixed, each = draw(number(0.001, 5)), draw(number(0.001, 1))
    first, power, floor = draw(number(0.01, 0.2)), draw(number(0.4, 1.2)), draw(number(0, 0.005))
    noise = np.random.default_rng(draw(st.integers(0, 999)))

    def seconds(choice):
        return (fixed + each * samples_of(choice)) * noise.uniform(0.97, 1.03)

    return (lambda choice: floor + first * samples_of(choice) ** -power), seconds


@given(scenes_with_clocks(), st.floats(1, 10))
def test_a_promised_time_and_error_are_kept(truth, room):
    """Within 15 % for every scene, with clocks that are off by 3 %."""
    flip, seconds = truth
    rows = [row(choice, flip(choice), seconds(choice)) for choice in series_of()]
    cheapest = min(each.seconds for each in rows)
    in_time = chosen(rows, Target(seconds=cheapest * 1.05 * room))
    assert in_time.is_kept and seconds(in_time.choice) <= 1.15 * cheapest * 1.05 * room
    closest = min(each.flip for each in rows)
    near = chosen(rows, Target(flip=closest * room))
    assert near.is_kept and flip(near.choice) <= 1.15 * closest * room
    assert near.seconds == pytest.approx(seconds(near.choice), rel=0.15)


def test_what_cannot_be_kept_is_said():
    rows = [row(Choice("one", {}), 0.05, 2.0), row(Choice("other", {}), 0.02, 3.0)]
    fast, close = chosen(rows, Target(seconds=1)), chosen(rows, Target(flip=0.001))
    assert fast.choice.name == "one" and not fast.is_kept and "as fast as this scene allows" in fast.why
    assert close.choice.name == "other" and not close.is_kept and "as close as this scene allows" in close.why
    with pytest.raises(ValueError, match="measure it first"):
        chosen([], Target(seconds=1))


def test_pictures_that_take_longer_have_fewer_samples():
    pace = Pace()
    rows = [row(choice, 0.1 / samples_of(choice), samples_of(choice)) for choice in series_of()]
    before = chosen(rows, Target(seconds=16.5), pace.factor)
    pace.drawn(before.seconds, 2 * before.seconds)
    after = chosen(rows, Target(seconds=16.5), pace.factor)
    assert samples_of(after.choice) == samples_of(before.choice) // 2 and after.seconds <= 16.5


class Expected:
    """Effects that are expected. of: (number, squared, time) of each."""

    def __init__(self, *of):
        self.of = of

    def kinds(self, choice):
        return [Kind(*each) for each in self.of]


@given(scenes_with_clocks(), st.floats(1, 6), st.floats(0.3, 3), st.floats(0.5, 2), st.booleans())
def test_a_choice_of_other_settings_is_drawn_before_it_is_promised(truth, room, wrong, slower, is_time):
    """So its error and its time are kept, however wrong what was expected of it is."""
    flip, seconds = truth
    coarse = {"detail_tolerance": 2.0}, 1e-4 * wrong, 0.5 * slower

    def true_flip(choice):
        return (flip(choice) ** 2 + 1e-4 * bool(choice.numbers)) ** 0.5

    def true_seconds(choice):
        return seconds(choice) * (0.5 if choice.numbers else 1.0)

    def drawn(choice):
        return row(choice, true_flip(choice), true_seconds(choice))

    rows = [drawn(choice) for choice in series_of()]
    closest, fastest = min(r.flip for r in rows), min(r.seconds for r in rows)
    target = Target(seconds=1.05 * fastest * room) if is_time else Target(flip=closest * room)
    found = settled(rows, target, Expected(coarse), drawn)
    assert found.is_kept and (not found.choice.numbers or any(r.choice.numbers == found.choice.numbers for r in rows))
    if is_time:
        assert true_seconds(found.choice) <= 1.15 * target.seconds
    else:
        assert true_flip(found.choice) <= 1.15 * target.flip


def test_effects_are_those_of_single_changes(shot):
    """A change that moves the picture away adds to the square of its error; one that saves nothing, or changes
    nothing, is not tried."""
    base = Choice("base", {"method": "mip", "samples": 1}, "base")
    tried = tried_beside(base, FLAT, plan(*shot, FLAT))
    assert {choice.numbers[0][0] for choice in tried} == {"detail_tolerance", "storage", "sum_format"}

    def picture(grey, choice, seconds):
        color = np.full((16, 16, 4), grey, np.float32)
        return replace(row(choice, 0.1, seconds), color=color)

    greys = {"detail_tolerance": 0.7, "storage": 0.5, "sum_format": 0.5}
    seconds = {"detail_tolerance": 0.5, "storage": 1.0, "sum_format": 1.0}
    rows = [picture(greys[name], each, seconds[name]) for each in tried for name, _ in each.numbers]
    kinds = list(Effects(picture(0.5, base, 1.0), rows, FLAT, [base]).kinds(base))
    assert [kind.numbers for kind in kinds] == [{"detail_tolerance": value} for value in (0.0, 2.0, 4.0)]
    closer, farther = kinds[0], kinds[1]
    assert closer.squared < 0 and closer.time == 1.0 and closer.flip(0.1) < 0.1
    assert farther.squared == -closer.squared and farther.time == 0.5
    assert farther.flip(0.1) == pytest.approx((0.01 + farther.squared) ** 0.5)
    alike = [picture(0.5, each, 0.5) for each in tried]
    assert list(Effects(picture(0.5, base, 1.0), alike, FLAT, [base]).kinds(base)) == []


def test_the_page_is_whole_and_holds_the_pictures():
    rows = [row(Choice("a < b", {}), 0.1, 1.0), row(Choice("c", {}), 0.01, 2.0, "gaussian")]
    exact = ExactPictures({}, {"box": 60.0, "gaussian": 50.0})
    text = page("Scene", "4 x 6 pixels", rows, exact)
    assert "a &lt; b" in text and "a < b" not in text and "60 dB" in text
    images = re.findall(r"src=data:image/png;base64,([^ ]+)", text)
    assert len(images) == 4 and all(Image.open(io.BytesIO(b64decode(each))).size == (6, 4) for each in images)
    ElementTree.fromstring(re.search(r"<svg.*</svg>", text, re.S)[0])
    assert frontier(rows) == {0, 1} and frontier([*rows, row(Choice("d", {}), 0.2, 3.0)]) == {0, 1}


def test_a_png_holds_what_is_shown():
    shown = np.random.default_rng(0).random((5, 7, 3))
    np.testing.assert_array_equal(np.asarray(Image.open(io.BytesIO(png(shown))))[::-1], np.round(shown * 255))
