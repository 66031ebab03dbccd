# SPDX-License-Identifier: GPL-3.0-or-later
"""Transparent layers agree with closed forms and with their definition (Guennebaud et al. 2006, section 6)."""

import math
from dataclasses import replace
from importlib import import_module

import numpy as np
import pytest

from splat_addon.reference import render_exact, scenes
from splat_addon.reference.metrics import psnr
from splat_addon.rendering import EMPTY_DEPTH, Camera, Instance, Light, Material, Scene, Settings, look_at, plan
from splat_addon.rendering.depth_range import clip_range
from splat_addon.rendering.methods import METHODS
from splat_addon.rendering.passes import decisions
from splat_addon.rendering.view import build_view
from splat_addon.surfels import Surfels

PEELING = [name for name, method in METHODS.items() if method.rasterizer != "point_sprite"]
SPACES = ["quad", "mip"]
CAMERA = Camera.perspective(look_at((0, 0, 4), (0, 0, 0), (0, 1, 0)), 0.5, (32, 32), 0.1, 50)
WORLD = (0.2, 0.4, 0.8)


def sheet(z: float, color, opacity: float, half: float = 3.0) -> Instance:
    """A square across the view, made of 16 x 16 overlapping discs."""
    axis = (np.arange(16) + 0.5) / 8 - 1
    x, y = (a.ravel() * half for a in np.meshgrid(axis, axis))
    up = np.tile((0.0, 0, 1), (256, 1))
    return Instance(
        Surfels(
            np.stack([x, y, np.full(256, z)], axis=1),
            np.tile((1.0, 0, 0, 0), (256, 1)),
            np.full((256, 2), half / 5),
            up,
            np.tile((*color, opacity), (256, 1)),
            np.zeros(256, int),
        )
    )


def flat(**choices) -> Settings:
    return Settings(**{"shading": "flat", "layers": 8, "blends_rest": False, **choices})


@pytest.mark.parametrize("method", PEELING)
def test_sheets_cover_what_is_behind_them_by_their_opacity(method, render):
    """Of a background b, k sheets of opacity a leave b (1 - a)^k; each sheet adds its share of what nearer ones let
    through.
    """
    opacity, colors = 0.4, ((1.0, 0, 0), (0, 1.0, 0), (0, 0, 1.0))
    scene = Scene([sheet(-z, c, opacity) for z, c in enumerate(colors)], world=WORLD)
    frame = render(scene, CAMERA, flat(method=method))
    let_through = (1 - opacity) ** np.arange(4)
    expected = let_through[3] * np.array(WORLD) + sum(
        opacity * t * np.array(c) for t, c in zip(let_through, colors, strict=False)
    )
    assert np.abs(frame.color - (*expected, 1)).max() < 1e-5
    assert frame.stats["layers"] == 3


@pytest.mark.parametrize("method", SPACES)
def test_what_is_opaque_hides_and_is_covered(method, render):
    red, wall, green = sheet(1, (1, 0, 0), 0.25), sheet(0, (0.5, 0.5, 0.5), 1.0), sheet(-1, (0, 1, 0), 0.5)
    frame = render(Scene([green, wall, red], world=WORLD), CAMERA, flat(method=method))
    assert np.abs(frame.color - (0.25 + 0.375, 0.375, 0.375, 1)).max() < 1e-5
    assert frame.stats["layers"] == 1


@pytest.mark.parametrize("method", SPACES)
def test_what_lies_behind_the_last_layer_is_lost(method, render):
    scene = Scene([sheet(-z, (1, 1, 1), 0.5) for z in range(4)])
    frame = render(scene, CAMERA, flat(method=method, layers=2, transparent_film=True))
    assert np.abs(frame.color - 0.75).max() < 1e-5


@pytest.mark.parametrize("method", SPACES)
def test_colours_of_little_opacity_count_for_little(method, render):
    """A red sheet whose left half is white but almost invisible stays red up to its middle."""
    red = sheet(0, (1, 0, 0), 0.5)
    colors = red.surfels.colors.copy()
    colors[red.surfels.positions[:, 0] < 0] = (1, 1, 1, 0.001)
    scene = Scene([replace(red, shape=replace(red.surfels, colors=colors))])
    frame = render(scene, CAMERA, flat(method=method, transparent_film=True))
    seen = frame.color[..., 3] > 0.1
    assert seen[:, 17:].all() and not seen[:, 0].any()
    assert (frame.color[seen][:, 1] < 0.01 * frame.color[seen][:, 0]).all()


@pytest.mark.parametrize("method", [m for m in PEELING if m != "homogeneous_printed"])  # which has no parallel cameras
def test_the_rest_hides_as_many_surfaces_as_there_are(method, render):
    """Before a parallel camera each of k even sheets has the same weight, so b (1 - a)^k remains with any number of
    layers.
    """
    camera = Camera.orthographic(CAMERA.matrix_world, 2.0, (16, 16), 0.1, 50)
    opacity, white = 0.3, (1.0, 1.0, 1.0)
    for layers in (2, 3, 4):
        scene = Scene([sheet(-z, white, opacity) for z in range(5)], world=(0.1, 0.2, 0.3))
        frame = render(scene, camera, flat(method=method, layers=layers, blends_rest=True))
        through = (1 - opacity) ** 5
        assert np.abs(frame.color - (*(1 - through + through * np.array((0.1, 0.2, 0.3))), 1)).max() < 1e-4
        assert frame.stats["layers"] == layers


@pytest.mark.parametrize("method", SPACES)
def test_as_printed_the_rest_hides_as_one_surface(method, render):
    """The surface has the mean opacity, weighted by opacity: sheets of 0.3 and 0.6 give 0.5."""
    camera = Camera.orthographic(CAMERA.matrix_world, 2.0, (16, 16), 0.1, 50)
    sheets = [sheet(-z, (1, 1, 1), opacity) for z, opacity in enumerate((0.5, 0.3, 0.6))]
    settings = flat(method=method, layers=2, blends_rest=True)
    hidden = {
        printed: render(Scene(sheets), camera, replace(settings, as_printed=printed)).color[..., 0]
        for printed in (True, False)
    }
    np.testing.assert_allclose(hidden[True], 1 - 0.5 * (1 - (0.3**2 + 0.6**2) / 0.9), atol=1e-4)
    np.testing.assert_allclose(hidden[False], 1 - 0.5 * 0.7 * 0.4, atol=1e-4)


@pytest.mark.parametrize("method", SPACES)
def test_the_rest_is_mixed_by_opacity_and_in_no_order(method, render):
    camera = Camera.orthographic(CAMERA.matrix_world, 2.0, (16, 16), 0.1, 50)
    sheets = [sheet(0, (1, 1, 1), 0.5), sheet(-1, (1, 0, 0), 0.6), sheet(-2, (0, 1, 0), 0.2), sheet(-3, (0, 0, 1), 1)]
    settings = flat(method=method, layers=2, blends_rest=True)
    frame = render(Scene(sheets), camera, settings)
    rest = 0.5 * (1 - 0.4 * 0.8)
    expected = 0.5 + np.array((rest * 0.75, rest * 0.25, 0.5 * 0.4 * 0.8))
    assert np.abs(frame.color[..., :3] - expected).max() < 1e-4
    assert np.abs(render(Scene(sheets[::-1]), camera, settings).color - frame.color).max() < 1e-6


@pytest.mark.parametrize("blend_depth", [None, 0.1])
@pytest.mark.parametrize("method", SPACES)
def test_backs_in_the_rest_count_as_fronts(method, blend_depth, render):
    camera = Camera.orthographic(CAMERA.matrix_world, 2.0, (16, 16), 0.1, 50)
    first, *rest = (sheet(-z, color, 0.5) for z, color in enumerate([(1, 1, 1), (1, 0, 0), (0, 1, 0)]))
    if blend_depth is not None:
        depths = np.full(256, blend_depth, np.float32)
        rest[1] = replace(rest[1], shape=replace(rest[1].surfels, blend_depth=depths))
    half_turn = np.diag((-1.0, 1, -1, 1))
    half_turn[2, 3] = 2 * rest[1].surfels.positions[0, 2]
    turned = replace(rest[1], matrix_world=half_turn)
    settings = flat(method=method, layers=2, blends_rest=True)
    fronts, backs = (render(Scene([first, rest[0], last]), camera, settings).color for last in (rest[1], turned))
    assert np.abs(backs - fronts).max() < 1e-4


@pytest.mark.parametrize("method", SPACES)
def test_three_layers_come_close_to_all(method, render):
    """As in figure 6 of the paper, the rest is estimated in the last layer or left out."""
    scene, camera = spheres(96)
    every, lost, blended = (
        render(scene, camera, Settings(method=method, layers=layers, blends_rest=blends)).color
        for layers, blends in ((24, False), (3, False), (3, True))
    )
    assert psnr(blended, every) > 40
    assert psnr(blended, every) > psnr(lost, every) + 3


@pytest.mark.parametrize("method", SPACES)
def test_splats_of_the_rest_are_lit_as_the_layers_are(method, render):
    """A sheet in the last layer has the same materials, emission, linked lights and shadows as a peeled one."""
    lamp = Light("point", (1, 0.9, 0.8), energy=300, position=(1, 1, 3), casts_shadow=True)
    lights = lamp, Light("sun", energy=1.0, direction=(0.3, 0, -1), receivers=(1,))
    nearer, *sheets = (sheet(-z, (0.8, 0.5, 0.3), 0.5) for z in range(3))
    own = {"roughness": np.full(256, 0.4), "metallic": np.full(256, 0.3), "emission": np.tile((0.1, 0.2, 0), (256, 1))}
    last = replace(sheets[1], shape=replace(sheets[1].surfels, **own), light_set=1)
    scene = Scene([nearer, last], lights, (0.1, 0.1, 0.1))
    camera = Camera.orthographic(CAMERA.matrix_world, 2.0, (24, 24), 0.1, 50)
    peeled, rest = (
        render(scene, camera, Settings(method=method, layers=2, blends_rest=blends)).color for blends in (False, True)
    )
    assert psnr(rest, peeled) > 45


def test_the_last_layer_needs_a_nearer_one():
    with pytest.raises(ValueError, match="layers must be 2 or more if the last one blends the rest"):
        Settings(layers=1)


def spheres(size):
    return scenes.transparent_spheres(count=600, size=(size, size))


@pytest.mark.parametrize("shading", ["flat", "principled"])
def test_picture_is_the_exact_one(shading, render):
    scene, camera = spheres(64)
    settings = Settings(method="quad", shading=shading, layers=32, blends_rest=False, supersampling=2)
    frame, exact = render(scene, camera, settings), render_exact(scene, camera, settings, samples=2)
    differs = np.abs(frame.color - exact.color).max(axis=2) > 1e-4
    # The more layers, the more places where two depths tie in float32.
    assert np.count_nonzero(differs) <= differs.size / 500
    assert psnr(frame.color[~differs][None], exact.color[~differs][None]) > 90
    assert np.count_nonzero((frame.depth < EMPTY_DEPTH) != (exact.depth < EMPTY_DEPTH)) <= 4


@pytest.mark.parametrize("blends_rest", [False, True])
@pytest.mark.parametrize("method", SPACES)
def test_a_transparent_film_composites_over_any_background(method, blends_rest, render):
    """Premultiplied edges have no rim: composited over a background, the picture equals one rendered with it."""
    scene, camera = spheres(48)
    choices = {"method": method, "layers": 4, "blends_rest": blends_rest}
    film = render(scene, camera, flat(**choices, transparent_film=True)).color
    for world in ((1, 1, 1), (0, 0, 0), (0.1, 0.8, 0.3)):
        whole = render(replace(scene, world=world), camera, flat(**choices)).color
        over = film[..., :3] + (1 - film[..., 3:]) * np.array(world)
        assert np.abs(over - whole[..., :3]).max() < 1e-5
        assert np.abs(whole[..., 3] - 1).max() < 1e-5
    assert (film[..., :3] <= film[..., 3:] + 1e-5).all()


@pytest.mark.parametrize("method", SPACES)
def test_depth_and_normal_are_of_the_first_surface_that_is_opaque_enough(method, render):
    scene = Scene([sheet(1, (1, 1, 1), 0.3), sheet(0, (1, 1, 1), 0.6), sheet(-1, (1, 1, 1), 1.0)])
    for threshold, depth in ((0.0, 3), (0.5, 4), (0.9, 5)):
        frame = render(scene, CAMERA, flat(method=method, alpha_threshold=threshold))
        assert np.abs(frame.depth - depth).max() < 1e-4
        assert np.abs(frame.normal - (0, 0, 1)).max() < 1e-4
        assert np.abs(frame.coverage - 1).max() < 1e-5


@pytest.mark.parametrize("method", SPACES)
def test_coverage_is_what_is_hidden(method, render):
    frame = render(Scene([sheet(0, (1, 1, 1), 0.3), sheet(1, (1, 1, 1), 0.3)]), CAMERA, flat(method=method))
    assert np.abs(frame.coverage - 0.51).max() < 1e-5
    assert (frame.depth == EMPTY_DEPTH).all()


@pytest.mark.parametrize(("storage", "sum_format"), [("16-bit", "float32"), ("float32", "float16")])
def test_smaller_formats_hold_layers(storage, sum_format, render):
    scene, camera = spheres(64)
    whole = render(scene, camera, Settings()).color
    small = render(scene, camera, Settings(storage=storage, sum_format=sum_format)).color
    assert psnr(small, whole) > 50


def test_far_and_near_layers_have_linear_depth(render):
    far = sheet(0, (0, 1, 0), 0.5, half=3e3)
    matrix = np.eye(4)
    matrix[2, 3] = -4000
    scene = Scene([sheet(3.9, (1, 0, 0), 0.5), replace(far, matrix_world=matrix)])
    camera = replace(CAMERA, far=1e4, near=1e-3)
    assert plan(scene, camera, Settings()).linear_depth
    for method in SPACES:
        frame = render(scene, camera, flat(method=method, transparent_film=True))
        assert np.abs(frame.color - (0.5, 0.25, 0, 0.75)).max() < 1e-5


def test_an_orthographic_camera_has_layers(render):
    camera = Camera.orthographic(CAMERA.matrix_world, 2.0, (16, 16), 0.1, 50)
    scene = Scene([sheet(-z, (1, 1, 1), 0.5) for z in range(3)])
    for method in SPACES:
        frame = render(scene, camera, flat(method=method, transparent_film=True))
        assert np.abs(frame.color - 0.875).max() < 1e-5


def test_tiles_hide_no_seam(render, monkeypatch):
    scene, camera = spheres(64)
    whole = render(scene, camera, Settings()).color
    monkeypatch.setattr(import_module("splat_addon.rendering.plan.tiles"), "MAX_TARGET_EDGE", 60)
    assert len(plan(scene, camera, Settings()).tiles) > 1
    differs = np.abs(render(scene, camera, Settings()).color - whole).max(axis=2)
    assert differs.max() < 1e-3 and np.count_nonzero(differs > 1e-4) <= 2  # pixels at which depths or weights tie


@pytest.mark.parametrize(("method", "edge"), zip(SPACES, (40, 60), strict=True))
def test_tiles_store_the_depths_of_the_whole(method, edge, render, monkeypatch):
    """A depth that ties with a layer's end is then in the same layer; only the rasterizer's rounding can differ."""
    scene, camera = scenes.transparent_spheres(count=600, size=(96, 96))
    settings = Settings(method=method, layers=8, blends_rest=False, supersampling=1)
    whole = render(scene, camera, settings).color
    monkeypatch.setattr(import_module("splat_addon.rendering.plan.tiles"), "MAX_TARGET_EDGE", edge)
    differs = np.abs(render(scene, camera, settings).color - whole).max(axis=2)
    # One sample that ties shows in as many pixels as the filter spreads it over.
    assert differs.max() < 0.01 and np.count_nonzero(differs > 1e-4) <= 3


def test_parts_of_a_picture_are_as_deep_as_the_whole():
    scene, camera = spheres(64)
    whole = build_view(scene.table, camera, 0.5)
    for part in (camera.cropped(0, 0, 9, 9), camera.cropped(50, 40, 8, 9)):
        own, common = (
            build_view(scene.table, part, 0.5),
            build_view(scene.table, part, 0.5, clip_range(scene.table, camera, 0.5)),
        )
        assert (own.first, own.far) != (whole.first, whole.far)
        assert (common.first, common.far, common.scale) == (whole.first, whole.far, whole.scale)
        assert common.least_offset(False) == whole.least_offset(False)
        np.testing.assert_array_equal(common.projection[2:], whole.projection[2:])


def test_multisampling_is_refused():
    scene, camera = spheres(16)
    with pytest.raises(ValueError, match="cannot be peeled with multisampling 4; set it to 0"):
        plan(scene, camera, Settings(method="quad", multisampling=4))


@pytest.mark.parametrize("settings", [{"method": "sprites_unfiltered"}, {"shading": "overdraw"}])
def test_what_cannot_peel_says_so(settings):
    scene, camera = spheres(16)
    made = plan(scene, camera, Settings(**settings))
    assert made.find(decisions.layers).count == 0
    assert "drawn opaque" in dict(made.skipped)["transparency"]


def test_nothing_of_an_opaque_scene_is_for_layers():
    scene, camera = scenes.sphere(count=100)
    made = plan(scene, camera, Settings())
    assert made.find(decisions.layers).count == 0 and not any("layer" in t or "peel" in t for t in made.textures)


def under_the_sun(*casters, **options) -> Scene:
    """A white floor across the view, and objects between it and the sun, which is behind the eye."""
    chalk = (Material(roughness=1.0, ior=1.0),)
    floor = replace(sheet(-1, (1, 1, 1), 1.0), materials=chalk)
    return Scene([floor, *casters], [Light("sun", energy=2.0, direction=(0.4, 0, -1), casts_shadow=True, **options)])


def half(opacity: float, z: float) -> Instance:
    """A sheet over the left half of the floor, at a height z below the eye."""
    made = sheet(z, (0, 0, 0), opacity)
    keep = made.surfels.positions[:, 0] < -0.2
    fields = {name: array[keep] for name, array in made.surfels.arrays().items()}
    return Instance(Surfels(**fields))


@pytest.mark.parametrize("size", [0.0, 0.05])
@pytest.mark.parametrize("opacities", [(0.25,), (0.5,), (0.8,), (0.5, 0.5), (0.25, 0.75), (0.5, 0.25, 0.5)])
def test_shadows_are_as_transparent_as_their_casters(opacities, size, render):
    """Each caster is outside the picture and lets its share of light through, within a sixteenth.

    Only pairs of masks are even, so a third sheet lets up to an eighth more or less through.
    """
    camera = Camera.orthographic(look_at((0.4, 0, -0.5), (0.4, 0, -1), (0, 1, 0)), 0.5, (24, 24), 0.05, 50)
    casters = [half(opacity, 1.0 + 0.3 * number) for number, opacity in enumerate(opacities)]
    settings = Settings(method="quad", shadow_resolution=512, blends_rest=False, layers=1)
    free, shaded = (render(under_the_sun(*c, size=size), camera, settings).color[..., 0] for c in ((), casters))
    through = math.prod(1 - opacity for opacity in opacities)
    share = (shaded / free)[:, :8]
    assert abs(share.mean() - through) < (0.035 if len(opacities) < 3 else 0.125)
    # hard shadows are even: the filter is as wide as the mask
    assert size or np.ptp(share) < 0.02


def test_opaque_casters_have_shadows_as_before():
    scene = under_the_sun(half(1.0, 1.0))
    made = plan(scene, CAMERA, Settings())
    assert made.find(decisions.shadows).maps and not made.has("SCREEN_DOOR")
    assert plan(under_the_sun(half(0.5, 1.0)), CAMERA, Settings()).has("SCREEN_DOOR")
    casts_none = under_the_sun(replace(half(0.5, 1.0), casts_shadow=False))
    assert not plan(casts_none, CAMERA, Settings()).has("SCREEN_DOOR")
