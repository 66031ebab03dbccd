# SPDX-License-Identifier: GPL-3.0-or-later
"""Penumbrae of transparent surfaces agree with the closed form of a straight edge in front of a round lamp."""

import math
from dataclasses import replace

import numpy as np
import pytest

from splat_addon.rendering import Camera, Instance, Light, Material, Scene, Settings, look_at, plan
from splat_addon.surfels import Surfels, concatenate

SETTINGS = Settings(method="quad", supersampling=1, shadow_resolution=512, blends_rest=False, layers=1)
SIZE, WIDTH = 64, 0.7
CAMERA = Camera.orthographic(look_at((0, 0, -0.5), (0, 0, -1), (0, 1, 0)), WIDTH, (SIZE, SIZE), 0.05, 50)
CHALK = (Material(roughness=1.0, ior=1.0),)
RADIUS, HEIGHT, TURN = 0.15, 1.5, 0.3  # radius of the discs, height above the floor, and rotation of the edge
#: The numbers of an object in the scene; each number has its own masks.
MASKS = range(5)


def discs(places, z: float, color, turn=0.0, **options) -> Instance:
    """An instance of discs at (n, 2) places that face along z."""
    count = len(places)
    c, s = math.cos(turn), math.sin(turn)
    positions = np.column_stack([places @ np.array([[c, s], [-s, c]]), np.full(count, z)])
    turns, up = np.tile((1.0, 0, 0, 0), (count, 1)), np.tile((0.0, 0, 1), (count, 1))
    colors = np.tile(color, (count, 1))
    return Instance(Surfels(positions, turns, np.full((count, 2), RADIUS), up, colors, np.zeros(count, int)), **options)


def grid(x, y) -> np.ndarray:
    return np.stack(np.meshgrid(x, y), axis=2).reshape(-1, 2)


FLOOR = discs(grid(np.arange(-1, 1, 0.15), np.arange(-1, 1, 0.15)), -1, (1, 1, 1, 1), materials=CHALK)


def casters(opacity: float, mask: int, edge: float) -> list[Instance]:
    """A sheet of discs, dense at its edge x = edge, in coordinates turned by TURN.

    `mask` objects come before it, so that it gets the mask of that number.
    """
    along = np.arange(-3, 3, 0.03)
    rows = grid([edge - RADIUS], along), grid(np.arange(edge - 3, edge - RADIUS, 0.15), along[::5])
    sheet = discs(np.concatenate(rows), HEIGHT - 1, (0, 0, 0, opacity), TURN)
    under_the_floor = discs(np.zeros((1, 2)), -2, (1, 1, 1, 1))
    return [*(mask * [under_the_floor]), sheet]


def wide_sun(size: float) -> Light:
    return Light("sun", energy=2.0, direction=(0, 0, -1), casts_shadow=True, size=size)


@pytest.fixture
def darkness(render):
    """darkness(casters, light) -> (h, w): the share of the light that does not reach the floor under the casters."""

    def measure(hanging, light, camera=CAMERA):
        shaded, free = (
            render(Scene([*some, FLOOR], [replace(light, casts_shadow=bool(some))]), camera, SETTINGS).color[..., 0]
            for some in (hanging, [])
        )
        return 1 - shaded / free

    return measure


def hidden_share(edge: float, size: float) -> np.ndarray:
    """(h, w): the share of the sun's disc behind the sheet's edge, seen from the floor.

    The shadow map has splats half a radius lower.
    """
    at = ((np.arange(SIZE) + 0.5) / SIZE - 0.5) * WIDTH
    across = at * math.cos(TURN) + at[:, None] * math.sin(TURN) - edge
    t = np.clip(across / (math.tan(size / 2) * (HEIGHT - RADIUS / 2)), -1, 1)
    return (np.arccos(t) - t * np.sqrt(1 - t * t)) / math.pi


@pytest.mark.parametrize("mask", MASKS)
@pytest.mark.parametrize(("size", "opacity"), [(0.04, 0.25), (0.04, 0.5), (0.04, 0.75), (0.16, 0.5)])
def test_a_penumbra_has_no_comb(size, opacity, mask, darkness):
    """It is as even as an opaque sheet's, whose errors are 0.022 (rms) and 0.09 (largest).

    With lookups whose pattern repeats that of the masks, they were 0.022 to 0.06 and 0.1 to 0.3.
    """
    expected = hidden_share(0.0, size)
    difference = np.abs(darkness(casters(opacity, mask, 0.0), wide_sun(size)) - opacity * expected)
    inside = (expected > 0) & (expected < 1)
    assert np.sqrt((difference[inside] ** 2).mean()) < 0.018
    assert difference.max() < 0.07


@pytest.mark.parametrize("opacities", [(0.5, 0.5), (0.25, 0.75)])
def test_sheets_behind_one_another_are_as_even_as_opaque_ones(opacities, darkness):
    """Unevenness is the curvature from pixel to pixel: 0.021 for opaque sheets and half of that here.

    With lookups whose pattern repeats that of the masks, it was 0.046.
    """
    lower, turned = np.eye(4), np.eye(4)
    lower[2, 3] = -0.9
    turned[:2, :2] = (math.cos(1.4), -math.sin(1.4)), (math.sin(1.4), math.cos(1.4))

    def unevenness(*opacities):
        places = zip(opacities, (lower, turned), strict=True)
        shown = darkness([replace(casters(o, 0, 0.0)[0], matrix_world=place) for o, place in places], wide_sun(0.4))
        bends = (np.diff(shown, 2, axis=axis) / math.sqrt(6) for axis in (0, 1))
        return max(np.sqrt((bend**2).mean()) for bend in bends)

    assert unevenness(*opacities) < 0.75 * unevenness(1.0, 1.0)


@pytest.mark.parametrize("mask", MASKS)
def test_masks_are_whole_beyond_the_maps_border(mask, darkness):
    """Two of the lamp's shadow maps meet in the picture, and lookups cross their border."""
    lamp = Light("point", energy=60, position=(-3, 0, 2), casts_shadow=True, size=0.3)
    assert np.abs(darkness(casters(0.25, mask, 1.0), lamp) - 0.25).max() < 1e-5


@pytest.mark.parametrize("opacity", [0.5, 1.0])
def test_a_part_of_the_picture_has_the_shadows_of_the_whole(opacity, darkness):
    """A sun's map is fitted to the picture, plus the distance from which a soft shadow may reach into it."""
    sheet, sun = casters(opacity, 0, 0.0), wide_sun(0.3)
    whole = darkness(sheet, sun)
    for x, y, side in ((0, 10, 40), (12, 20, 40)):
        part = darkness(sheet, sun, CAMERA.cropped(x, y, side, side))
        assert np.abs(part - whole[y : y + side, x : x + side]).mean() < 0.012 * opacity


def cut_out(blurred: float) -> Instance:
    """A sheet that is opaque, but half as opaque in the given share of it at its edge; and a clear one there."""
    sheet = casters(1.0, 0, 0.0)[0]
    opaque, count = sheet.surfels, len(sheet.surfels)
    colors = np.tile(np.float32((0, 0, 0, 1)), (count, 1))
    colors[np.argsort(-opaque.positions[:, 0])[: round(blurred * count)], 3] = 0.5
    clear = replace(opaque, positions=opaque.positions[::-1], colors=colors * np.float32((1, 1, 1, 0)))
    return replace(sheet, shape=concatenate([replace(opaque, colors=colors), clear]))


@pytest.mark.parametrize(("blurred", "is_averaged"), [(0.0, False), (0.2, False), (0.9, True)])
def test_only_what_is_neither_clear_nor_opaque_needs_many_taps(blurred, is_averaged):
    made = plan(Scene([cut_out(blurred), FLOOR], [wide_sun(0.1)]), CAMERA, SETTINGS)
    choices = [choice for p in made.passes for part in p.parts for choice in part.choices]
    assert made.has("SCREEN_DOOR") and (("shadow_taps", "masked") in choices) == is_averaged


@pytest.mark.parametrize("size", [0.04, 0.16])
def test_a_cut_out_has_the_shadow_of_its_opaque_part(size, darkness):
    """It is as near to the closed form as that of an opaque sheet."""
    expected = hidden_share(0.0, size)
    inside = (expected > 0) & (expected < 1)
    cut, opaque = (
        np.sqrt(((darkness(sheet, wide_sun(size)) - expected)[inside] ** 2).mean())
        for sheet in ([cut_out(0.0)], casters(1.0, 0, 0.0))
    )
    assert cut < 1.05 * opaque < 0.03
