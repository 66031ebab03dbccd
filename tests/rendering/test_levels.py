# SPDX-License-Identifier: GPL-3.0-or-later
"""Levels of detail draw the same picture with fewer splats; a tolerance of 0 draws all."""

from dataclasses import replace

import numpy as np
import pytest

from splat_addon.hierarchy.building import build_levels
from splat_addon.reference import scenes
from splat_addon.reference.metrics import psnr
from splat_addon.reference.triangles import render_triangles
from splat_addon.rendering import (
    Camera,
    Instance,
    Renderer,
    Scene,
    Settings,
    look_at,
)
from splat_addon.rendering.methods import METHODS
from splat_addon.rendering.upload.storages import STORAGES
from splat_addon.surfels import Surfels
from tests.rendering.level_scenes import EVERY, SIZE, SOME, far_torus, with_surfels

from .creased import angle_iron, clipped_iron
from .printed_sizes import HALVED, for_method


def rough():
    scene, camera = far_torus()
    return with_surfels(scene, roughness=lambda n: np.linspace(0.2, 0.8, n), metallic=lambda n: np.zeros(n)), camera


def parallel():
    scene, camera = far_torus()
    return scene, Camera.orthographic(camera.matrix_world, 3.0, SIZE, 0.1, 10)


def turned():
    """The scene mirrored, stretched and far from the origin."""
    scene, camera = far_torus()
    matrix = np.diag([-1, 1.2, 0.7, 1.0])
    moved = tuple(replace(i, matrix_world=matrix @ i.matrix_world) for i in scene.surfels)
    return replace(scene, surfels=moved), camera


def solid():
    scene, camera = scenes.sphere(32_000, SIZE)
    return replace(scene, surfels=tuple(replace(i, shape=i.surfels.as_solid()) for i in scene.surfels)), camera


def clipped():
    """Half of the surfels end at lines that cut almost nothing away; some of them are drawn individually."""
    scene, camera = far_torus(80_000, (48, 40))

    def lines(n):
        return np.stack([np.arange(n) * 7 % 65536 - 32768, np.arange(n) % 2 * 400], axis=1).astype(np.int16)

    return with_surfels(scene, clip_line=lines), camera


def split():
    """The part of the torus that is surfels: all but its nearest third."""
    scene, camera = far_torus()
    return replace(scene, surfels=tuple(replace(i, split_distance=3.2) for i in scene.surfels)), camera


@pytest.mark.parametrize("shot", [far_torus, rough, parallel, turned, solid, clipped], ids=lambda shot: shot.__name__)
def test_fewer_splats_draw_the_same_picture(shot, render):
    scene, camera = shot()
    every, some = (render(scene, camera, settings) for settings in (EVERY, SOME))
    assert every.stats["splats_drawn"] == every.stats["splats"] == some.stats["splats"]
    assert some.stats["splats_drawn"] < 0.3 * every.stats["splats"]
    # With a roughness per surfel, the length that mean normals lose adds to it. With clip lines, three pixels of the
    # hole's highlight, up to 8 times white, count as creases and are lit by two faces: 30.4 dB from the supersampled
    # picture with all surfels, 29.8 with these.
    assert psnr(some.color, every.color) > {rough: 35, clipped: 34}.get(shot, 37)
    inside = every.coverage > 0.999
    assert inside.sum() > 80 and some.coverage[inside].min() > 0.99


@pytest.mark.parametrize("storage", STORAGES)
def test_merged_surfels_end_at_straight_edges(storage, render):
    """One splat in 200 draws creases and outlines. Without lines of theirs, it is 37.9 dB from the picture of all."""
    scene, camera = clipped_iron((64, 64), 320)
    settings = Settings(shading="flat", transparent_film=True, storage=storage)
    every, some = (render(scene, camera, replace(settings, detail_tolerance=t)) for t in (0, 1))
    assert some.stats["splats_drawn"] < 0.006 * every.stats["splats_drawn"]
    assert psnr(some.color, every.color) > 46
    mesh = angle_iron()
    truth = render_triangles(mesh.positions[mesh.triangles], mesh.corner_colors[..., :3], camera).color
    assert psnr(some.color[..., :3], truth) > psnr(every.color[..., :3], truth) - 0.1


def test_merged_surfels_count_as_much_as_samples_beside_them(render):
    """Where red samples meet green ones, the border moves by 0.23 pixels if the green ones are merged, with splats of 3
    pixels. If their weights were those of samples, it would move by 0.4."""
    step, count = 0.02, 66
    y, x = (np.mgrid[:count, :count].reshape(2, -1) + 0.5) * step - count * step / 2
    fields = {name: np.tile(value, (count * count, 1)) for name, value in _FACING.items()}
    one = Surfels(positions=np.stack([x, y, 0 * x], 1), materials=np.zeros(count * count, int), **fields)
    red, green = (
        replace(half(one, x < 0 if is_red else x > 0), colors=np.tile(color, (count * count // 2, 1)))
        for is_red, color in ((True, (1.0, 0, 0, 1)), (False, (0, 1.0, 0, 1)))
    )
    camera = Camera.orthographic(look_at((0, 0, 5), (0, 0, 0)), 1.0, (32, 32), 0.1, 10)
    settings = Settings(shading="flat", detail_tolerance=0)
    merged = Instance(first_level(green), is_merged=True)
    assert len(merged.surfels) < 0.2 * len(green)
    every, some = (render(Scene((red, second)), camera, settings) for second in (green, merged))
    moved = (some.color[..., 1] - every.color[..., 1]).sum(axis=1)
    assert np.abs(moved).max() < 0.25


_FACING = {"rotations": (1.0, 0, 0, 0), "scales": (0.025, 0.025), "normals": (0, 0, 1.0), "colors": (1.0, 1, 1, 1)}


def half(surfels, are_in):
    return Surfels(**{name: array[are_in] for name, array in surfels.arrays().items()})


def first_level(surfels):
    """The merged surfels of the first level; surfels that it leaves are none."""
    nodes, _, levels, _ = build_levels(surfels)
    assert (levels[0].counts > 1).all()
    return half(nodes, levels[0].numbers - len(surfels))


@pytest.fixture(scope="module")
def plain_torus():
    """One set of surfels, whose hierarchy is built once, without shadows."""
    return scenes.torus(32_000, SIZE)


@pytest.mark.parametrize("method", METHODS)
def test_every_method_draws_them(method, plain_torus, render):
    scene, camera = plain_torus
    # surfels of twice the size merge as far at a higher tolerance
    merging = replace(SOME, detail_tolerance=1.5 * SOME.detail_tolerance) if method in HALVED else SOME
    every, some = (
        render(for_method(scene, method), camera, replace(settings, method=method)) for settings in (EVERY, merging)
    )
    assert some.stats["splats_drawn"] < 0.3 * every.stats["splats"]
    # without a filter a pixel shows one of many splats, now of fewer
    assert psnr(some.color, every.color) > (37 if METHODS[method].filters_silhouettes else 19)


def test_16_bit_storage_draws_the_same_splats(render):
    scene, camera = far_torus()
    exact, stored = (render(scene, camera, replace(SOME, storage=name)) for name in ("float32", "16-bit"))
    assert stored.stats["splats_drawn"] == exact.stats["splats_drawn"]
    assert psnr(stored.color, exact.color) > 50


def test_a_finer_tolerance_is_nearer_and_draws_more(render):
    scene, camera = far_torus(64_000)
    truth = render(scene, camera, EVERY).color
    frames = [render(scene, camera, replace(SOME, detail_tolerance=t)) for t in (0.75, 1.5, 3.0, 6.0)]
    assert np.all(np.diff([f.stats["splats_drawn"] for f in frames]) < 0)
    errors = [psnr(f.color, truth) for f in frames]
    assert errors[0] > errors[2] > errors[3]


def test_a_tolerance_of_0_is_the_picture_of_the_surfels_bit_by_bit(on_device):
    scene, camera = far_torus()

    def draw(device):
        renderer = Renderer(device)
        alone = renderer.render(scene, camera, EVERY)
        renderer.render(scene, camera, SOME)
        return alone, renderer.render(scene, camera, EVERY)

    alone, after = on_device(draw)
    for name in EVERY.outputs:
        np.testing.assert_array_equal(getattr(after, name), getattr(alone, name))


def test_surfels_that_had_levels_are_drawn_without_in_another_storage(render):
    """All data of one set is stored in one order."""
    scene, camera = far_torus()
    short = replace(EVERY, storage="16-bit")
    alone = render(scene, camera, short)
    render(scene, camera, SOME)
    assert psnr(render(scene, camera, short).color, alone.color) > 70


def test_what_merges_nothing_is_drawn_as_it_is(render):
    """All surfels are drawn individually, although they have a hierarchy."""
    scene, camera = far_torus()
    near = replace(camera, window=tuple(edge / 20 for edge in camera.window))
    render(scene, camera, SOME)
    every, some = (render(scene, near, settings) for settings in (EVERY, replace(SOME, detail_tolerance=1e-3)))
    assert psnr(some.color, every.color) > 90


def test_merged_surfels_as_small_as_a_pixel_do_not_protrude(render):
    scene, camera = far_torus(140_000, (64, 52))
    settings = replace(EVERY, transparent_film=True, shadow_resolution=0)
    every, some = (render(scene, camera, replace(settings, detail_tolerance=t)) for t in (0.0, 1.0))
    assert some.stats["splats_drawn"] < 0.2 * every.stats["splats_drawn"]
    protruding = (some.color[..., 3] - every.color[..., 3]).sum() / every.color[..., 3].sum()
    assert protruding < 0.004  # 0.007 in full size
