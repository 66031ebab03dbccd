# SPDX-License-Identifier: GPL-3.0-or-later
"""Penumbrae of opaque casters on a floor are smooth: beside rays to the lamp they have no tears, hatch or steps."""

from dataclasses import replace

import numpy as np
import pytest

from splat_addon.rendering import Camera, Light, Scene, Settings, look_at
from tests.rendering.lamp_rays import floor_places, sampled, seen_share

SIZE, WIDTH, MIDDLE = 72, 3.2, -0.6
CAMERA = Camera.orthographic(look_at((MIDDLE, 0, 5), (MIDDLE, 0, 0), (0, 1, 0)), WIDTH, (SIZE, SIZE), 0.05, 20)
PLACES = floor_places(SIZE, WIDTH, MIDDLE)
PLACE = (5.0, -0.7, 8.0)
AXES = 1.6 * look_at(PLACE, (0, 0, 0))[:3, :2].T
LAMPS = {
    "sun": Light("sun", energy=3, direction=(-1, 0.15, -1.6), size=0.5, casts_shadow=True),
    "point": Light("point", energy=900, position=PLACE, size=0.8, casts_shadow=True),
    "area": Light(
        "area", energy=900, position=PLACE, direction=np.negative(PLACE), half_axes=AXES, is_round=True,
        casts_shadow=True,
    ),
}  # fmt: skip
#: Opposite corners of boxes.
CASTERS = {
    "standing": np.array([(-0.5, -0.6, 0.0), (0.5, 0.6, 1.0)]),
    "floating": np.array([(-0.5, -0.6, 0.5), (0.5, 0.6, 0.7)]),
    "high": np.array([(1.8, -0.65, 4.0), (2.4, -0.05, 4.2)]),
}


@pytest.fixture(scope="module")
def floor():
    return sampled((-6, -6, -0.2), (6, 6, 0), 160)


def beside(box: np.ndarray) -> np.ndarray:
    """(h, w) bool: pixels whose neighbours, and they themselves, show the floor."""
    wide = np.abs(PLACES[..., :2]) < box[1, :2] + 1.5 * WIDTH / SIZE
    return ~wide.all(axis=2)


@pytest.fixture
def error(render, floor):
    """error(name of a lamp, caster, samples) -> (h, w): by how much the arriving share of its light is too large."""

    def measure(name: str, caster: str, samples: int) -> np.ndarray:
        box, lamp = CASTERS[caster], LAMPS[name]
        if box[0, 2] > 1:  # its penumbrae would cover the picture
            lamp = replace(lamp, size=0.2 * lamp.size, half_axes=0.2 * np.asarray(lamp.half_axes))
        scene = Scene([sampled(*box, 48), floor], [lamp])
        settings = Settings(samples=samples, outputs=("color", "shadow"))
        drawn = render(scene, CAMERA, settings).shadow[..., 0]
        return np.where(beside(box), drawn - seen_share(lamp, box, PLACES), 0.0)

    return measure


def roughness(error: np.ndarray) -> float:
    """The root of the mean square of how far four neighbours of a pixel, together, differ from it four times."""
    bent = 4 * error[1:-1, 1:-1] - error[2:, 1:-1] - error[:-2, 1:-1] - error[1:-1, 2:] - error[1:-1, :-2]
    return float(np.sqrt((bent**2).mean()))


@pytest.mark.parametrize("caster", CASTERS)
@pytest.mark.parametrize("lamp", LAMPS)
def test_a_penumbra_is_what_rays_say_and_not_torn(lamp, caster, error):
    """It is 0.018 to 0.033 off, and 0.04 to 0.067 rough.

    A search of blockers in the cone of rays to the lamp alone misses some: 0.08 rough under the sun, 0.10 under the
    area lamp.
    """
    off = error(lamp, caster, samples=1)
    assert np.sqrt((off**2).mean()) < 0.038
    assert roughness(off) < 0.075


@pytest.mark.parametrize("lamp", ["sun", "area"])
def test_each_sample_of_a_picture_has_its_own_taps(lamp, error):
    """Otherwise a penumbra would wear the same hatch in each sample, and their mean would, too: 0.8 as rough."""
    assert roughness(error(lamp, "floating", samples=16)) < 0.5 * roughness(error(lamp, "floating", samples=1))


def test_a_caster_far_above_another_makes_nothing_brighter(render, floor):
    """The edge of the roof's shadow crosses the box's. 0.21 of the light is left there in the worst pixel; 0.41 if taps
    that meet the box count as light where the mean distance of box and roof says nothing about it."""
    lamp, near = replace(LAMPS["sun"], size=0.06), sampled(*CASTERS["standing"], 48)
    roof = sampled((-1, -0.56, 6.0), (9, 9, 6.2), 40)
    settings = Settings(outputs=("color", "shadow"))
    alone, under = (render(Scene([floor, *casters], [lamp]), CAMERA, settings).shadow[..., 0]
                    for casters in ((near,), (near, roof)))  # fmt: skip
    falls, is_dark = (alone > 0.9) & (under < 0.1), alone < 0.01
    assert falls.sum() > 200 and is_dark.sum() > 200
    assert under[is_dark].max() < 0.3
