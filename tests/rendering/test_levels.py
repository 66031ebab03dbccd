# SPDX-License-Identifier: GPL-3.0-or-later
"""Levels of detail draw the same picture with fewer splats; a tolerance of 0 draws all, a still view uploads
nothing.
"""

from dataclasses import replace
from importlib import import_module
from weakref import WeakSet

import numpy as np
import pytest

from splat_addon.hierarchy.building import build_levels
from splat_addon.reference import scenes
from splat_addon.reference.metrics import psnr
from splat_addon.reference.triangles import render_triangles
from splat_addon.rendering import (
    Camera,
    Equirectangular,
    Instance,
    Light,
    Panorama,
    Renderer,
    Scene,
    Settings,
    look_at,
    plan,
)
from splat_addon.rendering.detail.hierarchies import LEAST_SURFELS, hierarchy_before, hierarchy_of, replaced
from splat_addon.rendering.detail.history import history
from splat_addon.rendering.methods import METHODS
from splat_addon.rendering.passes.decisions import merging, shadows
from splat_addon.rendering.plan import cut_choice
from splat_addon.rendering.upload.storages import STORAGES
from splat_addon.sampling import TriangleMesh
from splat_addon.surfels import Surfels
from tests.plain import sample_mesh

from .creased import angle_iron, clipped_iron
from .printed_sizes import HALVED, for_method

SIZE = (32, 26)
EVERY = Settings(detail_tolerance=0.0, outputs=("color", "depth", "normal", "coverage"))
SOME = replace(EVERY, detail_tolerance=0.8)


def far_torus(count=32_000, size=SIZE):
    """Some twenty surfels per pixel, under a sun and a lamp that cast shadows."""
    scene, camera = scenes.torus(count, size)
    return replace(scene, lights=tuple(replace(light, casts_shadow=True) for light in scene.lights)), camera


def with_surfels(scene, **fields):
    """The scene with other fields for all surfels. fields: name -> function from a number of surfels to an array."""
    changed = (
        replace(i, shape=replace(i.surfels, **{n: of(len(i.surfels)) for n, of in fields.items()}))
        for i in scene.surfels
    )
    return replace(scene, surfels=tuple(changed))


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


def test_a_still_view_uploads_nothing_and_a_moved_one_its_cuts_if_they_are_others(on_device):
    scene, camera = far_torus()
    aside, away = np.eye(4), np.eye(4)
    aside[0, 3], away[2, 3] = 0.05, 1.0
    aside, away = (replace(camera, matrix_world=camera.matrix_world @ shift) for shift in (aside, away))

    def draw(device):
        renderer, uploads = Renderer(device), []
        for view in (camera, camera, aside, away, away):
            before = renderer.resources.cuts.uploads
            renderer.render(scene, view, replace(SOME, shadow_resolution=0))
            uploads.append(renderer.resources.cuts.uploads - before)
        return uploads

    assert on_device(draw) == [2, 0, 0, 2, 0]


LAMPS = {
    "sun": (Light("sun", direction=(-0.5, 0.6, -0.8), casts_shadow=True), 1),
    "lamp amid": (Light("point", energy=100, position=(0.9, -0.7, 0.9), casts_shadow=True), None),
}


@pytest.mark.parametrize("name", LAMPS)
def test_each_shadow_map_has_a_cut_of_its_own(name, on_device):
    """There is one cut for each visible instance and each shadow map or camera; a still view and more samples
    add none.
    """
    scene, camera = far_torus()
    light, maps = LAMPS[name]
    scene = replace(scene, lights=(light,))

    def draw(device):
        renderer, uploads, frames = Renderer(device), [], []
        for samples in (1, 1, 4):
            before = renderer.resources.cuts.uploads
            frames.append(renderer.render(scene, camera, replace(SOME, samples=samples, shadow_resolution=64)))
            uploads.append(renderer.resources.cuts.uploads - before)
        return uploads, frames[0].stats["plan"].find(shadows).maps

    uploads, made = on_device(draw)
    assert len(made) == maps or 1 < len(made) <= 6
    assert 2 + len(made) <= uploads[0] <= 2 + 2 * len(made)
    assert uploads[1:] == [0, 0]


def test_each_view_of_an_object_is_compared_with_its_hierarchy_once(render, monkeypatch):
    """However many passes draw it: of a small object, comparing takes longer than drawing."""
    scene, camera = far_torus()
    scene, seen = replace(scene, lights=LAMPS["sun"][:1]), []
    compared = cut_choice.sight
    monkeypatch.setattr(cut_choice, "sight", lambda *of: seen.append(of[:2]) or compared(*of))
    frame = render(scene, camera, replace(SOME, shadow_resolution=64))
    assert len(frame.stats["plan"].find(merging)) == 2
    assert len(seen) == len(set(seen)) == 2 * 2


def test_the_faces_of_a_panorama_have_cuts_of_their_own(on_device):
    scene, camera = far_torus()
    panorama = Panorama(camera.matrix_world, Equirectangular(), (64, 32), near=0.01)
    settings = replace(SOME, outputs=("color",), shadow_resolution=0)

    def draw(device):
        renderer, uploads, frames = Renderer(device), [], []
        for tolerance in (1.5, 1.5, 0.0):
            before = renderer.resources.cuts.uploads
            frames.append(renderer.render(scene, panorama, replace(settings, detail_tolerance=tolerance)))
            uploads.append(renderer.resources.cuts.uploads - before)
        return uploads, frames

    uploads, frames = on_device(draw)
    assert uploads[0] >= 2 and uploads[1:] == [0, 0]
    assert psnr(frames[1].color, frames[2].color) > 37


@pytest.mark.parametrize("resolution", [128, 512, 2048])
@pytest.mark.parametrize("tolerance", [1.25, 2.5])
def test_what_is_merged_casts_no_shadow_on_itself(tolerance, resolution, render):
    """The camera and the shadow map draw different levels, either of which may be coarser.

    They never differ so much that a lit surface shadows itself.
    """
    scene, camera = far_torus()
    light = replace(LAMPS["sun"][0], direction=tuple(camera.matrix_world[:3, :3] @ (0.2, -0.3, -1)))
    scene = replace(scene, lights=(light,))
    every = replace(EVERY, shadow_resolution=resolution, outputs=("color", "depth", "normal", "coverage", "shadow"))
    truth, some = (render(scene, camera, replace(every, detail_tolerance=t)) for t in (0.0, tolerance))
    inside = truth.coverage > 0.999
    falsely = inside & (truth.shadow[..., 0] > 0.999) & (some.shadow[..., 0] < 0.5)
    lost = inside & (truth.shadow[..., 0] < 0.001) & (some.shadow[..., 0] > 0.5)
    assert some.stats["splats_drawn"] < 0.5 * truth.stats["splats_drawn"] and inside.sum() > 80
    # a shadow's edge may move by the tolerance
    assert not falsely.any() and lost.sum() <= 0.02 * inside.sum()


def test_colors_make_no_shadow_map_finer(render):
    """A ball beside the picture casts the same shadow, to the bit, whatever its surfels' colours are."""
    ball = scenes.sphere(32_000, SIZE)[0].surfels[0].surfels
    colors = np.array(ball.colors)
    colors[:, :3] = np.random.default_rng(0).uniform(0, 1, (len(ball), 3))
    plane = TriangleMesh([(0, -3, 0), (6, -3, 0), (6, 3, 0), (0, 3, 0)], [(0, 1, 2), (0, 2, 3)])
    above = np.eye(4)
    above[2, 3] = 2.0
    floor = Instance(sample_mesh(plane, resolution=40), np.eye(4))
    sun = Light("sun", energy=3, direction=(1, 0, -0.7), casts_shadow=True)
    camera = Camera.orthographic(look_at((3, 0, 9), (3, 0, 0), (0, 1, 0)), 4.0, SIZE, 0.1, 20)
    settings = replace(SOME, shadow_resolution=64, outputs=("shadow",))
    grey, colored = (
        render(Scene((floor, Instance(caster, above)), (sun,)), camera, settings).shadow
        for caster in (ball, replace(ball, colors=colors))
    )
    assert 0.1 < grey.mean() < 0.9
    assert np.array_equal(grey, colored)


def test_parts_of_a_picture_are_drawn_with_the_whole_s_levels(render, monkeypatch):
    scene, camera = far_torus()
    whole = render(scene, camera, SOME)
    monkeypatch.setattr(import_module("splat_addon.rendering.plan.tiles"), "MAX_TARGET_EDGE", 48)
    tiles = render(scene, camera, SOME)
    assert len(tiles.stats["plan"].tiles) > 1
    assert psnr(tiles.color, whole.color) > 70


def test_surfels_that_are_few_or_lit_by_themselves_are_all_drawn():
    scene, camera = far_torus()
    few, _ = far_torus(LEAST_SURFELS // 2)
    assert plan(scene, camera, SOME).has("LEVELS")
    lit = replace(SOME, lights_splats=True)
    for other, settings in ((few, SOME), (scene, EVERY), (scene, lit)):
        made = plan(other, camera, settings)
        assert not made.has("LEVELS") and "levels of detail" in dict(made.skipped)
        assert not any("drawn_splats" in part.inputs for p in made.passes for part in p.parts)


def next_frame(scene):
    """The scene in the next frame, in which its surfels have moved by different lengths."""
    moved = []
    for instance in scene.surfels:
        x, y, z = instance.surfels.positions.T
        bent = replace(instance.surfels, positions=np.stack([x + 0.1 * z, y, z], axis=1))
        replaced(instance.surfels, bent)
        moved.append(replace(instance, shape=bent))
    return replace(scene, surfels=tuple(moved))


def built(scene):
    return [hierarchy_of(instance.surfels) for instance in scene.surfels]


@pytest.mark.parametrize("has_hierarchy", [True, False])
def test_surfels_that_move_in_each_frame_are_merged_if_its_samples_pay_for_it(has_hierarchy):
    scene, camera = far_torus()
    if has_hierarchy:
        built(scene)
    bent = next_frame(scene)
    near = replace(camera, window=tuple(edge / 20 for edge in camera.window))

    def are_merged(seen, in_all, **options):
        settings = replace(SOME, samples=in_all)
        return plan(bent, seen, settings, history=history(bent, WeakSet()), **options).has("LEVELS")

    assert [are_merged(camera, n) for n in (1, 16)] == [False, True]
    assert not are_merged(near, 16)
    # of 16 samples of an open shutter, one may be all that show this moment
    assert not are_merged(camera, 16, samples=1)
    # three samples pay for fitting, and not for building
    assert are_merged(camera, 3) == has_hierarchy


@pytest.mark.parametrize("may_change", [True, False])
def test_what_was_drawn_before_does_not_count_in_repeatable_pictures(may_change):
    """Frames of a farm must not depend on which machine drew the ones before."""

    def of(scene):
        return replace(scene, surfels=tuple(replace(each, may_change=may_change) for each in scene.surfels))

    def are_merged(scene):
        return [plan(scene, camera, replace(SOME, samples=n)).has("LEVELS") for n in (1, 16)]

    scene, camera = far_torus()
    near = replace(camera, window=tuple(edge / 20 for edge in camera.window))
    expected = [not may_change, True]
    assert are_merged(of(scene)) == expected
    built(scene)
    bent = next_frame(scene)
    assert are_merged(of(scene)) == are_merged(of(bent)) == expected
    assert not plan(of(scene), near, SOME).has("LEVELS")
    # planning changes nothing: another picture may still have fitted ones
    assert [hierarchy_before(instance.surfels) for instance in bent.surfels] == built(scene)


@pytest.mark.parametrize("is_repeatable", [True, False])
def test_repeatable_pictures_have_hierarchies_that_are_built_and_not_fitted(is_repeatable, on_device):
    """A hierarchy that was fitted to moved surfels merges others than one that is built for them."""
    scene, camera = far_torus()
    trees = built(scene)
    bent, settings = next_frame(scene), replace(SOME, samples=4)
    on_device(lambda device: Renderer(device).render(bent, camera, settings, is_repeatable=is_repeatable))
    assert all(hierarchy_before(instance.surfels) is None for instance in bent.surfels)
    fitted = [now.entries is before.entries for now, before in zip(built(bent), trees, strict=True)]
    assert fitted == [not is_repeatable] * len(trees)


def test_surfels_that_have_come_to_rest_are_merged(on_device):
    bent = next_frame(far_torus()[0])
    camera = far_torus()[1]

    def draw(device):
        renderer = Renderer(device)
        return [renderer.render(bent, camera, SOME).stats["splats_drawn"] for _ in range(2)]

    first, second = on_device(draw)
    assert first == sum(len(i.surfels) for i in bent.surfels) and second < 0.3 * first


def test_moved_surfels_keep_their_tree_while_it_fits(render):
    scene, camera = far_torus()
    trees = built(scene)
    bent = next_frame(scene)
    every, some = (render(bent, camera, replace(s, samples=4)) for s in (EVERY, SOME))
    assert all(now.entries is before.entries for now, before in zip(built(bent), trees, strict=True))
    assert some.stats["splats_drawn"] < 0.3 * every.stats["splats_drawn"]
    assert psnr(some.color, every.color) > 37
    surfels = bent.surfels[0].surfels
    order = np.random.default_rng(0).permutation(len(surfels))
    mixed = replace(surfels, **{name: array[order] for name, array in surfels.arrays().items()})
    replaced(surfels, mixed)
    assert hierarchy_of(mixed).entries is not trees[0].entries


def test_merged_surfels_as_small_as_a_pixel_do_not_protrude(render):
    scene, camera = far_torus(140_000, (64, 52))
    settings = replace(EVERY, transparent_film=True, shadow_resolution=0)
    every, some = (render(scene, camera, replace(settings, detail_tolerance=t)) for t in (0.0, 1.0))
    assert some.stats["splats_drawn"] < 0.2 * every.stats["splats_drawn"]
    protruding = (some.color[..., 3] - every.color[..., 3]).sum() / every.color[..., 3].sum()
    assert protruding < 0.004  # 0.007 in full size
