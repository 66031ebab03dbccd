# SPDX-License-Identifier: GPL-3.0-or-later
"""The calls that drew one sample draw the others, with other values, and the picture is the same as without that."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from splat_addon.rendering import Camera, Light, Scene, Settings, look_at
from splat_addon.rendering.features import hidden_objects
from splat_addon.rendering.plan import executor
from splat_addon.rendering.plan.frame_plan import FramePlan
from splat_addon.rendering.plan.repeats import Repeats
from splat_addon.rendering.plan.tile import TileContext
from splat_addon.rendering.scene import Instance
from splat_addon.rendering.upload.resources import Resources
from splat_addon.sampling import TriangleMesh, sample_mesh
from tests.rendering.agreement_shots import SHOTS

PLACES = [(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0)]
SHEET = sample_mesh(TriangleMesh(np.array(PLACES, float), np.array([(0, 1, 2), (0, 2, 3)])), resolution=8)
CAMERA = Camera.perspective(look_at((0, -4, 3), (0, 0, 0)), 0.8, (24, 16))
SAMPLES = 3
#: Pictures of which most values are needed.
SAMPLED = ("polygons-quad-1.0", "shadows-quad-toon", "solid_sphere-quad-flat-lines", "torus-quad-flat-eye_dome")


def scene(transparent: bool = False) -> Scene:
    """A small sheet above a large one that reaches the picture's edge."""
    above, below = np.diag([0.5, 0.5, 1, 1]), np.diag([2.0, 2.0, 1, 1])
    above[2, 3] = 0.7
    small = SHEET
    if transparent:
        small = replace(SHEET, colors=SHEET.colors * np.float32([1, 1, 1, 0.5]))
    placed = Instance(small, above, name="above"), Instance(SHEET, below, name="below")
    return Scene(placed, lights=[Light("sun", direction=(0.2, 0.1, -1), energy=2)], world=(0.1,) * 3)


def drawn(render, monkeypatch, of: Scene, settings: Settings, may_repeat: bool | None = None):
    """The frame, and how often each pass ran."""
    ran = []
    with monkeypatch.context() as patch:
        patch.setattr(executor, "run_pass", lambda tile, p: (ran.append(p.name), p.run(tile, p))[1])
        if may_repeat is not None:
            patch.setattr(FramePlan, "may_repeat", may_repeat)
        frame = render(of, CAMERA, settings)
    return frame, ran


@pytest.mark.parametrize("method", ["mip", "quad"])
def test_samples_are_drawn_by_the_calls_of_the_first(render, monkeypatch, method):
    settings = Settings(method, samples=SAMPLES, outputs=("color", "depth", "normal", "object_index"))
    frame, ran = drawn(render, monkeypatch, scene(), settings)
    anew, ran_anew = drawn(render, monkeypatch, scene(), settings, may_repeat=False)
    assert sorted(set(ran)) == sorted(ran) and len(ran_anew) > 2 * len(ran)
    for name in settings.outputs:
        np.testing.assert_array_equal(getattr(frame, name), getattr(anew, name))
    assert frame.stats["splats_drawn"] == anew.stats["splats_drawn"] > 0


def test_layers_are_drawn_anew(render, monkeypatch):
    """How many there are is read while they are drawn."""
    _, ran = drawn(render, monkeypatch, scene(transparent=True), Settings(samples=SAMPLES))
    assert ran.count("visibility") >= SAMPLES


@pytest.mark.parametrize("shares", [(), (0.5,)])
def test_samples_are_drawn_anew_only_where_hidden_objects_are_looked_for(render, monkeypatch, shares):
    for name, value in {"LEAST_OBJECTS": 2, "LEAST_SURFELS": 1, "_SHARES": shares}.items():
        monkeypatch.setattr(hidden_objects, name, value)
    frame, ran = drawn(render, monkeypatch, scene(), Settings(samples=SAMPLES))
    anew, _ = drawn(render, monkeypatch, scene(), Settings(samples=SAMPLES), may_repeat=False)
    assert ran.count("visibility") == (SAMPLES if shares else 1)
    np.testing.assert_array_equal(frame.color, anew.color)


def test_calls_are_kept_of_whole_samples():
    kept, called = Repeats(records=True), []
    kept.begin()
    kept.call(called.append, 1)
    kept.call(called.append, 2, lasts=True)
    kept.end(0, "p", "target")
    assert not kept.passes, "the sample is not complete"
    kept.complete()
    ((number, p, calls, target),) = kept.passes
    for call in calls:
        call()
    assert called == [1, 2, 1] and (number, p, target) == (0, "p", "target")
    kept.give_up()
    kept.complete()
    assert not kept.passes


def test_a_picture_between_two_samples_is_not_followed():
    kept, resources = Repeats(), Resources(SimpleNamespace())
    assert not resources.follows(kept) and resources.follows(kept)
    assert not resources.follows(Repeats()) and not resources.follows(kept)
    resources.release()
    assert not resources.follows(kept)


@pytest.mark.parametrize("name", SAMPLED)
def test_blocks_have_all_values_that_differ_between_samples(name, render, monkeypatch):
    """Those that `SAMPLE_VALUES` lack would stay the first sample's."""
    of, camera, settings = SHOTS[name]()
    brought, bring = [], TileContext.bring_blocks

    def compared(tile):
        bring(tile)
        for (rise, block), values in tile.repeats.blocks.items():
            np.testing.assert_array_equal(values, replace(tile, rise=rise)._values_in(block), str(block))
            brought.extend(name for _, name in block[2])

    monkeypatch.setattr(TileContext, "bring_blocks", compared)
    render(of, camera.cropped(camera.size[0] // 2, camera.size[1] // 2, 8, 8), replace(settings, samples=2))
    assert "projection" in brought
