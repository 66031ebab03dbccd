# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfels that move are merged where a frame's samples repay it, by a fitted or a new hierarchy."""

from dataclasses import replace
from weakref import WeakSet

import numpy as np
import pytest

from splat_addon.reference.metrics import psnr
from splat_addon.rendering import Renderer, plan
from splat_addon.rendering.detail.hierarchies import hierarchy_before, hierarchy_of, replaced
from splat_addon.rendering.detail.history import history
from tests.rendering.level_scenes import EVERY, SOME, built, far_torus, next_frame


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
