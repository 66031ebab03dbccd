# SPDX-License-Identifier: GPL-3.0-or-later
"""The camera's clip distances cut the picture as they do in Cycles."""

import bpy
import numpy as np
import pytest

KINDS = {"perspective": {}, "orthographic": {"type": "ORTHO", "ortho_scale": 8}}


@pytest.mark.parametrize("kind", KINDS)
def test_only_what_lies_between_the_clip_distances_is_drawn(kind, add_camera, add_surfels, picture):
    """One object has surfels before, between and beyond the clip distances."""
    add_camera(clip_start=8, clip_end=12, **KINDS[kind])
    add_surfels([(-2, 0, 3), (0, 0, 0), (2, 0, -3)], size=0.5)
    columns = np.nonzero(picture()[..., 3].any(axis=0))[0]
    assert len(columns) and 13 <= columns.min() and columns.max() <= 18


@pytest.mark.parametrize("kind", KINDS)
def test_a_tilted_plane_is_cut_where_cycles_cuts_it(kind, add_camera, add_sheet, picture, switch_to_cycles):
    add_camera(clip_start=9.2, clip_end=10.7, **KINDS[kind])
    sheet = add_sheet(side=8, count=80)
    sheet.rotation_euler = (0.2, 0.5, 0)
    ours = picture()[..., 3] > 0.5
    sheet.hide_render = True
    bpy.ops.mesh.primitive_plane_add(size=8, rotation=(0.2, 0.5, 0))
    switch_to_cycles(samples=16)
    theirs = picture()[..., 3] > 0.5
    assert 100 < theirs.sum() < 800
    # the cut is exact, except where splats are moved back across it and blend
    assert np.count_nonzero(ours != theirs) <= 12
