# SPDX-License-Identifier: GPL-3.0-or-later
"""This engine draws previews of materials, and they do not disturb a final render."""

from types import SimpleNamespace

import bpy
import numpy as np
import pytest

from splat_addon.blender.engine import final_render, render_resources


@pytest.fixture
def preview():
    """preview(colour) -> (h, w, 4) preview of a material with that base colour, as in the asset browser."""

    def draw(color) -> np.ndarray:
        material = bpy.data.materials.new("shown")
        if bpy.app.version < (5, 0, 0):
            material.use_nodes = True
        material.node_tree.nodes["Principled BSDF"].inputs["Base Color"].default_value = (*color, 1)
        material.asset_mark()
        material.asset_generate_preview()
        made = material.preview_ensure()
        width, height = made.image_size
        return np.array(made.image_pixels_float, np.float32).reshape(height, width, 4)

    return draw


def test_a_material_s_preview_has_its_colour(scene, preview):
    red, blue = preview((0.8, 0.0, 0.0)), preview((0.0, 0.0, 0.8))
    middle = red[48:80, 48:80].mean(axis=(0, 1)), blue[48:80, 48:80].mean(axis=(0, 1))
    assert middle[0][0] > 0.5 > middle[0][2] and middle[1][2] > 0.5 > middle[1][0]
    assert np.unique(red[..., 1]).size > 16


def test_a_preview_leaves_the_last_picture_as_it_was(scene, add_camera, add_surfels, picture, preview):
    scene.render.use_persistent_data = True
    add_camera()
    add_surfels([(0, 0, 0)], size=1.0)
    before = picture()
    kept, stats = render_resources._kept, dict(final_render.last_frame_stats)
    preview((0.5, 0.5, 0.5))
    assert render_resources._kept is kept is not None and final_render.last_frame_stats == stats
    assert np.array_equal(picture(), before)
    scene.render.use_persistent_data = False
    picture()


def test_the_progress_of_several_views_ends_at_1(scene, monkeypatch):
    """Blender's own previews have one view, so the engine here is a stand-in with two."""
    turns, views = [], [SimpleNamespace(name="left"), SimpleNamespace(name="right")]
    monkeypatch.setattr(final_render, "_picture", lambda *about: (turns.append(about[-1]), None))
    monkeypatch.setattr(final_render, "hand_over", lambda *about: None)
    resources = SimpleNamespace(renderer=SimpleNamespace(release=lambda: None))
    monkeypatch.setattr(final_render, "Resources", lambda most: resources)  # Blender 4.5 draws inside a render alone
    engine = SimpleNamespace(
        is_preview=True, get_result=lambda: SimpleNamespace(views=views), active_view_set=lambda view: None
    )
    final_render.render(engine, bpy.context.evaluated_depsgraph_get())
    assert turns == [(0, 2), (1, 2)]
