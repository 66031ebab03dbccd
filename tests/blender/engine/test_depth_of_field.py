# SPDX-License-Identifier: GPL-3.0-or-later
"""Depth of field blurs as it does in Cycles: with the same aperture, at the same place, by the same amount."""

import bpy
import numpy as np
import pytest

OPENINGS = {
    "round": {},
    "triangular": {"aperture_blades": 3, "aperture_rotation": 0.5},
    "narrow": {"aperture_ratio": 1.7},
}


@pytest.fixture
def camera(scene, add_camera):
    """camera(**depth of field) -> the camera, 10 units above the floor, focused at distance 4."""

    def add(**options):
        made = add_camera((0.3, 0.2, 10), (0, 0, 0.4), lens=60, shift_x=0.05)
        made.data.dof.use_dof = True
        for name, value in ({"focus_distance": 4, "aperture_fstop": 0.05} | options).items():
            setattr(made.data.dof, name, value)
        return made

    return add


@pytest.fixture
def discs(scene, add_surfels, add_mesh):
    """Two discs, one behind the focus and one before it, as surfels and, for Cycles, as faces."""
    scene.surfel_splatting.render_meshes = "HIDDEN"
    places, radii = np.array([(0.2, 0.0, 0.0), (-0.2, 0.4, 7.5)]), np.array([0.8, 0.2])
    add_surfels(places, size=np.repeat(radii[:, None], 2, axis=1))
    turn = np.linspace(0, 2 * np.pi, 64, endpoint=False)
    ring = np.stack([np.cos(turn), np.sin(turn), 0 * turn], axis=1)
    corners = (places[:, None] + radii[:, None, None] * ring).reshape(-1, 3)
    add_mesh("faces", corners.tolist(), [tuple(range(64)), tuple(range(64, 128))])


@pytest.mark.parametrize("opening", OPENINGS)
def test_the_blur_is_cycles(opening, scene, camera, discs, picture, switch_to_cycles):
    camera(**OPENINGS[opening])
    scene.surfel_splatting.samples = 128
    blurred = picture()[..., 3]
    scene.cycles.pixel_filter_type = "BOX"
    switch_to_cycles(samples=512, filter_width=1.0)
    truth = picture()[..., 3]
    assert 0.1 < truth.mean() < 0.9 and np.mean((truth > 0.1) & (truth < 0.9)) > 0.1
    assert np.abs(blurred - truth).mean() < 0.01
    assert np.abs(blurred - truth).max() < 0.1


def test_the_focus_object_is_sharp(scene, camera, add_surfels, picture):
    """Its distance is measured along the camera's axis."""
    focus = bpy.data.objects.new("focus", None)
    focus.location = (3, -2, 5)
    scene.collection.objects.link(focus)
    made = camera(focus_distance=1, focus_object=focus)
    add_surfels([(0.3, 0.2, 5)], size=0.5)
    scene.surfel_splatting.samples = 32
    in_focus = picture()[..., 3]
    made.data.dof.use_dof = False
    sharp = picture()[..., 3]
    assert np.abs(in_focus - sharp).max() < 0.05 and 0.01 < sharp.mean() < 0.9
    made.data.dof.use_dof = True
    focus.location.z = 9
    assert np.abs(picture()[..., 3] - sharp).max() > 0.3


def test_one_sample_is_sharp_and_says_so(scene, camera, discs, picture, said):
    made = camera()
    blurred = picture()
    assert "Depth of field needs Samples above 1" in said()
    made.data.dof.use_dof = False
    np.testing.assert_array_equal(picture(), blurred)
    assert "Depth of field" not in said()


def test_a_parallel_camera_is_sharp_and_says_so(scene, camera, discs, picture, said):
    made = camera()
    made.data.type, made.data.ortho_scale = "ORTHO", 4
    scene.surfel_splatting.samples = 2
    picture()
    assert "Depth of field needs a perspective camera" in said()


@pytest.mark.parametrize("focus", [0, np.nan])
def test_a_focus_that_is_no_distance_blurs_nothing_and_is_said(focus, scene, camera, discs, picture, said):
    dof = camera(focus_distance=focus).data.dof
    scene.surfel_splatting.samples = 2
    drawn = picture()
    assert f"A lens cannot focus at the distance {focus:.1f}" in said()
    dof.use_dof = False
    np.testing.assert_array_equal(picture(), drawn)
