# SPDX-License-Identifier: GPL-3.0-or-later
"""Textures cut holes into polygons, and the mean over samples equals blending."""

from dataclasses import replace

import numpy as np
import pytest
from scipy import ndimage

from splat_addon.images import Image
from splat_addon.reference import render_exact, scenes
from splat_addon.rendering import (
    Camera,
    Instance,
    Light,
    PolygonInstance,
    Scene,
    Settings,
    SurfaceTexture,
    look_at,
    make_polygons,
    plan,
)
from splat_addon.rendering.assembly import accumulation
from splat_addon.rendering.methods import METHODS
from splat_addon.rendering.plan.programs import composed

SIZE = (72, 72)
CORNERS = np.array([(-1.0, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0)])
HALVES = np.array([(0, 1, 2), (0, 2, 3)])
CAMERA = Camera.perspective(look_at((0.3, -2.6, 2.0), (0, 0, 0.2)), 0.75, SIZE)
GREEN, RED = (0.1, 0.8, 0.2), (0.9, 0.1, 0.1)


def soft(size=32) -> np.ndarray:
    """(size, size) alpha: 1 inside a disc, 0 outside, with a wide ramp between."""
    x, y = np.meshgrid(*2 * [(np.arange(size) + 0.5) / size - 0.5])
    return np.clip((0.45 - np.hypot(x, y)) / 0.3, 0, 1)


def hard(size=32) -> np.ndarray:
    return (soft(size) > 0.5).astype(float)


def card(alpha, under=(0.0, 0.0, 0.0), standing=0.6, tilt=0.9, **fields) -> PolygonInstance:
    """A green square above the floor with the transparency `alpha`. under: colour of fully transparent pixels."""
    pixels = np.where(alpha[..., None] > 0, GREEN, under)
    texture = SurfaceTexture(Image(np.concatenate([pixels, alpha[..., None]], axis=2), "EXTEND"), is_cut_out=True)
    uvs = (CORNERS[:, :2] / 2 + 0.5)[HALVES.ravel()]
    matrix = np.eye(4)
    matrix[1:3, 1:3] = [[np.cos(tilt), -np.sin(tilt)], [np.sin(tilt), np.cos(tilt)]]
    matrix[2, 3] = standing
    return PolygonInstance(make_polygons(CORNERS, HALVES, uvs=uvs), matrix, textures=(texture,), **fields)


def floor(color=(*RED, 1.0)) -> PolygonInstance:
    return PolygonInstance(make_polygons(9 * CORNERS, HALVES, color=color))


def averaged(render, scene, settings, count, camera=CAMERA):
    frames = (render(scene, accumulation.sample_camera(camera, number, count), settings) for number in range(count))
    return accumulation.mean_frame(map(accumulation.Summed, frames))


@pytest.mark.parametrize("method", ["quad", "mip"])
@pytest.mark.parametrize("camera", [CAMERA, Camera.orthographic(CAMERA.matrix_world, 2.4, SIZE)])
def test_the_mean_of_samples_is_what_blending_gives(method, camera, render):
    scene = Scene(polygons=(card(soft()), floor()))
    settings = Settings(method=method, shading="flat")
    mean = averaged(render, scene, settings, 32, camera)
    opaque, truth = Scene(polygons=(card(np.ones((32, 32))), floor())), Settings(shading="flat")
    is_card = ndimage.binary_erosion(render_exact(opaque, camera, truth, samples=1).color[..., 1] > 0.5, iterations=3)
    blended = render_exact(scene, camera, truth, samples=12).color
    assert is_card.sum() > 800
    error = np.abs(mean.color - blended)[is_card]
    # A hundredth of the colours' difference; independent thresholds would be off by a twentieth.
    assert error.mean() < 0.008 and error.max() < 0.16
    assert 0.3 < (blended[is_card][:, 1] - 0.1).mean() / 0.7 < 0.7


@pytest.mark.parametrize("is_one", [True, False])
def test_cards_behind_one_another_let_through_the_product(is_one, render):
    """The cards are of one object or of many, seen with one sample a pixel or 16, and in the exact picture."""
    camera, alpha, count = Camera.perspective(look_at((0, 0, 60), (0, 0, 0)), 0.02, (32, 32)), 0.4, 4
    one = card(np.full((8, 8), alpha), tilt=0.0)
    places = np.concatenate([CORNERS - (0, 0, k / 10) for k in range(count)])
    faces = np.concatenate([HALVES + 4 * k for k in range(count)])
    stacked = make_polygons(places, faces, uvs=np.tile((CORNERS[:, :2] / 2 + 0.5)[HALVES.ravel()], (count, 1)))
    lower = np.diag((1.0, 1, 1, 1)), np.diag((9.0, 9, 1, 1))
    lower[0][2, 3], lower[1][2, 3] = -0.1, -2
    cards = [replace(one, matrix_world=one.matrix_world + k * (lower[0] - np.eye(4))) for k in range(count)]
    of_cards = (replace(one, shape=stacked),) if is_one else tuple(cards)
    scene = Scene(polygons=(*of_cards, replace(floor(), matrix_world=lower[1])))
    expected = (1 - alpha) ** count
    for samples, spread in ((1, 0.4), (16, 0.1)):
        red = render(scene, camera, Settings(method="quad", shading="flat", samples=samples)).color[..., 0]
        through = (red - GREEN[0]) / (RED[0] - GREEN[0])
        assert through.mean() == pytest.approx(expected, abs=0.02) and through.std() < spread
    if is_one:
        red = render_exact(scene, camera, Settings(shading="flat"), samples=4).color[..., 0]
        assert (red.mean() - GREEN[0]) / (RED[0] - GREEN[0]) == pytest.approx(expected, abs=0.02)


@pytest.mark.parametrize("method", METHODS)
def test_every_sample_shows_the_card_or_what_is_behind(method, render):
    """Where splats are near, the visibility pass moves polygons back. Their holes must stay where they are."""
    place = np.diag((0.4, 0.4, 0.4, 1.0))
    place[2, 3] = 0.3
    ball = Instance(scenes.sphere(count=300)[0].surfels[0].surfels, place)
    scene = Scene((ball,), polygons=(card(soft(), standing=0.2), floor()))
    frame = render(scene, CAMERA, Settings(method=method, shading="flat"))
    assert (frame.coverage > 0.999).all()
    without = render(replace(scene, polygons=scene.polygons[1:]), CAMERA, Settings(method=method, shading="flat"))
    whole = render(replace(scene, polygons=(card(np.ones((8, 8)), standing=0.2), floor())), CAMERA,
                   Settings(method=method, shading="flat"))  # fmt: skip
    apart = np.minimum(*(np.abs(frame.color - other.color).max(axis=2) for other in (without, whole)))
    filtered = METHODS[method].filters_silhouettes
    assert np.count_nonzero(apart > 1e-3) <= (0.5 * apart.size if filtered else 40)
    assert np.abs(frame.color - without.color).max(axis=2).max() > 0.3


def test_colors_of_what_is_transparent_do_not_show(render):
    pictures = [
        render(Scene(polygons=(card(hard(), under), floor())), CAMERA, Settings(shading="flat")).color
        for under in ((0, 0, 0), (1, 1, 1), (9, 0, 9))
    ]
    assert np.array_equal(pictures[0], pictures[1]) and np.array_equal(pictures[0], pictures[2])
    # Between the card's green and the floor's red no channel is darker than both.
    assert (pictures[0][..., :3] > np.minimum(GREEN, RED) - 1e-4).all()


def test_shadows_have_holes(render):
    sun = Light("sun", (1, 1, 1), 3.0, direction=(0.2, 0.3, -1))
    scene = Scene(polygons=(card(hard(), standing=1.0, tilt=0.3), floor()), lights=(sun,), world=(0.2, 0.2, 0.2))
    settings = Settings(method="quad", supersampling=2)
    frame, exact = render(scene, CAMERA, settings).color, render_exact(scene, CAMERA, settings, samples=4).color
    opaque = replace(scene, polygons=(card(np.ones((8, 8)), standing=1.0, tilt=0.3), floor()))
    dark = render(opaque, CAMERA, settings).color
    assert np.abs(frame - exact).mean() < 0.006
    assert np.abs(dark - exact).mean() > 0.05


def test_a_holdout_has_holes(render):
    shown = Scene(polygons=(card(hard()), floor()))
    cut = replace(shown, polygons=(replace(shown.polygons[0], is_holdout=True), floor()))
    frame, seen = (render(scene, CAMERA, Settings(method="quad", shading="flat")) for scene in (cut, shown))
    is_green = seen.color[..., 1] > 0.5
    assert 500 < is_green.sum() < is_green.size
    assert np.array_equal(frame.coverage == 0, is_green)


def test_indices_are_of_what_is_seen(render):
    scene = Scene(polygons=(replace(card(hard()), index=3), replace(floor(), index=5)))
    outputs = ("color", "object_index")
    frame = render(scene, CAMERA, Settings(method="quad", shading="flat", outputs=outputs))
    assert np.array_equal(frame.object_index == 3, frame.color[..., 1] > 0.5)


def test_leaves_keep_their_area_far_away(render):
    """Leaves cover a tenth of the image. At a few pixels' size a fixed threshold would leave nothing of them."""
    alpha = np.zeros((64, 64))
    alpha[::10] = 1
    camera = Camera.perspective(look_at((0, 0, 60), (0, 0, 0)), 0.75, SIZE)
    settings = Settings(method="quad", shading="flat")
    cards = [card(alpha, tilt=0.0), card(np.ones((8, 8)), tilt=0.0)]
    shown, whole = (averaged(render, Scene(polygons=(one,)), settings, 64, camera).color[..., 1].sum() for one in cards)
    assert shown / whole == pytest.approx(alpha.mean(), rel=0.15)


def test_a_texture_without_holes_costs_nothing():
    """Alpha is used only for textures marked as cut-outs; all other polygons use the same programs as without any."""
    cut = Scene(polygons=(card(soft()), floor()))
    texture = replace(cut.polygons[0].textures[0], is_cut_out=False)
    whole = replace(cut, polygons=(replace(cut.polygons[0], textures=(texture,)), floor()))
    plans = [plan(scene, CAMERA, Settings()) for scene in (whole, cut)]
    hosts = {"visibility": ("polygon_visibility.vert", "polygons"), "polygons": ("polygons.vert", "textured")}
    for name, (vertex, variant) in hosts.items():
        passes = [next(p for p in made.passes if p.name == name) for made in plans]
        texts = [composed(made, p, vertex, variant) for made, p in zip(plans, passes, strict=True)]
        assert texts[0] == texts[1] and "cut_outs" not in "".join(texts[0])
        assert "cut_outs_keep();" in composed(plans[1], passes[1], vertex, variant, "cut_out")[1]
