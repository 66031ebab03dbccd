# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfels can be written and read as flat Gaussians, and Gaussians of other programs can be read."""

import numpy as np
import plyfile
import pytest

from splat_addon.interchange import Gaussians, read_contents, write_gaussian_ply
from splat_addon.quaternions import quaternion_axes

NAMES = ("x", "y", "z", "nx", "ny", "nz", "f_dc_0", "f_dc_1", "f_dc_2", "opacity", "scale_0", "scale_1", "scale_2",
         "rot_0", "rot_1", "rot_2", "rot_3")  # fmt: skip


@pytest.fixture
def gaussian_file(tmp_path):
    """gaussian_file(rows, leave_out=()) -> the path of a file with one Gaussian per dict of properties; the others are
    0.
    """

    def write(rows, leave_out=(), extra=()):
        names = [n for n in (*NAMES, *extra) if n not in leave_out]
        filled = [tuple({"rot_0": 1, **row}.get(n, 0) for n in names) for row in rows]
        values = np.array(filled, [(n, "f4") for n in names])
        plyfile.PlyData([plyfile.PlyElement.describe(values, "vertex")]).write(tmp_path / "g.ply")
        return tmp_path / "g.ply"

    return write


def test_plyfile_reads_the_conventional_values(surfels, tmp_path):
    written = surfels(50, scales=[(0.5, 0.02)] * 50, colors=[(0.2158605, 1, 0, 0.25)] * 50)
    write_gaussian_ply(tmp_path / "g.ply", written)
    vertex = plyfile.PlyData.read(tmp_path / "g.ply")["vertex"]
    assert tuple(p.name for p in vertex.properties) == NAMES
    assert all(p.val_dtype == "f4" for p in vertex.properties)
    shown = [0.5 + 0.28209479177387814 * vertex[f"f_dc_{k}"][0] for k in range(3)]
    assert np.allclose(shown, (128 / 255, 1, 0), atol=1e-3)
    assert np.allclose(1 / (1 + np.exp(-vertex["opacity"])), 0.25)
    assert np.allclose(np.exp(vertex["scale_0"]), 0.25) and np.allclose(np.exp(vertex["scale_1"]), 0.01)
    assert np.allclose(np.exp(vertex["scale_2"]), 1e-5)


@pytest.mark.parametrize("count", [0, 1, 500])
def test_surfels_come_back_to_float32(surfels, tmp_path, count):
    written = surfels(count, materials=np.zeros(count))
    write_gaussian_ply(tmp_path / "g.ply", written)
    read = read_contents(tmp_path / "g.ply")
    assert isinstance(read, Gaussians) and (read.total, read.not_flat, read.unusable) == (count, 0, 0)
    for exact in ("positions", "rotations", "normals"):
        assert np.array_equal(getattr(read.surfels, exact), getattr(written, exact)), exact
    assert np.allclose(read.surfels.scales, written.scales, rtol=1e-6, atol=0)
    assert np.allclose(read.surfels.colors, written.colors, rtol=2e-6, atol=1e-7)


def test_opaque_surfels_come_back_opaque(surfels, tmp_path):
    write_gaussian_ply(tmp_path / "g.ply", surfels(2, colors=[(1, 1, 1, 1), (1, 1, 1, 0)]))
    assert np.allclose(read_contents(tmp_path / "g.ply").surfels.colors[:, 3], (1, 0), atol=3e-9)
    assert np.isfinite(plyfile.PlyData.read(tmp_path / "g.ply")["vertex"]["opacity"]).all()


@pytest.mark.parametrize("thin", [0, 1, 2])
def test_the_thin_axis_becomes_the_normal(gaussian_file, thin):
    sigmas = np.roll([1e-3, 0.5, 2.0], thin)
    rotation = np.array([0.5, 0.1, -0.7, 0.3]) / np.sqrt(0.84)
    row = {f"scale_{k}": np.log(s) for k, s in enumerate(sigmas)} | {f"rot_{k}": r for k, r in enumerate(rotation)}
    surfels = read_contents(gaussian_file([row])).surfels
    axes = np.array(quaternion_axes(rotation[None]))[:, 0]
    for half_axis, axis in zip(surfels.half_axes(), np.roll(np.arange(3), -thin)[1:], strict=True):
        assert np.allclose(half_axis[0], 2 * sigmas[axis] * axes[axis], atol=1e-5)
    assert np.allclose(surfels.normals, axes[thin], atol=1e-6)


@pytest.mark.parametrize(("flatness", "kept"), [(0.05, 1), (0.15, 2), (1.0, 3)])
def test_only_gaussians_flat_enough_are_kept_and_the_others_counted(gaussian_file, flatness, kept):
    path = gaussian_file([{"scale_2": np.log(ratio)} for ratio in (0.01, 0.1, 0.9)])
    read = read_contents(path, flatness)
    assert (len(read.surfels), read.not_flat) == (kept, 3 - kept)


def test_gaussians_with_two_scales_are_all_flat(gaussian_file):
    read = read_contents(gaussian_file([{"scale_0": -3, "scale_1": -4}], leave_out=("scale_2", "nx", "ny", "nz")), 0.0)
    assert np.allclose(read.surfels.scales, 2 * np.exp([-3, -4]))
    assert np.allclose(read.surfels.normals, (0, 0, 1))


def test_numbers_that_cannot_be_are_counted(gaussian_file):
    bad = [{"scale_0": 1e30}, {"scale_1": np.nan}, {"rot_0": 0}, {"x": np.inf}, {"f_dc_0": np.nan}]
    flat = {"scale_2": -9}
    read = read_contents(gaussian_file([flat, *({**flat, **row} for row in bad)]))
    assert (read.total, len(read.surfels), read.unusable, read.not_flat) == (6, 1, 5, 0)


SH, RGB = 0.28209479177387814, [f"f_dc_{k}" for k in range(3)]
WHOLE = {
    "x": 1,
    "scale_0": np.log(0.4),
    "scale_1": np.log(0.1),
    "scale_2": -9,
    "opacity": -1,
    "rot_0": 0.8,
    "rot_1": 0.6,
}
WHOLE |= {f"f_dc_{k}": (v / 255 - 0.5) / SH for k, v in enumerate((200, 60, 0))}

#: other forms of the same Gaussian: property -> value, and what is not there
FORMS = {
    "rgb": ({"red": 200, "green": 60, "blue": 0}, RGB),
    "diffuse": ({"diffuse_red": 200, "diffuse_green": 60, "diffuse_blue": 0}, RGB),
    "float rgb": ({"r": 200 / 255, "g": 60 / 255, "b": 0}, RGB),
    "rgba": ({"red": 200, "green": 60, "blue": 0, "alpha": 255 / (1 + np.e)}, [*RGB, "opacity"]),
    "alpha beside f_dc": ({"alpha": 1 / (1 + np.e)}, ["opacity"]),
    "letters": (
        {f"scale_{n}": WHOLE[f"scale_{k}"] for k, n in enumerate("xyz")} | {"rot_w": 0.8, "rot_x": 0.6},
        [*(f"scale_{k}" for k in range(3)), *(f"rot_{k}" for k in range(4))],
    ),
    "no normals": ({}, ["nx", "ny", "nz"]),
}


@pytest.mark.parametrize("form", FORMS)
def test_other_programs_forms_of_a_gaussian_are_the_same_surfel(gaussian_file, form):
    values, missing = FORMS[form]
    letters = ["rot_y", "rot_z"] if form == "letters" else []
    whole = read_contents(gaussian_file([WHOLE])).surfels
    read = read_contents(gaussian_file([WHOLE | values], leave_out=missing, extra=[*values, *letters])).surfels
    for name, array in whole.arrays().items():
        assert np.allclose(getattr(read, name), array, atol=2e-6), name
    assert np.allclose(read.scales, (0.8, 0.2)) and np.allclose(read.colors[0, 3], 1 / (1 + np.e))


@pytest.mark.parametrize(
    ("missing", "sentence"),
    [
        (RGB, "Took white as the colour of 1 Gaussians, which have none"),
        (["opacity"], "Took 1 Gaussians as opaque, because they have no opacity"),
        ([f"rot_{k}" for k in range(4)], "Took the Gaussians as bare points, because they have no rot_0 rot_1"),
        (["scale_0"], "Took the Gaussians as bare points, because they have no scale_0"),
    ],
)
def test_what_gaussians_lack_is_said(gaussian_file, missing, sentence):
    said = read_contents(gaussian_file([WHOLE], leave_out=missing)).said
    assert any(each.startswith(sentence) for each in said)


def test_bare_points_keep_the_colours_and_opacities_of_gaussians(gaussian_file):
    read = read_contents(gaussian_file([WHOLE], leave_out=["rot_0"]))
    assert np.allclose(read.colors, [(0.57758, 0.04519, 0, 1 / (1 + np.e))], atol=1e-5)


def test_the_filter_of_mip_splatting_widens_gaussians_and_makes_them_fainter(gaussian_file):
    row = WHOLE | {"scale_0": np.log(0.3), "scale_1": np.log(0.4), "filter_3D": 0.4}
    surfels = read_contents(gaussian_file([row], extra=["filter_3D"]), 1.0).surfels
    assert np.allclose(np.sort(surfels.scales), np.sort(2 * np.sqrt([0.4**2 + 0.3**2, 0.4**2 + 0.4**2])))
    lost = (0.3 / 0.5) * (0.4 / np.sqrt(0.32)) * (np.exp(-9) / np.hypot(np.exp(-9), 0.4))
    assert np.allclose(surfels.colors[0, 3], lost / (1 + np.e), rtol=1e-4)


def test_sizes_that_seem_to_be_no_logarithms_are_doubted(gaussian_file):
    rows = [WHOLE | {f"scale_{k}": v for k, v in enumerate((0.02, 0.01, 0.001))} | {"x": x} for x in (1, 2)]
    assert read_contents(gaussian_file(rows)).said[0].startswith("Took scale_0 scale_1 scale_2 of 2 Gaussians as log")
    assert not read_contents(gaussian_file([WHOLE, WHOLE])).said


def test_neural_gaussians_are_told_apart(gaussian_file):
    with pytest.raises(ValueError, match="neural Gaussians"):
        read_contents(gaussian_file([WHOLE], extra=["f_anchor_feat_0"]))


def test_view_dependent_colour_is_reported(gaussian_file):
    path = gaussian_file([{"scale_2": -9}], extra=[f"f_rest_{k}" for k in range(45)])
    assert read_contents(path).view_dependent == 45


def test_a_flatness_outside_its_range_is_an_error(gaussian_file):
    with pytest.raises(ValueError, match="flatness must be a number from 0 to 1, not 2"):
        read_contents(gaussian_file([{}]), 2)


def places(surfels):
    return surfels.positions.astype(float) + surfels.origin


def test_survey_coordinates_are_written_relative_to_an_offset_that_the_file_names(surfels, tmp_path):
    parts = [surfels(50, origin=(403123.2656, 5604987.27, 112)), surfels(50, origin=(403223.5, 5604987.27, 112))]
    [said] = write_gaussian_ply(tmp_path / "g.ply", parts)
    data = plyfile.PlyData.read(tmp_path / "g.ply")
    version, offset = data.comments
    assert version == "surfel_splatting 1" and all(float(value).is_integer() for value in offset.split()[1:])
    assert offset.startswith("offset 403174.0 5604987.0") and "relative to 403174 5604987" in said
    assert all(np.abs(data["vertex"][n]).max() < 60 for n in "xyz")
    read, exact = read_contents(tmp_path / "g.ply"), np.concatenate([places(part) for part in parts])
    assert np.abs(places(read.surfels) - exact).max() < 1e-5 and not read.said


def test_what_float32_holds_is_written_where_it_is(surfels, tmp_path):
    assert write_gaussian_ply(tmp_path / "g.ply", surfels(50, origin=(100.1, 0, 0))) == []
    data = plyfile.PlyData.read(tmp_path / "g.ply")
    assert not data.comments and np.allclose(data["vertex"]["x"], 100.1 + surfels(50).positions[:, 0], rtol=1e-6)


def test_sets_too_far_apart_for_one_offset_are_told(surfels, tmp_path):
    said = write_gaussian_ply(tmp_path / "g.ply", [surfels(50), surfels(50, origin=(1e9, 0, 0))])
    assert "Rounded positions by up to" in said[1]


def test_coordinates_that_were_rounded_before_they_came_into_the_file_are_doubted(gaussian_file):
    rows = [WHOLE | {"y": 5604987.5 + step} for step in (0, 0.5, 1)]
    assert any(
        "go in steps of 0.5, because it holds coordinates up to 5,6" in s
        for s in read_contents(gaussian_file(rows)).said
    )
    assert not read_contents(gaussian_file([WHOLE, WHOLE | {"y": 3}])).said
