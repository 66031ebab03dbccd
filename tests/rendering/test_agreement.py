# SPDX-License-Identifier: GPL-3.0-or-later
"""The same scene gives the same picture on every device and graphics backend, and it is the true picture.

The pictures that devices are compared by have every line of every shader.
"""

import numpy as np
import pytest
from scipy import ndimage

from splat_addon.reference import render_exact
from splat_addon.reference.metrics import psnr
from splat_addon.rendering import (
    EMPTY_DEPTH,
    Panorama,
    Settings,
    plan,
)
from splat_addon.rendering.methods import get_method
from splat_addon.rendering.plan.frame_plan import FILTER_MARGIN
from splat_addon.rendering.probes import pictures as probe_pictures
from splat_addon.rendering.sample_sums import may_add_up
from splat_addon.rendering.settings import OUTPUTS
from tests.rendering import shader_lines
from tests.rendering.agreement_scenes import SCENES
from tests.rendering.agreement_shots import SHOTS

TOLERANCE = 1e-4
ROUNDING = 1e-6

#: A normal is a sum brought to unit length: where front and back of a fold nearly cancel, that magnifies rounding.
NORMAL_TOLERANCE = 5e-4

#: A float16 sum is rounded at every splat, to one side or the other of what differs in the last digit of float32; of 1,
#: and of the value in highlights, which magnify it.
FLOAT16_TOLERANCE = 6e-3

#: The share of samples that may tie at a splat's rim or between two depths, and fall either way.
TIES = 1 / 20_000

#: Layers behind one another in the transparent spheres, peeled or in the last one.
SURFACES = 8

#: Splats at a pixel, each of which may tie with the depth that the nearest sprite hides beyond.
SPRITES = 4

#: Surfaces of glass that a ray to the eye or a lamp may cross, at the rim of each of which it may fall either way.
CROSSINGS = 10


@pytest.mark.parametrize("name", SHOTS)
def test_picture_is_the_same_on_every_device(name, render, on_both_devices, monkeypatch):
    # a quarter of the texels of what mirrors and glass see: drawing these takes most of the time of such a picture
    monkeypatch.setattr(probe_pictures, "SHARP_SIDE", probe_pictures.BLUNT_SIDE)
    scene, camera, settings, *_ = SHOTS[name]()

    def draw():
        frame = render(scene, camera, settings)
        arrays = {array: getattr(frame, array) for array in OUTPUTS if getattr(frame, array) is not None}
        if frame.cryptomatte is not None:
            arrays["cryptomatte"] = frame.cryptomatte.ranks(4)[..., 1]
        return {**arrays, "layers": np.array(frame.stats["layers"])}

    def hold(here, standalone):
        assert here.keys() == standalone.keys()
        described, has_layers = get_method(settings.method), here["layers"] > 0
        filters = described.filters_silhouettes
        samples = (
            SURFACES if has_layers else SPRITES if described.hides_within == "sprite" else 1
        )  # each of them may tie
        if settings.refraction:
            samples *= CROSSINGS * (1 + sum(light.casts_shadow for light in scene.lights))
        for array in here.keys() - {"layers"}:
            differs = are_apart(array, here, standalone, settings, has_layers)
            if array in ("color", "normal") and filters:
                differs = spots(differs)
            if array in PASSES:
                assert np.count_nonzero(differs) <= PASSES[array][filters], array
            else:
                assert_few(differs, samples)

    on_both_devices(draw, hold)


#: In how many pixels these may differ, without and with a filter, which takes a tie to neighbours.
PASSES = dict.fromkeys(("diffuse_color", "emission", "shadow", "overdraw"), (1, 4))
PASSES |= {"object_index": (1, 1), "material_index": (1, 1), "cryptomatte": (9, 9)}


def are_apart(array, here, standalone, settings, has_layers):
    """(h, w) bool: where an array of two devices differs by more than rounding."""
    is_rough = settings.sum_format == "float16"
    tolerance = FLOAT16_TOLERANCE if is_rough else TOLERANCE
    # filters average normals over neighbours too; layers multiply rounding errors, and filters add them up
    filters = get_method(settings.method).filters_silhouettes
    others = {"normal": max(tolerance, NORMAL_TOLERANCE), "depth": TOLERANCE, "cryptomatte": TOLERANCE}
    is_sum = has_layers or settings.as_printed  # coverage below the printed edge threshold is the sum of weights
    others |= {"coverage": TOLERANCE if is_sum else ROUNDING if filters else 0}
    brightness = np.maximum(standalone[array], 1) if is_rough and array == "color" else 1
    apart = np.abs(here[array] - standalone[array]) / brightness > others.get(array, tolerance)
    if array in ("depth", "position"):
        hit = (here["depth"] < EMPTY_DEPTH) & (standalone["depth"] < EMPTY_DEPTH)
        apart &= hit if apart.ndim == 2 else hit[..., None]
    return apart if apart.ndim == 2 else apart.any(axis=2)


#: A file that no other picture has: multisampled textures are not Blender's.
ELSEWHERE = {"lib/samples/mean.glsl"}


def test_pictures_that_devices_are_compared_by_have_every_line_of_the_shaders():
    drawn = set()
    for make in SHOTS.values():
        scene, camera, settings, *_ = make()
        if not isinstance(camera, Panorama):
            is_added_up = settings.samples > 1 and may_add_up(camera, camera.size, settings)
            drawn |= shader_lines.of_plan(plan(scene, camera, settings, is_added_up=is_added_up))
    assert sorted((file, line) for file, line in shader_lines.all_lines() - drawn if file not in ELSEWHERE) == []


@pytest.mark.parametrize("name", [name for name in SCENES if name != "shadows"])  # tests/rendering/test_shadows.py
def test_picture_is_the_exact_one(name, render):
    scene, camera = SCENES[name]()
    settings = Settings(method="quad", supersampling=2)
    frame, exact = render(scene, camera, settings), render_exact(scene, camera, settings, samples=2)
    tied = ties(frame.color, exact.color)
    assert_few(tied, samples=4)
    assert_few(frame.coverage != exact.coverage, samples=4)
    assert psnr(frame.color[~tied][None], exact.color[~tied][None]) > 95


def ties(picture, other, tolerance=TOLERANCE):
    """(h, w) bool: the pixels at which two pictures differ by more than the tolerance."""
    return np.abs(picture - other).max(axis=2) > tolerance


def spots(tied):
    """One pixel for each group of neighbours small enough to be the filtered image of one sample; larger groups
    unchanged.
    """
    labels, _ = ndimage.label(tied, np.ones((3, 3)))
    kept = np.zeros_like(tied)
    for number, (rows, columns) in enumerate(ndimage.find_objects(labels), 1):
        group = labels[rows, columns] == number
        is_one = max(group.shape) <= 2 * FILTER_MARGIN + 1
        kept[rows, columns][np.unravel_index(group.argmax(), group.shape) if is_one else group] = True
    return kept


def assert_few(tied, samples):
    """At most a counted handful of pixels are set; each has `samples` samples."""
    allowed = max(TIES * samples * tied.size, 1)
    count = np.count_nonzero(tied)
    assert count <= allowed, f"{count} of {tied.size} pixels differ, not at most {allowed:.0f}"
