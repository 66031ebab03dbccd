# SPDX-License-Identifier: GPL-3.0-or-later
"""Ordinary point files from other programs can be read."""

import gzip

import numpy as np
import plyfile
import pytest

from splat_addon.interchange import Points, read_contents
from splat_addon.interchange.columns import display_color


@pytest.mark.parametrize("text", [False, True])
@pytest.mark.parametrize("byte_order", ["<", ">"])
def test_positions_normals_radii_and_byte_colours_are_read(tmp_path, text, byte_order):
    row = [(n, "f4") for n in ("x", "y", "z", "nx", "ny", "nz", "radius")]
    row += [(n, "u1") for n in ("red", "green", "blue")]
    rows = np.array([(1, 2, 3, 0, 0, 1, 0.5, 0, 188, 255), (4, 5, 6, 1, 0, 0, 0.25, 255, 0, 0)], row)
    face = np.array([([0, 1, 1],)], [("vertex_indices", "i4", (3,))])
    elements = [plyfile.PlyElement.describe(rows, "vertex"), plyfile.PlyElement.describe(face, "face")]
    plyfile.PlyData(elements, text=text, byte_order=byte_order).write(tmp_path / "p.ply")
    points = read_contents(tmp_path / "p.ply")
    assert isinstance(points, Points)
    assert points.positions.tolist() == [[1, 2, 3], [4, 5, 6]]
    assert points.normals.tolist() == [[0, 0, 1], [1, 0, 0]]
    assert points.radii.tolist() == [0.5, 0.25]
    assert np.allclose(points.colors, [(0, 0.5028865, 1, 1), (1, 0, 0, 1)])


def test_many_numbers_of_two_bytes_are_decoded_as_few_are():
    few = np.array([0, 1, 2570, 65535], np.uint16)
    colors = [
        display_color({name: column for name in ("red", "green", "blue")})[0] for column in (few, np.tile(few, 20_000))
    ]
    assert (colors[1] == np.tile(colors[0], (20_000, 1))).all() and (np.diff(colors[0][:, 0]) > 0).all()


def test_what_is_not_in_the_file_is_none(ply):
    head = ["format ascii 1.0", "element vertex 1", *(f"property double {n}" for n in "xyz")]
    points = read_contents(ply(head, b"1 2 3"))
    assert points.normals is points.radii is points.colors is None


COLORED = ["format ascii 1.0", "element vertex 2", *(f"property float {n}" for n in "xyz")]


def floats_of(ply, rows, kind="float", **options):
    return read_contents(ply([*COLORED, *(f"property {kind} {n}" for n in "rgba")], rows), **options)


@pytest.mark.parametrize("kind", ["float", "double"])
@pytest.mark.parametrize("white", [1, 255, 65535])
def test_float_colours_are_display_values_from_0_to_their_white(ply, kind, white):
    """As Blender's own import takes them, where white is 1; what was assumed is said."""
    rows = f"0 0 0 {0.5 * white} {0.25 * white} {white} 0.5\n0 0 0 0 0 0 1\n".encode()
    read = floats_of(ply, rows, kind)
    assert np.allclose(read.colors, [(0.21404114, 0.0508761, 1, 0.5), (0, 0, 0, 1)])
    assert read.said == (f"Took the float colours of 2 points as display values (sRGB), where white is {white:g}",)


def test_float_colours_are_scene_linear_if_the_caller_says_so(ply):
    read = floats_of(ply, b"0 0 0 0.25 200 0 0.5\n0 0 0 0 0 0 1\n", float_colors="LINEAR")
    assert np.allclose(read.colors[0], (0.25, 200, 0, 0.5)) and read.said[0].endswith("of 2 points as scene-linear")
    with pytest.raises(ValueError, match="DISPLAY, LINEAR, not 'SRGB'"):
        floats_of(ply, b"", float_colors="SRGB")


def test_a_few_bright_values_do_not_darken_all_others(ply):
    head = ["format ascii 1.0", "element vertex 100", *(f"property float {n}" for n in "xyzrgb")]
    read = read_contents(ply(head, b"0 0 0 1 1 1\n" * 99 + b"0 0 0 50 1 1\n"))
    assert np.allclose(read.colors[0], 1)


def test_the_white_of_long_integers_is_said(ply):
    head = [*COLORED, *(f"property ushort {n}" for n in ("red", "green", "blue"))]
    read = read_contents(ply(head, b"0 0 0 65535 0 0\n0 0 0 1 2 3\n"))
    assert read.said == ("Took 65535 as white in the 16-bit colours of 2 points",)


def test_what_is_passed_over_or_left_out_is_said_with_its_number(ply):
    head = [*COLORED, "property uchar red", "property float quality", "property int flags", "element face 1"]
    read = read_contents(ply([*head, "property list uchar int i"], b"0 0 0 1 2 3\n0 0 1 1 2 3\n3 0 1 1\n"))
    assert read.said == (
        "Passed over 2 properties that surfels do not have: quality, flags",
        "Left out what is not points: 1 'face'; to convert faces, import them as a mesh",
    )


@pytest.mark.parametrize("kind", ["uchar", "ushort", "short", "uint", "int"])
def test_white_is_255_in_integers_of_any_type(ply, kind):
    head = ["format ascii 1.0", "element vertex 2", *(f"property float {n}" for n in "xyz")]
    head += [f"property {kind} {n}" for n in ("red", "green", "blue", "alpha")]
    colors = read_contents(ply(head, b"0 0 0 0 188 255 255\n0 0 0 0 0 0 51\n")).colors
    assert np.allclose(colors, [(0, 0.5028865, 1, 1), (0, 0, 0, 0.2)])


@pytest.mark.parametrize(("kind", "white"), [("ushort", 65535), ("int", 65535), ("short", 32767), ("uint", 2**32 - 1)])
def test_integers_above_255_need_a_larger_white(ply, kind, white):
    """It is the same for all channels: the darker ones too, and the alpha."""
    head = ["format ascii 1.0", "element vertex 1", *(f"property float {n}" for n in "xyz")]
    head += [f"property {kind} {n}" for n in ("red", "green", "blue", "alpha")]
    colors = read_contents(ply(head, f"0 0 0 {white} 0 -5 {white // 5}\n".encode())).colors
    assert np.allclose(colors, (1, 0, 0, 0.2), atol=1e-4)


def test_signed_bytes_are_read_as_the_unsigned_ones_that_were_meant(ply):
    head = ["format binary_little_endian 1.0", "element vertex 1", *(f"property float {n}" for n in "xyz")]
    head += [f"property char {n}" for n in ("red", "green", "blue")]
    body = np.zeros(3, "<f4").tobytes() + bytes((255, 188, 0))
    assert np.allclose(read_contents(ply(head, body)).colors, (1, 0.5028865, 0, 1))


def test_points_after_other_elements_are_found(models, tmp_path):
    """A camera comes before them in the file, and faces with lists after them."""
    (tmp_path / "map.ply").write_bytes(gzip.decompress((models / "rangemap_lato315.ply.gz").read_bytes()))
    vertex = plyfile.PlyData.read(tmp_path / "map.ply")["vertex"]
    assert np.array_equal(read_contents(tmp_path / "map.ply").positions, np.stack([vertex[n] for n in "xyz"], axis=1))


def test_lists_before_the_points_of_a_text_file_are_passed_over(ply):
    head = ["format ascii 1.0", "element face 2", "property list uchar int i", "element vertex 1"]
    head += [f"property float {n}" for n in "xyz"]
    assert read_contents(ply(head, b"3 0 0 0\n4 0 0 0 0\n7 8 9\n")).positions.tolist() == [[7, 8, 9]]
