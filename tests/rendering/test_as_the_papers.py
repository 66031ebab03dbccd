# SPDX-License-Identifier: GPL-3.0-or-later
"""Settings that reproduce the papers: splats lit one by one, and backs left out or drawn as fronts.

Each gives what the reference gives, and the plan has nothing of it by default.
"""

from dataclasses import replace

import numpy as np
import pytest

from splat_addon.reference import render_exact, scenes
from splat_addon.reference.extremes import discs
from splat_addon.reference.metrics import psnr
from splat_addon.rendering import Camera, Light, Material, PolygonInstance, Scene, Settings, make_polygons, plan
from splat_addon.rendering.methods import METHODS

SIZE = (96, 96)
QUADS = Settings(method="quad", shading="phong", supersampling=1, shadow_resolution=0)
ASKED = {"lit splats": {"lights_splats": True}, "culled": {"culls_backs": True}, "as printed": {"as_printed": True}}


def torus():
    scene, camera = scenes.torus(6_000, SIZE)
    return replace(scene, lights=(Light("sun", energy=3.0, direction=(1, -0.5, -1)),)), camera


@pytest.mark.parametrize("shading", ["phong", "principled", "toon", "ramp", "normals"])
@pytest.mark.parametrize("asked", ASKED)
def test_the_picture_is_the_references(asked, shading, render):
    settings = replace(QUADS, shading=shading, **ASKED[asked])
    frame, truth = render(*torus(), settings), render_exact(*torus(), settings, samples=1)
    tied = np.abs(frame.color - truth.color).max(axis=2) > 1e-3
    assert np.count_nonzero(tied) <= 4
    assert psnr(frame.color[~tied][None], truth.color[~tied][None]) > 90


def test_each_changes_the_picture(render):
    """The torus is open, so that settings about backs have a visible effect."""
    before = render(*torus(), QUADS).color
    for asked in ASKED.values():
        assert np.abs(render(*torus(), replace(QUADS, **asked)).color - before).max() > 1e-3, asked


def hybrid():
    """A ball of splats of two materials half of which lies on polygons of its surface, before polygons of two more:
    some glow, and are in the light of one lamp alone."""
    scene, camera = scenes.polygons(size=SIZE)
    (ball,), (floor, other) = scene.surfels, scene.polygons
    near = PolygonInstance(scenes.round_polygons(24), materials=(Material(roughness=0.6, emission=(0.1, 0, 0.2)),))
    half = {name: array[ball.surfels.positions[:, 0] < 0.1] for name, array in ball.surfels.arrays().items()}
    half["roughness"] = np.where(half["positions"][:, 2] > 0, 0.3, 0.9).astype(np.float32)
    lights = Light("sun", energy=2.0, direction=(0.5, 1, -1)), Light("sun", energy=3.0, receivers=(1,))
    surfels = (replace(ball, shape=replace(ball.surfels, **half), light_set=1),)
    polygons = floor, replace(other, light_set=1), near
    return replace(scene, surfels=surfels, polygons=polygons, lights=lights, world=(0.1, 0.2, 0.3)), camera


@pytest.mark.parametrize("method", ["quad", "mip"])
def test_as_printed_splats_are_blended_with_polygons_whatever_their_normals(method, render):
    """Guennebaud et al. 2006, section 5.1, "if and only if the pixel is covered by a polygon": here the splat's plane
    is a little behind the polygon's, within epsilon, and its shading normal points elsewhere."""
    normal = np.array((1.0, 0.0, 0.2)) / np.hypot(1, 0.2)
    splat = discs((0, 0, -3.01), (0.6, 0, 0), (0, 0.6, 0), (1, 0, 0), normals=normal)
    corners = np.array([[(-1, -1, -3), (1, -1, -3), (0, 1.5, -3)]], np.float64)
    board = make_polygons(corners[0], np.array([[0, 1, 2]]), color=(0, 1, 0, 1))
    scene = Scene((splat,), polygons=(PolygonInstance(board),))
    camera = Camera.perspective(np.eye(4), 0.6, (32, 32), 0.01, 100)
    for as_printed in (False, True):
        settings = replace(QUADS, method=method, shading="flat", as_printed=as_printed)
        color = render(scene, camera, settings).color[16, 16]
        np.testing.assert_allclose(color, render_exact(scene, camera, settings, samples=1).color[16, 16], atol=0.05)
        assert (color[0] > 0.9) == as_printed


def splat_on_board():
    """A splat whose shading normal leans, on a green board, under a sun."""
    normal = np.array((0.6, 0.0, 0.8))
    splat = discs((0, 0, -3.01), (0.6, 0, 0), (0, 0.6, 0), (1, 0.2, 0), normals=normal)
    corners = np.array([(-9, -9, -3), (9, -9, -3), (0, 9, -3)], np.float64)
    board = make_polygons(corners, np.array([[0, 1, 2]]), color=(0, 1, 0, 1))
    lights = (Light("sun", energy=3.0, direction=(-0.7, 0.1, -1)),)
    return Scene((splat,), lights, polygons=(PolygonInstance(board),)), Camera.perspective(np.eye(4), 0.6, (32, 32))


@pytest.mark.parametrize("method", ["quad", "mip"])
@pytest.mark.parametrize("shading", ["phong", "toon"])
def test_as_printed_the_shaded_colours_of_splats_and_polygons_are_blended(shading, method, render):
    """Guennebaud et al. 2006, section 5.1: "the sum of weights of the splatting is clamped to [0, 1] and used to
    linearly blend the colors", each of which is shaded once. The weight is exp(-2 rho^2); beside the picture of a mean
    of both normals, where a toon's step lies elsewhere, that makes a difference."""
    (scene, camera), settings = splat_on_board(), replace(QUADS, method=method, shading=shading, as_printed=True)
    at = (np.arange(32) + 0.5 - 16) / 16 * np.tan(0.3) * 3.01 / 0.6
    rho2 = at[:, None] ** 2 + at**2
    weight, inside = np.exp(-2 * rho2), rho2 < 0.8
    alone = replace(scene, polygons=()), replace(scene, surfels=())
    splat, board = (render(one, camera, settings).color[..., :3] for one in alone)
    both = render(scene, camera, settings).color[..., :3]
    expected = weight[..., None] * splat + (1 - weight[..., None]) * board
    tolerance = 2e-4 if method == "quad" else 0.03  # mip filters the kernel
    np.testing.assert_allclose(both[inside], expected[inside], atol=tolerance)
    attributes = render(scene, camera, replace(settings, as_printed=False)).color[..., :3]
    assert np.abs(attributes - expected)[inside].max() > 0.05


@pytest.mark.parametrize("shading", ["phong", "principled", "toon", "ramp"])
def test_as_printed_the_blended_picture_is_the_references(shading, render):
    settings = replace(QUADS, shading=shading, as_printed=True)
    frame, truth = render(*hybrid(), settings), render_exact(*hybrid(), settings, samples=1)
    tied = np.abs(frame.color - truth.color).max(axis=2) > 1e-3
    assert np.count_nonzero(tied) <= 8
    assert psnr(frame.color[~tied][None], truth.color[~tied][None]) > 75


@pytest.mark.parametrize("shading", ["phong", "principled", "toon", "ramp", "normals"])
def test_lit_splats_are_blended_with_lit_polygons(shading, render):
    """Guennebaud et al. 2006, section 5.1: shaded colours, where attributes are blended otherwise."""
    settings = replace(QUADS, shading=shading, lights_splats=True)
    frame, truth = render(*hybrid(), settings), render_exact(*hybrid(), settings, samples=1)
    tied = np.abs(frame.color - truth.color).max(axis=2) > 1e-3
    assert np.count_nonzero(tied) <= 8
    assert psnr(frame.color[~tied][None], truth.color[~tied][None]) > 75
    attributes = render(*hybrid(), replace(settings, lights_splats=False))
    assert (np.abs(attributes.color - frame.color).max() > 0.01) == (shading != "normals")
    assert np.abs(attributes.normal - frame.normal).max() < 1e-3
    assert np.array_equal(attributes.depth, frame.depth)


@pytest.mark.parametrize("method", METHODS)
def test_lit_splats_of_one_normal_are_what_lit_samples_are(method, render):
    """Under a sun, all splats of a wall have the same colour with every method."""
    x, y = (a.reshape(-1, 1) for a in np.meshgrid(np.arange(-1, 1.01, 0.1), np.arange(-1, 1.01, 0.1)))
    tilted = np.array((0.8, 0, 0.6)) * 0.15
    wall = discs(x * (0.8, 0, 0.6) + y * (0, 1, 0) + (0, 0, -3), tilted, (0, 0.15, 0), (0.8, 0.4, 0.2))
    scene = Scene((wall,), (Light("sun", energy=2.0, direction=(0.1, 0.2, -1)),), (0.1, 0.1, 0.1))
    camera = Camera.perspective(np.eye(4), 0.6, SIZE, 0.01, 100)
    settings = replace(QUADS, method=method, shading="toon")
    one, other = (render(scene, camera, replace(settings, lights_splats=lit)).color for lit in (False, True))
    assert one[..., :3].max() > 0.2
    np.testing.assert_allclose(other, one, atol=2e-3)


def test_backs_that_are_left_out_are_counted(render):
    scene, camera = torus()
    frame = render(scene, camera, replace(QUADS, culls_backs=True))
    exact = sum(instance.backs(camera) for instance in scene.surfels)
    assert frame.stats["culled"] == exact
    assert frame.stats["culled_of"] == sum(len(i.surfels) for i in scene.surfels)
    assert 0.3 < exact / frame.stats["culled_of"] < 0.7
    assert "BACK_CULLING" in str(plan(scene, camera, replace(QUADS, culls_backs=True)))


def test_nothing_of_it_is_there_where_nobody_asks():
    made = plan(*torus(), QUADS)
    assert {"lit_splats", "back_culling"}.isdisjoint(part.feature for p in made.passes for part in p.parts)
    assert "lit_splats" not in made.textures


def test_what_lit_splats_cannot_give_is_refused():
    with pytest.raises(ValueError, match="provide no diffuse_color"):
        replace(QUADS, lights_splats=True, outputs=("color", "diffuse_color"))
