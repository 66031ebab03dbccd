# SPDX-License-Identifier: GPL-3.0-or-later
"""Motion blur is right by closed forms and beside Cycles, and leaves the scene at its frame."""

import bpy
import numpy as np
import pytest

from splat_addon.blender.engine import render_resources

FAST = 8.0  # units a frame; a unit is a pixel


@pytest.fixture
def flat_camera(scene, add_camera):
    """A parallel camera, 32 units wide over 32 pixels; motion blur is on, with 64 samples."""
    scene.render.use_motion_blur, scene.render.motion_blur_shutter = True, 1.0
    scene.surfel_splatting.samples = 64
    scene.frame_set(10)
    return add_camera(type="ORTHO", ortho_scale=32)


def move(moved, frames=(9, 11), step=FAST):
    """Animate an even motion to the right that passes the object's own place at frame 10."""
    start = moved.location.x
    for number in frames:
        moved.location.x = start + step * (number - 10)
        moved.keyframe_insert("location", frame=number)
    action = moved.animation_data.action
    curves = getattr(action, "fcurves", None) or action.layers[0].strips[0].channelbags[0].fcurves
    for curve in curves:
        curve.extrapolation = "LINEAR"
        for key in curve.keyframe_points:
            key.interpolation = "LINEAR"


def moments(alpha):
    """The sum, centre and variance along x, in pixels from the middle."""
    x = np.arange(alpha.shape[1]) + 0.5 - alpha.shape[1] / 2
    weights = alpha.sum(axis=0)
    center = (weights * x).sum() / weights.sum()
    return weights.sum(), center, (weights * x * x).sum() / weights.sum() - center**2


@pytest.mark.parametrize(
    ("position", "middle", "shutter"), [("START", 0.5, 1.0), ("CENTER", 0.0, 1.0), ("END", -0.5, 0.5)]
)
def test_a_moving_discs_moments_are_those_of_its_path(
    position, middle, shutter, scene, flat_camera, add_surfels, picture
):
    """A disc has the variance radius^2 / 4, an even path length^2 / 12; the two add up."""
    move(add_surfels([(0, 0, 0)], size=3.0))
    scene.render.motion_blur_position, scene.render.motion_blur_shutter = position, shutter
    total, center, variance = moments(picture()[..., 3])
    assert total == pytest.approx(np.pi * 3**2, rel=0.01)
    assert center == pytest.approx(middle * FAST * shutter, abs=0.1)
    assert variance == pytest.approx((FAST * shutter) ** 2 / 12 + 3**2 / 4 + 1 / 12, rel=0.03)


def test_a_moving_edge_is_an_even_ramp(scene, flat_camera, add_surfels, picture):
    """The coverage falls evenly from 1 to 0 over the 8 pixels that the edge crosses."""
    move(add_surfels([(-5000, 0, 0)], size=5000.0))
    row = picture()[16, :, 3]
    x = np.arange(32) + 0.5 - 16
    np.testing.assert_allclose(row, np.clip(0.5 - x / FAST, 0, 1), atol=0.04)


def test_a_moving_camera_blurs_as_what_moves_the_other_way(scene, flat_camera, add_surfels, picture):
    scene.surfel_splatting.samples = 16
    standing = add_surfels([(0, 0, 0)], size=3.0)
    move(flat_camera)
    by_camera = picture()
    flat_camera.animation_data_clear()
    flat_camera.location.x = 0
    move(standing, step=-FAST)
    by_object = picture()
    assert by_object.any() and np.count_nonzero(np.abs(by_camera - by_object).max(axis=2) > 2e-2) <= 2


@pytest.mark.parametrize("position", ["START", "CENTER", "END"])
def test_a_cut_to_another_camera_blends_no_pictures(position, scene, flat_camera, add_camera, add_surfels, picture):
    """A marker makes another camera the scene's while the centred shutter is open; the picture is only that one's."""
    scene.surfel_splatting.samples = 8
    add_surfels([(0, 0, 0)], size=3.0)
    second = add_camera((8, 0, 10), type="ORTHO", ortho_scale=32)
    move(second)
    scene.render.motion_blur_position = position
    scene.render.use_motion_blur = False
    sharp = picture()
    scene.render.use_motion_blur = True
    uncut = picture()
    for number, camera in ((1, flat_camera), (10, second)):
        scene.timeline_markers.new(camera.name, frame=number).camera = camera
    assert np.abs(uncut - sharp).max() > 0.2
    np.testing.assert_allclose(picture(), uncut, atol=1e-5)
    assert scene.camera == second


def test_a_curve_says_when_the_shutter_is_open(scene, flat_camera, add_surfels, picture):
    """If the shutter's curve rises evenly, the mean time is 2/3 of the shutter's and the variance 1/18."""
    move(add_surfels([(0, 0, 0)], size=3.0))
    scene.render.motion_blur_position = "START"
    curve = scene.render.motion_blur_shutter_curve.curves[0]
    curve.points[0].location, curve.points[-1].location = (0, 0), (1, 1)
    for point in list(curve.points)[1:-1]:
        curve.points.remove(point)
    for point in curve.points:
        point.handle_type = "VECTOR"
    scene.render.motion_blur_shutter_curve.update()
    _, center, variance = moments(picture()[..., 3])
    assert center == pytest.approx(FAST * 2 / 3, abs=0.1)
    assert variance == pytest.approx(FAST**2 / 18 + 3**2 / 4 + 1 / 12, rel=0.03)


def test_fewer_steps_are_so_many_pictures(scene, flat_camera, add_surfels, picture):
    move(add_surfels([(0, 0, 0)], size=0.5), step=24)
    scene.surfel_splatting.motion_blur_steps = 3
    columns = picture()[..., 3].sum(axis=0) > 0
    assert np.count_nonzero(np.diff(columns.astype(int)) == 1) == 3
    scene.surfel_splatting.motion_blur_steps = 64
    columns = picture()[..., 3].sum(axis=0) > 0
    assert np.count_nonzero(np.diff(columns.astype(int)) == 1) == 1


@pytest.mark.parametrize("kind", ["moves", "bends", "surfels shift"])
def test_the_blur_is_cycles(kind, scene, add_camera, add_object, add_surfels, picture, switch_to_cycles):
    """A ball moves, or a shape key bends or shifts it; it is drawn both as a mesh and as surfels."""
    bpy.ops.mesh.primitive_uv_sphere_add(segments=96, ring_count=48)
    ball = bpy.context.object
    if kind == "moves":
        move(ball, step=2.0)
    else:
        animate_key(ball, kind)
    add_camera((0.5, 0, 8), lens=80)
    scene.frame_set(10)
    scene.render.use_motion_blur, scene.render.motion_blur_shutter = True, 1.0
    scene.surfel_splatting.samples = 32
    scene.surfel_splatting.render_meshes, scene.surfel_splatting.mesh_density = "SURFELS", "RESOLUTION"
    scene.surfel_splatting.mesh_resolution = 64  # what bends is sampled for each of the pictures
    if kind == "surfels shift":
        scene.surfel_splatting.render_meshes = "HIDDEN"
        positions = [tuple(v.co) for v in ball.data.vertices]
        normals = [tuple(v.normal) for v in ball.data.vertices]
        animate_key(add_surfels(positions, normals, size=0.06, is_shown=False), kind)
    ours = picture()[..., 3]
    scene.cycles.pixel_filter_type = "BOX"
    switch_to_cycles(samples=256, filter_width=1.0)
    truth = picture()[..., 3]
    assert np.mean((truth > 0.1) & (truth < 0.9)) > 0.1
    assert np.abs(ours - truth).mean() < 0.015
    assert np.abs(ours - truth).max() < 0.15


def animate_key(moved, kind):
    """Animate a shape key from frame 9 to 11 that moves vertices to the right: all alike, or the more the higher they
    are.
    """
    moved.shape_key_add(name="Basis")
    key = moved.shape_key_add(name="bent")
    for point, vertex in zip(key.data, moved.data.vertices, strict=True):
        point.co.x += 3 * max(vertex.co.y, 0) if kind == "bends" else 1.5
    for number, value in ((9, 0), (11, 1)):
        key.value = value
        key.keyframe_insert("value", frame=number)
    action = moved.data.shape_keys.animation_data.action
    curves = getattr(action, "fcurves", None) or action.layers[0].strips[0].channelbags[0].fcurves
    for point in curves[0].keyframe_points:
        point.interpolation = "LINEAR"


def test_the_frame_is_restored(scene, flat_camera, add_surfels, picture):
    scene.surfel_splatting.samples = 4
    moved = add_surfels([(0, 0, 0)], size=3.0)
    move(moved)
    picture()
    assert (scene.frame_current, scene.frame_subframe) == (10, 0)
    assert moved.matrix_world.translation.x == pytest.approx(0, abs=1e-5)


def test_the_frame_is_restored_after_a_failure(scene, flat_camera, add_surfels, picture):
    moved = add_surfels([(0, 0, 0)], size=3.0)
    move(moved)
    data = flat_camera.data
    for number, value in ((9, 0.1), (11, 4000.0)):
        data.clip_start = value
        data.keyframe_insert("clip_start", frame=number)
    with pytest.raises(RuntimeError, match="Clip distances"):
        picture()
    assert (scene.frame_current, scene.frame_subframe) == (10, 0)
    assert render_resources._kept is None


@pytest.mark.parametrize("shutter", [np.nan, np.inf])
def test_a_shutter_that_is_no_time_blurs_nothing_and_is_said(shutter, scene, flat_camera, add_surfels, picture, said):
    scene.surfel_splatting.samples = 4
    move(add_surfels([(0, 0, 0)], size=3.0))
    scene.render.motion_blur_shutter = shutter
    drawn = picture()
    assert f"A shutter cannot be open for {scene.render.motion_blur_shutter:g} frames" in said()
    scene.render.use_motion_blur = False
    np.testing.assert_array_equal(picture(), drawn)


def test_one_sample_is_sharp_and_says_so(scene, flat_camera, add_surfels, picture, said):
    move(add_surfels([(0, 0, 0)], size=3.0))
    scene.surfel_splatting.samples = 1
    blurred = picture()
    assert "Motion blur needs Samples above 1" in said()
    scene.render.use_motion_blur = False
    np.testing.assert_array_equal(picture(), blurred)
    assert "Motion blur" not in said()


def test_what_stands_still_is_as_without(scene, flat_camera, add_surfels, picture):
    scene.surfel_splatting.samples = 4
    add_surfels([(1, 2, 0)], size=3.0)
    blurred = picture()
    scene.render.use_motion_blur = False
    np.testing.assert_array_equal(picture(), blurred)


def test_every_frame_of_an_animation_is_the_still_of_its_moment(
    scene, flat_camera, add_surfels, picture, read_picture, tmp_path
):
    """With two view layers each of them must leave the scene at its frame for the other."""
    move(add_surfels([(0, 0, 0)], size=3.0), step=4)
    scene.surfel_splatting.samples = 4
    scene.view_layers.new("Second")
    stills = []
    for number in (9, 10, 11):
        scene.frame_set(number)
        stills.append(picture())
    scene.frame_start, scene.frame_end = 9, 11
    scene.render.filepath = str(tmp_path / "frame_####.exr")
    bpy.ops.render.render(animation=True)
    for number, still in zip((9, 10, 11), stills, strict=True):
        np.testing.assert_array_equal(read_picture(tmp_path / f"frame_{number:04d}.exr"), still)
    assert not np.array_equal(stills[0], stills[1])
    assert render_resources._kept is None
