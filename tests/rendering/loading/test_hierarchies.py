# SPDX-License-Identifier: GPL-3.0-or-later
"""Hierarchies of a view's large sets are built in the background; their progress and errors are told."""

from dataclasses import replace

import numpy as np
import pytest

from splat_addon.rendering import Renderer
from splat_addon.rendering.detail import hierarchies
from splat_addon.rendering.detail.hierarchies import built_hierarchy
from splat_addon.rendering.upload import loading
from tests.rendering.loading.views import COUNT, SETTINGS, begun, shown, torus


def test_a_thread_s_error_is_raised_by_each_picture(small_steps, on_device, monkeypatch):
    scene, camera = torus()

    def fail(surfels, told):
        raise MemoryError("no room for nodes")

    monkeypatch.setattr(hierarchies, "build_hierarchy", fail)

    def draw(device):
        view, thread = begun(device)
        shown(device, view, scene, camera, SETTINGS)
        thread.work()
        for _ in range(2):
            with pytest.raises(MemoryError, match="no room for nodes"):
                shown(device, view, scene, camera, SETTINGS)

    on_device(draw)


def test_what_is_left_falls_while_a_hierarchy_is_built(small_steps, on_device, monkeypatch):
    scene, camera = torus()
    build = hierarchies.build_hierarchy

    def draw(device):
        (view, thread), left = begun(device), []

        def watched(surfels, told):
            def looked(share):
                told(share)
                left.append(view.loading.left[0])

            return build(surfels, looked)

        monkeypatch.setattr(hierarchies, "build_hierarchy", watched)
        shown(device, view, scene, camera, SETTINGS)
        thread.work()
        return left, view.loading.left[0]

    left, last = on_device(draw)
    assert left[0] > 0.9 * COUNT and left == sorted(left, reverse=True) and len(set(left)) > 5
    assert left[-1] < 0.7 * COUNT and last == COUNT / 2


def test_a_job_that_nobody_waits_for_ends_at_its_next_step(small_steps, on_device, monkeypatch):
    scene, camera = torus()

    def draw(device):
        view, thread = begun(device)
        shown(device, view, scene, camera, SETTINGS)
        future, _ = thread.jobs[0]
        monkeypatch.setattr(hierarchies, "build_hierarchy", lambda _, told: [view.loading.clear(), told(0.1)])
        thread.work()
        return future.exception()

    assert isinstance(on_device(draw), loading.Withdrawn)


def test_a_hierarchy_is_built_in_the_background_while_every_surfel_is_drawn(small_steps, on_device):
    """Before, the tolerance was 0, so the surfels are there without levels."""
    scene, camera = torus()
    surfels = scene.surfels[0].surfels

    def draw(device):
        view, thread = begun(device)
        every = replace(SETTINGS, detail_tolerance=0.0)
        shown(device, view, scene, camera, every)
        while view.loading.left[0]:
            thread.work()
            exact = shown(device, view, scene, camera, every)
        first = shown(device, view, scene, camera, SETTINGS)
        built = built_hierarchy(surfels)
        while view.loading.left[0]:
            thread.work()
            last = shown(device, view, scene, camera, SETTINGS)
        return exact, first, built, last, Renderer(device).render(scene, camera, SETTINGS).color

    exact, first, built, last, whole = on_device(draw)
    assert built is None and built_hierarchy(surfels) is not None
    np.testing.assert_array_equal(first, exact)
    np.testing.assert_array_equal(last, whole)


def test_stand_ins_have_no_levels(small_steps, on_device, monkeypatch):
    """Building them would take longer than the picture."""
    scene, camera = torus()
    monkeypatch.setattr(hierarchies, "build_hierarchy", lambda *_: pytest.fail("a hierarchy was built at once"))

    def draw(device):
        view, _ = begun(device)
        shown(device, view, scene, camera, SETTINGS)
        return view.is_late

    assert on_device(draw)
