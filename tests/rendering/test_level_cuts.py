# SPDX-License-Identifier: GPL-3.0-or-later
"""Each view of a picture has a cut of its own, which is chosen once and uploaded when it changes."""

from dataclasses import replace
from importlib import import_module

import numpy as np
import pytest

from splat_addon.reference.metrics import psnr
from splat_addon.rendering import Equirectangular, Panorama, Renderer, plan
from splat_addon.rendering.detail.hierarchies import LEAST_SURFELS
from splat_addon.rendering.passes.decisions import merging, shadows
from splat_addon.rendering.plan import cut_choice
from tests.rendering.level_scenes import EVERY, LAMPS, SOME, far_torus


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
