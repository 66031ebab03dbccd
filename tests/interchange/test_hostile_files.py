# SPDX-License-Identifier: GPL-3.0-or-later
"""Damaged and hostile files give one sentence each and never take much memory, whatever they claim."""

import tracemalloc

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from splat_addon.interchange import read_contents, write_gaussian_ply, write_ply

XYZ = [f"property float {n}" for n in "xyz"]
LIST = "property list uchar int i"
BINARY, TEXT = "format binary_little_endian 1.0", "format ascii 1.0"


@pytest.mark.parametrize(
    ("head", "body", "sentence"),
    [
        ([BINARY, "element vertex 999999999999", *XYZ], b"\0" * 24, "999,999,999,999 points of 12 bytes, but only 24"),
        ([TEXT, "element vertex 999999999999", *XYZ], b"1 2 3\n", "999,999,999,999 points of 3 numbers"),
        ([TEXT, "element face 99999999999", "element vertex 1", *XYZ], b"1 2 3\n", "cut off or damaged"),
        ([TEXT, *(f"element e{k} {10**18 - 1}" for k in range(12)), "element vertex 1", *XYZ], b"1 2 3\n", "cut off"),
        ([BINARY, "element vertex 2", *XYZ], b"\0" * 23, "cut off or damaged"),
        ([TEXT, "element vertex 2", *XYZ], b"1 2 3\n1 2        \n", "cut off or damaged|cannot be read"),
        ([TEXT, "element vertex 2", *XYZ], b"1 2 3 4 5 6 7\n     ", "Line 8 .* has 7 numbers"),
        ([TEXT, "element vertex 2", *XYZ], b"              \n\n", "but only 0 whole ones follow"),
        ([TEXT, "element vertex 1", *XYZ], b"1 two 3\n", "Line 8 .* has 'two' where a number must be"),
        ([BINARY, "element vertex -1", *XYZ], b"", "a count of 0 or more, not 'element vertex -1'"),
        ([BINARY, "element vertex 1e9", *XYZ], b"", "a count of 0 or more"),
        ([BINARY, "element vertex " + "9" * 5000, *XYZ], b"", "a count of 0 or more"),
        ([BINARY, "element vertex"], b"", "a count of 0 or more"),
        ([TEXT, "element vertex 2", *XYZ], b"1 2 3 0\n4 5 6 0\n", "Line 8 .* has 4 numbers, .* 'x y z'"),
        ([TEXT, "element vertex 2", *XYZ], b"1 2 3 4 5 6\n1 2 3 4 5 6\n", "Line 8 .* has 6 numbers"),
        ([TEXT, "element vertex 1", *XYZ], b"1,5 2 3\n", "'1,5' where .* with a point and blanks between"),
        ([BINARY, "element vertex 1", "property long x"], b"\0" * 99, "'long', which has 4 bytes on some machines"),
        ([BINARY, "element face 0"], b"", "no element 'vertex', .* its elements: 'face'"),
        ([BINARY, "element vertex 0"], b"", "have no properties"),
        ([BINARY, "element vertex 0", "property float x"], b"", "have no y and no z"),
        ([BINARY, "element vertex 1", *XYZ, LIST], b"\0" * 99, "'i' of the PLY file's points is a list"),
        ([BINARY, "element face 1", LIST, "element vertex 1", *XYZ], b"\0" * 99, "has lists and stands before"),
        ([BINARY, "element vertex 1", *XYZ, "property float x"], b"\0" * 99, "two properties 'x'"),
        ([BINARY, "element vertex 1", *XYZ, "element vertex 1"], b"\0" * 99, "names an element twice"),
        ([BINARY, "element vertex 1", "property object x"], b"\0" * 99, "cannot be read, 'property object x'"),
        ([BINARY, "element vertex 1", "property float"], b"\0" * 99, "cannot be read, 'property float'"),
        ([BINARY, "element vertex 1", "property"], b"\0" * 99, "cannot be read, 'property'"),
        ([BINARY, "property float x"], b"", "cannot be read"),
        (["format binary 1.0", "element vertex 0", *XYZ], b"", "format must be one of"),
        (["element vertex 0", *XYZ], b"", "no line 'format'"),
        ([BINARY, "hello"], b"", "no PLY file has, 'hello'"),
        ([BINARY, f"element {'e' * 200_000} 1", *XYZ, "property float x"], b"", "two properties 'x'"),
    ],
)
def test_a_damaged_file_is_one_sentence(ply, head, body, sentence):
    with pytest.raises(ValueError, match=sentence) as raised:
        read_contents(ply(head, body))
    assert len(str(raised.value)) < 300 and "\n" not in str(raised.value)


@pytest.mark.parametrize("content", [b"plyish\n", b"\x89PNG\r\n", b"\0" * 1000])
def test_another_kind_of_file_is_told_so(tmp_path, content):
    (tmp_path / "a.ply").write_bytes(content)
    with pytest.raises(ValueError, match="no file of points that can be read, which are PLY, SPZ, glTF"):
        read_contents(tmp_path / "a.ply")


@pytest.mark.parametrize(
    ("content", "sentence"),
    [
        (b"", "The file is empty; copy it again"),
        (b"\x1f\x8b\x08", "compressed with gzip; unpack it"),
        ("ply\nformat".encode("utf-16"), "UTF-16 text; save it as"),
        (b"version https://git-lfs.github.com/spec/v1", "pointer of Git LFS"),
        (b"<!DOCTYPE html>", "web page"),
    ],
)
def test_what_it_is_instead_is_told(tmp_path, content, sentence):
    (tmp_path / "a.ply").write_bytes(content)
    with pytest.raises(ValueError, match=sentence):
        read_contents(tmp_path / "a.ply")


@pytest.mark.parametrize("content", [b"ply\n", b"ply\ncomment " + b"x" * 10**6, b"ply\n" + b"comment\n" * 10**5])
def test_a_header_without_an_end_is_told_so(tmp_path, content):
    (tmp_path / "a.ply").write_bytes(content)
    with pytest.raises(ValueError, match="does not end with the line 'end_header'"):
        read_contents(tmp_path / "a.ply")


@pytest.mark.parametrize("form", [BINARY, TEXT])
def test_a_small_file_that_claims_much_takes_little_memory(ply, form):
    path = ply([form, "element vertex 4000000000", *XYZ], b"1 2 3\n" * 100)
    tracemalloc.start()
    with pytest.raises(ValueError, match="cut off or damaged"):
        read_contents(path)
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert peak < 2e6


def test_numbers_beyond_float32_are_counted_not_warned_of(ply, recwarn):
    names = ["x", "y", "z", "nx", "ny", "nz", *(f"rot_{k}" for k in range(4)), "scale_0", "scale_1", "material"]
    head = [TEXT, "element vertex 2", *(f"property double {n}" for n in names)]
    body = b"1e300 0 0 0 0 1 1 0 0 0 1 1 nan\n0 0 0 0 0 1 1 0 0 0 1 1 1e300\n"
    stored = read_contents(ply(head, body))
    assert (len(stored.surfels), stored.unusable) == (1, 1) and not recwarn.list


FRAME = ["x", "y", "z", "nx", "ny", "nz", "rot_0", "rot_1", "rot_2", "rot_3", "scale_0", "scale_1"]
LAYOUTS = {
    "surfels": [*FRAME, "material", "red", "green", "blue", "emission_0", "emission_1", "emission_2"],
    "gaussians": [*FRAME, "scale_2", "opacity", "f_dc_0", "f_dc_1", "f_dc_2"],
    "points": [*FRAME[:6], "radius", "red", "green", "blue", "alpha"],
}
DAMAGED = [0, -1, np.nan, np.inf, -np.inf, 1e30, 3e38, 1e-45, 1e300, -1e300, 1e-300, 5e17]


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("kind", ["float", "double"])
@pytest.mark.parametrize("layout", LAYOUTS)
def test_damaged_numbers_are_never_warned_of_by_numpy(ply, layout, kind):
    random, names = np.random.default_rng(5), LAYOUTS[layout]
    for share in np.repeat((0.02, 0.3), 20):
        rows = random.normal(size=(30, len(names)))
        bad = random.random(rows.shape) < share
        rows[bad] = random.choice(DAMAGED, bad.sum())
        with np.errstate(over="ignore"):
            body = rows.astype(kind.replace("float", "<f4").replace("double", "<f8")).tobytes()
        read = read_contents(ply([BINARY, "element vertex 30", *(f"property {kind} {n}" for n in names)], body))
        assert np.isfinite(read.surfels.positions).all() if layout != "points" else read.positions.shape == (30, 3)


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(data=st.data(), gaussian=st.booleans())
def test_bytes_changed_anywhere_give_surfels_or_one_sentence(surfels, tmp_path, data, gaussian):
    path = tmp_path / "a.ply"
    (write_gaussian_ply if gaussian else write_ply)(path, surfels(3))
    content = bytearray(path.read_bytes())
    for _ in range(data.draw(st.integers(1, 4))):
        at = data.draw(st.integers(0, len(content) - 1))
        content[at : at + data.draw(st.integers(0, 3))] = data.draw(st.binary(max_size=4))
    path.write_bytes(content)
    try:
        read = read_contents(path)
    except ValueError as error:
        assert "\n" not in str(error) and str(error).endswith(".")
    else:
        assert np.isfinite(read.surfels.positions).all() if hasattr(read, "surfels") else len(read.positions) <= 3
