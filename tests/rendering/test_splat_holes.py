# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfels whose material cuts holes are drawn as often as they are opaque, and need no layers."""

from dataclasses import replace

import numpy as np
import pytest

from splat_addon.reference import render_exact
from splat_addon.rendering import Camera, Instance, Light, Material, Scene, Settings, look_at, plan
from splat_addon.surfels import Surfels

SIDE = 64
LEAF = Material(roughness=1.0, ior=1.0, cuts_holes=True)
SETTINGS = Settings(method="quad", shading="flat", samples=16, detail_tolerance=0.0)


def sheet(opacities, z=0.0, material=LEAF, half=1.0, **fields) -> Instance:
    """A square of 64 x 64 surfels that overlap like samples."""
    places = (np.arange(SIDE) + 0.5) * 2 / SIDE - 1
    x, y = (a.ravel() for a in np.meshgrid(places, places))
    count = len(x)
    surfels = Surfels(
        np.stack([half * x, half * y, np.full(count, z)], axis=1),
        np.tile((1.0, 0, 0, 0), (count, 1)),
        np.full((count, 2), 1.25 * 2 * half / SIDE),
        np.tile((0.0, 0, 1), (count, 1)),
        np.column_stack([np.full((count, 3), 0.5), np.broadcast_to(opacities, count)]),
        np.zeros(count, int),
    )
    return Instance(surfels, materials=(material,), **fields)


def view(pixels: int, width=1.0) -> Camera:
    return Camera.orthographic(look_at((0, 0, 5), (0, 0, 0), (0, 1, 0)), width, (pixels, pixels))


@pytest.mark.parametrize(("method", "pixels", "tolerance"), [("quad", 32, 0.0), ("mip", 16, 0.0), ("mip", 5, 1.0)])
@pytest.mark.parametrize("opacity", [0.2, 0.6])
def test_a_sheet_covers_as_much_as_it_is_opaque(method, pixels, tolerance, opacity, render):
    """The share is the same for surfels of a pixel, of less, and for merged ones."""
    settings = replace(SETTINGS, method=method, detail_tolerance=tolerance)
    frame = render(Scene([sheet(opacity)]), view(pixels), settings)
    assert frame.coverage.mean() == pytest.approx(opacity, abs=0.03)


@pytest.mark.parametrize(("method", "pixels", "tolerance"), [("quad", 32, 0.0), ("mip", 16, 0.0), ("mip", 5, 1.0)])
def test_splats_that_are_drawn_whole_do_not_make_leaves_larger(method, pixels, tolerance, render):
    """Stripes of eight surfels, of which every second is clear; within the others there are no gaps."""
    stripes = np.arange(SIDE * SIDE) % SIDE // 8 % 2
    settings = replace(SETTINGS, method=method, detail_tolerance=tolerance)
    frame = render(Scene([sheet(stripes)]), view(pixels), settings)
    assert frame.coverage.mean() == pytest.approx(0.5, abs=0.05)
    if tolerance == 0:
        assert frame.coverage.max() > 0.99


def test_the_exact_picture_blends_them(render):
    scene = Scene([sheet(0.6)])
    exact = render_exact(scene, view(8), SETTINGS, samples=2)
    assert exact.coverage.mean() == pytest.approx(0.6, abs=0.02)


@pytest.mark.parametrize("is_one", [True, False])
def test_sheets_behind_one_another_let_through_the_product(is_one, render):
    """The sheets are parts of one set of surfels, or objects that share one."""
    opacity, heights = 0.3, (0.0, -0.4, -0.8, -1.2)
    if is_one:
        sheets = [sheet(opacity, z) for z in heights]
        arrays = [one.surfels.arrays() for one in sheets]
        joined = Surfels(**{name: np.concatenate([own[name] for own in arrays]) for name in arrays[0]})
        sheets = [replace(sheets[0], shape=joined)]
    else:
        places = [np.eye(4) for _ in heights]
        for place, z in zip(places, heights, strict=True):
            place[2, 3] = z
        sheets = [replace(sheet(opacity), matrix_world=place) for place in places]
    frame = render(Scene(sheets), view(32), SETTINGS)
    assert 1 - frame.coverage.mean() == pytest.approx((1 - opacity) ** len(heights), abs=0.02)


def test_their_shadow_is_as_dark_as_they_are_opaque(render):
    sun = Light("sun", energy=np.pi, direction=(0, 0, -1), casts_shadow=True)
    floor = sheet(1.0, -1.0, replace(LEAF, cuts_holes=False), half=3.0)
    settings = replace(SETTINGS, shading="principled", samples=1)
    # pixels lie at different places between splats
    camera = Camera.orthographic(look_at((0, 0, -0.5), (0, 0, -1), (0, 1, 0)), 0.93, (32, 32), 0.05)
    lit, shaded = (render(Scene([floor, *over], [sun]), camera, settings).color[..., 0].mean()
                   for over in ((), (sheet(0.4),)))  # fmt: skip
    assert 1 - shaded / lit == pytest.approx(0.4, abs=0.04)


def test_only_other_transparent_surfels_need_layers():
    opacities = np.where(np.arange(SIDE * SIDE) % 2, 1.0, 0.5)
    leaf, glass = sheet(opacities), sheet(opacities, material=Material())
    mixed = replace(glass, materials=(Material(), LEAF))
    assert "splat_holes" in str(plan(Scene([leaf]), view(8), SETTINGS))
    assert not any(loop.name == "layers" for loop in plan(Scene([leaf]), view(8), SETTINGS).steps)
    assert "splat_holes" not in str(plan(Scene([sheet(1.0)]), view(8), SETTINGS))
    for other in (glass, mixed):
        made = plan(Scene([other]), view(8), SETTINGS)
        assert any(loop.name == "layers" for loop in made.steps) and "SPLAT_HOLES" not in str(made)
