# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfels survive a file of their own layout, which other PLY readers can read too."""

import numpy as np
import plyfile
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from splat_addon.interchange import read_contents, read_ply, write_ply
from splat_addon.surfels import Surfels, empty_surfels

FLOATS = st.floats(width=32, allow_nan=False, allow_infinity=False)


@pytest.mark.parametrize("ascii", [False, True])
@pytest.mark.parametrize("count", [0, 1, 1000])
def test_every_bit_comes_back(surfels, assert_same_bits, tmp_path, ascii, count):
    written = surfels(count)
    write_ply(tmp_path / "a.ply", written, ascii=ascii)
    assert_same_bits(read_ply(tmp_path / "a.ply"), written)


def test_an_empty_set_with_optional_fields_comes_back(surfels, tmp_path):
    optional = {"roughness": np.zeros(0), "emission": np.zeros((0, 3)), "uvs": np.zeros((0, 2))}
    write_ply(tmp_path / "a.ply", surfels(0, **optional))
    read = read_ply(tmp_path / "a.ply")
    assert {name: array.shape for name, array in read.arrays().items() if name in optional} == {
        name: values.shape for name, values in optional.items()
    }


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(
    positions=arrays(np.float32, (3, 3), elements=FLOATS),
    scales=arrays(np.float32, (3, 2), elements=st.floats(min_value=2.0**-126, max_value=2.0**126, width=32)),
    colors=arrays(np.float32, (3, 4), elements=FLOATS),
    ascii=st.booleans(),
)
def test_any_finite_float_comes_back(assert_same_bits, tmp_path, positions, scales, colors, ascii):
    frames = {"rotations": [[1, 0, 0, 0]] * 3, "normals": [[0, 0, 1]] * 3, "materials": [0, 1, 2**31 - 1]}
    written = Surfels(positions=positions, scales=scales, colors=colors, **frames)
    write_ply(tmp_path / "a.ply", written, ascii=ascii)
    assert_same_bits(read_ply(tmp_path / "a.ply"), written)


@pytest.mark.parametrize("ascii", [False, True])
def test_an_origin_and_solidity_come_back(surfels, assert_same_bits, tmp_path, ascii):
    written = surfels(100, positions=np.arange(300.0).reshape(100, 3) / 8, origin=(1e7 / 3, -0.1, 0), is_solid=True)
    write_ply(tmp_path / "a.ply", written, ascii=ascii)
    assert_same_bits(read_ply(tmp_path / "a.ply"), written)


def test_far_from_the_origin_other_programs_read_exact_coordinates(surfels, tmp_path):
    write_ply(tmp_path / "a.ply", surfels(100, origin=(1e7, 0, 0)))
    vertex = plyfile.PlyData.read(tmp_path / "a.ply")["vertex"]
    assert np.array_equal(vertex["x"], 1e7 + surfels(100).positions[:, 0].astype(float))


@pytest.mark.parametrize("ascii", [False, True])
def test_plyfile_reads_what_the_table_of_properties_says(surfels, tmp_path, ascii):
    written = surfels(50)
    write_ply(tmp_path / "a.ply", written, ascii=ascii)
    vertex = plyfile.PlyData.read(tmp_path / "a.ply")["vertex"]
    names = [p.name for p in vertex.properties]
    assert names == [
        *("x", "y", "z", "nx", "ny", "nz", "red", "green", "blue", "alpha", "color_0", "color_1", "color_2", "color_3"),
        *("rot_0", "rot_1", "rot_2", "rot_3", "scale_0", "scale_1", "radius", "material"),
    ]
    assert np.array_equal(np.stack([vertex[n] for n in ("x", "y", "z")], 1), written.positions)
    assert np.array_equal(np.stack([vertex[f"rot_{k}"] for k in range(4)], 1), written.rotations)
    assert np.array_equal(vertex["radius"], written.radius)
    assert np.array_equal(vertex["material"], written.materials)


def test_other_programs_see_srgb_in_bytes(surfels, tmp_path):
    write_ply(tmp_path / "a.ply", surfels(3, colors=[(0, 0.2158605, 1, 1), (-1, 0.5, 7, 0.5), (1, 1, 1, 0)]))
    vertex = plyfile.PlyData.read(tmp_path / "a.ply")["vertex"]
    assert [vertex[n].tolist() for n in ("red", "green", "blue", "alpha")] == [
        [0, 0, 255],
        [128, 188, 255],
        [255, 255, 255],
        [255, 128, 0],
    ]


def test_big_endian_and_double_files_of_other_writers_are_read(surfels, assert_same_bits, tmp_path):
    written = surfels(20)
    write_ply(tmp_path / "a.ply", written)
    data = plyfile.PlyData.read(tmp_path / "a.ply")
    rows = data["vertex"].data
    doubles = rows.astype([(n, "f8" if rows.dtype[n].kind == "f" else rows.dtype[n]) for n in rows.dtype.names])
    element = plyfile.PlyElement.describe(doubles, "vertex")
    plyfile.PlyData([element], byte_order=">", comments=data.comments).write(tmp_path / "b.ply")
    assert_same_bits(read_ply(tmp_path / "b.ply"), written)


def test_rows_that_are_no_surfels_are_counted(surfels, tmp_path):
    write_ply(tmp_path / "a.ply", surfels(20))
    data = plyfile.PlyData.read(tmp_path / "a.ply", mmap=False)
    data["vertex"]["x"][3], data["vertex"]["scale_1"][4], data["vertex"]["material"][5] = np.nan, -1, -7
    data.write(tmp_path / "b.ply")
    stored = read_contents(tmp_path / "b.ply")
    assert (len(stored.surfels), stored.unusable) == (17, 3)
    with pytest.raises(ValueError, match="unusable positions, first row 3"):
        read_ply(tmp_path / "b.ply")


def test_a_file_is_not_replaced_by_half_of_another(surfels, assert_same_bits, tmp_path, monkeypatch):
    written = surfels(10)
    write_ply(tmp_path / "a.ply", written)

    def full_disk(*_, **__):
        raise OSError("No space left on device")

    monkeypatch.setattr("splat_addon.interchange.ply_file.np.savetxt", full_disk)
    with pytest.raises(OSError, match="No space"):
        write_ply(tmp_path / "a.ply", empty_surfels(), ascii=True)
    assert_same_bits(read_ply(tmp_path / "a.ply"), written)
    assert [file.name for file in tmp_path.iterdir()] == ["a.ply"]


def test_several_sets_keep_their_places_exactly(surfels, tmp_path):
    parts = [surfels(20, origin=(403123.2656, 5604987.27, 0)), surfels(20), surfels(20, origin=(0, 1e-3, -7e6 / 3))]
    assert write_ply(tmp_path / "a.ply", parts) == []
    vertex = plyfile.PlyData.read(tmp_path / "a.ply")["vertex"]
    exact = np.concatenate([part.positions.astype(float) + part.origin for part in parts])
    assert np.array_equal(np.stack([vertex[n] for n in "xyz"], axis=1), exact)


def test_doubles_of_a_writer_that_names_no_origin_keep_their_digits(surfels, tmp_path):
    written = surfels(20, origin=(403123.2656, 5604987.27, 0))
    write_ply(tmp_path / "a.ply", written)
    data = plyfile.PlyData.read(tmp_path / "a.ply")
    data.comments = []
    data.write(tmp_path / "b.ply")
    read = read_contents(tmp_path / "b.ply").surfels
    assert np.abs(read.positions + read.origin - (written.positions + written.origin)).max() < 1e-6
    assert np.array_equal(read.origin, read.origin.astype(np.float32))
