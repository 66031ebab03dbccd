# SPDX-License-Identifier: GPL-3.0-or-later
"""Each view of a stereo render is what its eye sees in Cycles; each of several cameras gives its own still."""

from pathlib import Path

import bpy
import numpy as np
import pytest

EYES = ("L", "R")


@pytest.fixture
def eyes(scene, read_picture):
    """eyes() -> the pictures of the left and the right view."""
    scene.render.use_multiview = True
    scene.render.image_settings.views_format = "INDIVIDUAL"

    def render() -> list[np.ndarray]:
        bpy.ops.render.render(write_still=True)
        path = Path(scene.render.filepath)
        return [read_picture(path.with_stem(f"{path.stem}_{eye}")) for eye in EYES]

    return render


@pytest.fixture
def discs(scene, add_surfels, add_mesh):
    """Three discs at different depths, as surfels and, for Cycles, as faces."""
    scene.surfel_splatting.render_meshes = "HIDDEN"
    places, radii = np.array([(0.5, 0.0, 0.0), (-0.8, 0.7, 4.0), (-0.1, -0.5, 7.0)]), np.array([0.9, 0.5, 0.2])
    add_surfels(places, size=np.repeat(radii[:, None], 2, axis=1), is_shown=False)
    turn = np.linspace(0, 2 * np.pi, 64, endpoint=False)
    ring = np.stack([np.cos(turn), np.sin(turn), 0 * turn], axis=1)
    corners = (places[:, None] + radii[:, None, None] * ring).reshape(-1, 3)
    add_mesh("faces", corners.tolist(), [tuple(range(64 * k, 64 * k + 64)) for k in range(3)])


#: width, height, horizontal and vertical pixel aspect, sensor fit
FORMS = [(48, 32, 1.0, 1.0, "AUTO"), (32, 48, 1.0, 1.5, "AUTO"), (48, 32, 2.0, 1.0, "VERTICAL")]


# off the axis, the shift depends on the form; the other two modes have none
@pytest.mark.parametrize(
    ("mode", "form"), [*(("OFFAXIS", form) for form in FORMS), ("PARALLEL", FORMS[1]), ("TOE", FORMS[2])]
)
def test_each_eye_sees_as_cycles_eye(mode, form, scene, add_camera, discs, eyes, switch_to_cycles):
    render, stereo = scene.render, add_camera((0.3, 0.2, 10), (0.05, 0, 0.4), lens=50, shift_x=0.05).data.stereo
    render.resolution_x, render.resolution_y, render.pixel_aspect_x, render.pixel_aspect_y = form[:4]
    scene.camera.data.sensor_fit = form[4]
    stereo.convergence_mode, stereo.interocular_distance, stereo.convergence_distance = mode, 0.8, 6.0
    scene.surfel_splatting.samples = 32
    ours = [picture[..., 3] for picture in eyes()]
    scene.cycles.pixel_filter_type = "BOX"
    switch_to_cycles(samples=128, filter_width=1.0)
    truth = [picture[..., 3] for picture in eyes()]
    assert np.abs(truth[0] - truth[1]).max() > 0.5
    for mine, other in zip(ours, truth, strict=True):
        assert 0.02 < other.mean() < 0.9
        assert np.abs(mine - other).mean() < 0.005
        assert np.abs(mine - other).max() < 0.15


def test_each_of_several_cameras_is_its_own_still(scene, add_camera, discs, eyes, picture):
    cameras = [add_camera((x, 0.2, 10), lens=lens) for x, lens in ((0.3, 50), (-0.6, 70))]
    stills = []
    scene.render.use_multiview = False
    for scene.camera in cameras:
        stills.append(picture())
    cameras[0].name, cameras[1].name = "Camera_L", "Camera_R"
    scene.render.use_multiview, scene.render.views_format = True, "MULTIVIEW"
    scene.camera = cameras[0]
    for seen, still in zip(eyes(), stills, strict=True):
        assert still.any()
        np.testing.assert_array_equal(seen, still)


def test_a_border_shows_each_eyes_part(scene, add_camera, discs, eyes):
    add_camera((0.3, 0.2, 10)).data.stereo.interocular_distance = 0.8
    whole = eyes()
    render = scene.render
    render.use_border = render.use_crop_to_border = True
    render.border_min_x, render.border_max_x, render.border_min_y, render.border_max_y = 0.25, 0.75, 0.25, 0.75
    for part, all_of_it in zip(eyes(), whole, strict=True):
        assert part.any()
        assert np.count_nonzero(np.abs(part - all_of_it[8:24, 8:24]).max(axis=2) > 1e-4) <= 1
