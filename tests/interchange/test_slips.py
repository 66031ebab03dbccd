# SPDX-License-Identifier: GPL-3.0-or-later
"""Slips of other programs whose meaning is plain are read as they were meant."""

import numpy as np
import pytest

from splat_addon.interchange import read_contents

POINTS = np.float32([(0.5, -2, 3), (4, 5e-3, 6), (10, 11, 1234.5)])  # in binary, the first byte after the header is 0
HEAD = ["ply", "format ascii 1.0", "element vertex 3", *(f"property float {n}" for n in "xyz"), "end_header"]
ROWS = [" ".join(f"{value:g}" for value in row) for row in POINTS]


def file_of(head, rows, end="\n"):
    return "".join(line + end for line in (*head, *rows)).encode()


def replaced(old, new):
    return [line.replace(old, new) for line in HEAD]


SLIPS = {
    "CR": file_of(HEAD, ROWS, "\r"),
    "CR LF": file_of(HEAD, ROWS, "\r\n"),
    "BOM": b"\xef\xbb\xbf" + file_of(HEAD, ROWS),
    "blank line before ply": b"\n" + file_of(HEAD, ROWS),
    "blank line after header": file_of(HEAD, ["", *ROWS]),
    "blank lines between, CR LF": file_of(HEAD, [each for row in ROWS for each in (row, "")], "\r\n"),
    "comments between": file_of(HEAD, ["# a", ROWS[0], "comment b", *ROWS[1:], "// c"]),
    "tabs": file_of(replaced(" ", "\t"), [row.replace(" ", "\t") for row in ROWS]),
    "capitals": file_of([line.upper() for line in HEAD], ROWS),
    "other name of the element": file_of(replaced("vertex", "points"), ROWS),
    "wrapped": file_of(HEAD, " ".join(ROWS).split()),
    "on one line": file_of(HEAD, [" ".join(ROWS)]),
    "Fortran": file_of(HEAD, [ROWS[0].replace("0.5", "5.0D-01"), *ROWS[1:]]),
    "long integers": file_of(
        [*HEAD[:-1], "property long id", "property uint64 b", HEAD[-1]],
        [f"{row} 3 18446744073709551615" for row in ROWS],
    ),
    "wrapped, before faces": file_of(
        [*HEAD[:-1], "element face 1", "property list uchar int i", HEAD[-1]], [*" ".join(ROWS).split(), "3 0 1 2"]
    ),
}


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("slip", SLIPS)
def test_a_slip_is_read(tmp_path, slip):
    (tmp_path / "a.ply").write_bytes(SLIPS[slip])
    assert np.array_equal(np.float32(read_contents(tmp_path / "a.ply").positions), POINTS)


@pytest.mark.parametrize("end", ["\n", "\r\n", "\r"])
@pytest.mark.parametrize("first", [0, 10, 13])
def test_binary_data_begin_right_after_any_line_end(tmp_path, end, first):
    """Also where the first byte of the data is itself a line end."""
    values = np.frombuffer(bytes([first, 0, 0, 63]) + POINTS.tobytes()[4:], "<f4").reshape(3, 3)
    head = [line.replace("ascii", "binary_little_endian") for line in HEAD]
    (tmp_path / "a.ply").write_bytes(file_of(head, [], end) + values.tobytes())
    assert np.array_equal(np.float32(read_contents(tmp_path / "a.ply").positions), values)


@pytest.mark.parametrize(("word", "value"), [("-1.#IND00", np.nan), ("-nan(ind)", np.nan), ("1.#INF", np.inf)])
def test_what_windows_writes_for_no_number_is_no_number(tmp_path, word, value):
    (tmp_path / "a.ply").write_bytes(file_of(HEAD, [f"{word} 2 3", *ROWS[1:]]))
    assert np.array_equal(read_contents(tmp_path / "a.ply").positions[0], [value, 2, 3], equal_nan=True)
