# SPDX-License-Identifier: GPL-3.0-or-later
"""Frames of an animation differ where things move, and unchanged surfels are uploaded only once."""

from pathlib import Path

import bpy
import numpy as np
import pytest

from splat_addon.blender.engine import render_resources


@pytest.fixture
def frames(scene, read_picture):
    """frames() -> the pictures of frames 1 to 3."""
    scene.frame_start, scene.frame_end = 1, 3
    folder = Path(scene.render.filepath).parent
    scene.render.filepath = str(folder / "frame_####.exr")

    def render() -> list[np.ndarray]:
        bpy.ops.render.render(animation=True)
        return [read_picture(folder / f"frame_000{number}.exr") for number in (1, 2, 3)]

    return render


@pytest.fixture
def two(add_camera, add_surfels):
    """A surfel at rest, and one that moves to the right by 2 units per frame."""
    add_camera(location=(0, 0, 10))
    standing, moving = add_surfels([(0, 3, 0)], size=0.4), add_surfels([(-2, -1, 0)], size=0.4)
    for number in (1, 2, 3):
        moving.location.x = 2 * (number - 1)
        moving.keyframe_insert("location", frame=number)
    for curve in curves_of(moving):
        for key in curve.keyframe_points:
            key.interpolation = "LINEAR"
    return standing, moving


def curves_of(animated) -> list:
    """The F-curves of an action, wherever this version of Blender keeps them."""
    action = animated.animation_data.action
    if hasattr(action, "fcurves"):
        return list(action.fcurves)
    return [
        curve for layer in action.layers for strip in layer.strips for bag in strip.channelbags for curve in bag.fcurves
    ]


def test_every_frame_is_the_still_of_its_moment(two, scene, frames, picture):
    shot = frames()
    assert not np.array_equal(shot[0], shot[1]) and not np.array_equal(shot[1], shot[2])
    for number in (1, 2, 3):
        scene.frame_set(number)
        scene.render.filepath = str(Path(scene.render.filepath).parent / "still.exr")
        assert np.array_equal(shot[number - 1], picture())


def test_surfels_that_only_move_are_uploaded_once(two, frames, packed_surfels):
    frames()
    assert len(packed_surfels) == 2


def test_surfels_whose_values_change_are_uploaded_again(two, frames, packed_surfels):
    standing, _ = two
    standing.shape_key_add(name="Basis")
    key = standing.shape_key_add(name="moved")
    key.data[0].co.x += 1
    for number, value in ((1, 0), (3, 1)):
        key.value = value
        key.keyframe_insert("value", frame=number)
    shot = frames()
    assert len(packed_surfels) == 4
    assert not np.array_equal(shot[0][16:], shot[2][16:])


def test_values_that_a_script_changes_before_a_frame_are_seen(two, frames):
    standing, _ = two

    def move(scene, *_):
        standing.data.attributes["position"].data[0].vector = (scene.frame_current, 3, 0)

    bpy.app.handlers.frame_change_pre.append(move)
    try:
        shot = frames()
    finally:
        bpy.app.handlers.frame_change_pre.remove(move)
    columns = [np.average(np.arange(32), weights=picture[20:, :, 3].sum(axis=0)) for picture in shot]
    assert np.diff(columns) == pytest.approx([4.4, 4.4], abs=0.5)


def test_surfels_under_unchanging_modifiers_are_uploaded_once(two, frames, packed_surfels, add_nodes):
    """Blender evaluates these surfels again for each frame because something of theirs moves; the result is the
    same.
    """
    for made in two:
        add_nodes(made, lambda tree, start, end: tree.links.new(start, end))
    frames()
    assert len(packed_surfels) == 2


def test_everything_is_let_go_after_the_last_frame(two, frames):
    frames()
    assert render_resources._kept is None


@pytest.mark.parametrize("step", [2, 5])
def test_everything_is_let_go_when_steps_miss_the_last_frame(step, two, scene):
    scene.frame_start, scene.frame_end, scene.frame_step = 1, 4, step
    bpy.ops.render.render(animation=True)
    assert render_resources._kept is None


@pytest.mark.skipif(bpy.app.version < (5, 0, 0), reason="the operator has no range of frames before Blender 5.0")
def test_a_part_of_the_frames_leaves_no_harm_to_the_next_render(two, scene, picture):
    expected = picture()
    scene.frame_end = 250
    bpy.ops.render.render(animation=True, frame_start=1, frame_end=2)
    scene.frame_set(1)
    assert np.array_equal(picture(), expected)
    assert render_resources._kept is None


def test_everything_is_let_go_after_a_still(two, picture):
    picture()
    assert render_resources._kept is None


def test_everything_is_let_go_when_a_frame_fails(two, scene, frames):
    scene.camera.data.type, scene.camera.data.panorama_type = "PANO", "MIRRORBALL"
    with pytest.raises(RuntimeError, match="Mirror Ball"):
        frames()
    assert render_resources._kept is None


def test_everything_is_let_go_when_a_later_frame_fails(two, scene, frames):
    data = scene.camera.data
    data.clip_start = 0.1
    data.keyframe_insert("clip_start", frame=1)
    data.clip_start = 2000
    data.keyframe_insert("clip_start", frame=2)
    with pytest.raises(RuntimeError, match="near 2000"):
        frames()
    assert render_resources._kept is None


def test_view_layers_share_what_lies_on_the_device(two, scene, frames, packed_surfels):
    scene.view_layers.new("Second")
    scene.view_layers.new("Not rendered").use = False
    frames()
    assert len(packed_surfels) == 2
    assert render_resources._kept is None
