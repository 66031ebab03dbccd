# SPDX-License-Identifier: GPL-3.0-or-later
"""Panoramic cameras show what Cycles shows with the same settings, also with borders, shifts and in stereo."""

import math

import bpy
import numpy as np
import pytest

#: camera properties, size, pixel aspect
CAMERAS = {
    "all around": ({"panorama_type": "EQUIRECTANGULAR"}, (64, 32), (1, 1)),
    "a part": (
        {
            "panorama_type": "EQUIRECTANGULAR",
            "longitude_min": -1.0,
            "longitude_max": 2.0,
            "latitude_min": -0.5,
            "latitude_max": 1.2,
        },
        (48, 32),
        (1, 1),
    ),
    "equidistant": ({"panorama_type": "FISHEYE_EQUIDISTANT", "fisheye_fov": math.radians(200)}, (48, 32), (1, 1)),
    "equisolid": ({"panorama_type": "FISHEYE_EQUISOLID", "fisheye_lens": 12.0}, (48, 40), (1, 1)),
    "equisolid, tall": ({"panorama_type": "FISHEYE_EQUISOLID", "fisheye_lens": 9.0}, (32, 48), (1, 1)),
    "equisolid, wide pixels": ({"panorama_type": "FISHEYE_EQUISOLID", "fisheye_lens": 9.0}, (32, 40), (2, 1)),
    "equisolid, vertical": (
        {"panorama_type": "FISHEYE_EQUISOLID", "fisheye_lens": 9.0, "sensor_fit": "VERTICAL", "sensor_height": 20.0},
        (48, 32),
        (1, 1),
    ),
    "shifted around": ({"panorama_type": "EQUIRECTANGULAR", "shift_x": 0.2}, (64, 32), (1, 1)),
    "shifted": (
        {"panorama_type": "FISHEYE_EQUIDISTANT", "fisheye_fov": 3.0, "shift_x": 0.2, "shift_y": -0.1},
        (40, 32),
        (1, 1),
    ),
}
PLACE = (0.3, 0.2, 0.4)


@pytest.fixture
def discs(scene, add_surfels, add_mesh):
    """Discs all around, some on edges of the cube's faces, as surfels and, for Cycles, as faces."""
    scene.surfel_splatting.render_meshes = "HIDDEN"
    random = np.random.default_rng(2)
    ways = random.normal(size=(40, 3))
    ways = np.concatenate([ways / np.linalg.norm(ways, axis=1, keepdims=True), [(0.577, 0.577, -0.577)]])
    places = np.array(PLACE) + 4 * ways
    add_surfels(places, -ways, size=0.5, is_shown=False)
    turn = np.linspace(0, 2 * np.pi, 64, endpoint=False)[:, None]
    corners = []
    for place, way in zip(places, ways, strict=True):
        x = np.cross(way, (0.2, 0.5, 0.9))
        x /= np.linalg.norm(x)
        corners.append(place + 0.5 * (np.cos(turn) * x + np.sin(turn) * np.cross(way, x)))
    faces = [tuple(range(64 * k, 64 * k + 64)) for k in range(len(ways))]
    add_mesh("faces", np.concatenate(corners).tolist(), faces)


@pytest.fixture
def camera(scene, add_camera, discs):
    """camera(name) -> the panoramic camera of that projection, turned; also sets the picture's size."""

    def add(name):
        properties, size, aspect = CAMERAS[name]
        render = scene.render
        render.resolution_x, render.resolution_y = size
        render.pixel_aspect_x, render.pixel_aspect_y = aspect
        return add_camera(PLACE, (1.2, 0.2, 0.5), type="PANO", **properties)

    return add


def use_cycles(scene, switch_to_cycles):
    scene.cycles.pixel_filter_type = "BOX"
    switch_to_cycles(samples=128, filter_width=1.0)


@pytest.mark.parametrize("name", CAMERAS)
def test_the_picture_is_cycles(name, scene, camera, picture, switch_to_cycles):
    camera(name)
    scene.surfel_splatting.samples = 16
    ours = picture()[..., 3]
    use_cycles(scene, switch_to_cycles)
    truth = picture()[..., 3]
    assert 0.1 < truth.mean() < 0.95
    assert np.abs(ours - truth).mean() < 0.02
    assert np.count_nonzero(np.abs(ours - truth) > 0.25) <= 0.02 * ours.size


def test_depths_are_distances_as_cycles(scene, camera, passes, switch_to_cycles):
    camera("all around")
    scene.view_layers[0].use_pass_z = True
    ours = passes()
    depth = next(values for name, values in ours.items() if name.endswith("Depth"))
    use_cycles(scene, switch_to_cycles)
    scene.cycles.samples = 1
    theirs = next(values for name, values in passes().items() if name.endswith("Depth"))
    both = (depth < 100) & (theirs < 100)
    assert both.mean() > 0.1
    assert np.abs(depth - theirs)[both].max() < 0.05


@pytest.mark.parametrize("crop", [False, True])
def test_a_border_shows_what_the_whole_picture_does_there(crop, scene, camera, picture):
    camera("all around")
    whole = picture()
    render = scene.render
    render.use_border, render.use_crop_to_border = True, crop
    render.border_min_x, render.border_max_x, render.border_min_y, render.border_max_y = 0.25, 0.75, 0.5, 1
    part = picture() if crop else picture()[16:, 16:48]
    assert part.any()
    assert np.count_nonzero(np.abs(part - whole[16:, 16:48]).max(axis=2) > 1e-4) <= 3


def test_what_is_seen_from_the_middle_is_sampled_as_finely_as_its_pixels(scene, add_camera, picture):
    """A mesh behind the camera is sampled for a panorama, with a density given in pixels."""
    bpy.ops.mesh.primitive_uv_sphere_add(location=(0, 0, 4))
    add_camera(type="PANO", panorama_type="EQUIRECTANGULAR")
    scene.surfel_splatting.render_meshes = "SURFELS"
    scene.surfel_splatting.mesh_density = "CAMERA"
    assert np.ptp(picture()[..., 3]) == pytest.approx(1, abs=1e-4)


def test_depth_of_field_says_that_it_is_for_perspective_cameras(scene, camera, picture, said):
    camera("all around").data.dof.use_dof = True
    picture()
    assert "Depth of field needs a perspective camera" in said()
