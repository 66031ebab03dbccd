# SPDX-License-Identifier: GPL-3.0-or-later
"""PTX, and text with a point on each line, give the points and say what was taken for what."""

import numpy as np
import pytest

from scan_files.formats import ptx_scan
from splat_addon.interchange import read_contents, text_columns_of, text_rows


@pytest.mark.parametrize(
    ("text", "names"),
    [
        ("1 2 3\n4 5 6\n", "x y z"),
        ("2\r\n1 2 3 -900\r\n4 5 6 70\r\n", "x y z intensity"),
        ("1 2 3 255 0 0\n4 5 6 0 0 255\n", "x y z red green blue"),
        ("1 2 3 0 0 1\n4 5 6 0 0.6 0.8\n", "x y z nx ny nz"),
        ("1 2 3 0.5 10 20 30 0 0 1\n4 5 6 0.5 10 20 30 0 1 0\n", "x y z intensity red green blue nx ny nz"),
        ("1 2 3 4 5\n4 5 6 7 8\n", "x y z column_4 column_5"),
        ("//X Y Z Intensity Classification\n1 2 3 4 5\n4 5 6 7 8\n", "x y z intensity Classification"),
        ("# made by hand\n\n1,2,3\n\n4,5,6\n", "x y z"),
        ('"Height [m]","Easting","Northing","R","G","B"\n3,1,2,9,8,7\n6,4,5,9,8,7\n', "z x y red green blue"),
        ("\xef\xbb\xbfX;Y;Z\n1,0;2,0;3,0\n4,0;5,0;6,0;\n", "x y z"),
        ("1\t2\t3\n4\t5\t6\n", "x y z"),
    ],
)
def test_columns_are_found_and_told(read, text, names):
    points = read(text)
    assert points.positions.tolist() == [[1, 2, 3], [4, 5, 6]]
    assert any(each.endswith(f", as {names}") for each in points.said), points.said
    assert (points.colors is not None) == ("red" in names) and (points.normals is not None) == ("nx" in names)
    assert ("intensity" in points.attributes) == ("intensity" in names)
    assert ("classification" in points.attributes) == ("Classification" in names)


def test_whole_colours_are_bytes_and_those_up_to_1_are_not(read):
    assert read("1 2 3 255 0 51\n1 2 3 1 1 1\n").colors[0].tolist() == pytest.approx([1, 0, 0.0331048, 1], rel=1e-5)
    assert read("1 2 3 1 0 0.2\n1 2 3 1 1 1\n").colors[0].tolist() == pytest.approx([1, 0, 0.0331048, 1], rel=1e-5)


def test_another_count_than_the_file_says_is_told(read):
    assert "Read 2 points, where the file says that it has 3" in read("3\n1 2 3\n4 5 6\n").said


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("1 2 3\n4 5\n", "Line 2 of the file has 2 numbers where others have 3, '4 5'; correct"),
        ("1 2 3\n4 5", "'4 5'; the file ends within it: copy it again"),
        ("1 2 3\n4 5 6\nhello you there\n", "Line 3 of the file is not all numbers, 'hello you there'"),
        ("hello\n", "no file of points"),
        ("1 2\n3 4\n", "no file of points"),
    ],
)
def test_a_wrong_line_is_named(read, monkeypatch, text, sentence):
    monkeypatch.setattr(text_rows, "PORTION", 2)
    with pytest.raises(ValueError, match=sentence):
        read(text)


TURN = np.array([[0, -1, 0, 600000], [1, 0, 0, 800000], [0, 0, 1, 50], [0, 0, 0, 1.0]])
GRID = np.array(
    [[1, 2, 3, 0.5, 10, 20, 30], [0, 0, 0, 0.5, 0, 0, 0], [4, 5, 6, 0.25, 255, 0, 0], [7, 8, 9, 1, 0, 0, 9]]
)


def test_ptx_has_several_scans_in_common_coordinates_with_their_scanners_places(read, monkeypatch):
    monkeypatch.setattr(text_rows, "PORTION", 2)
    points = read(ptx_scan(GRID, 2, TURN) + ptx_scan(GRID[:, :4], 1, np.eye(4)))
    own = GRID[[0, 2, 3], :3]
    turned = np.stack([600000 - own[:, 1], 800000 + own[:, 0], 50 + own[:, 2]], axis=1)
    assert np.array_equal(points.positions, np.concatenate([turned, own]))
    assert points.attributes["scan"].tolist() == [0, 0, 0, 1, 1, 1]
    assert points.attributes["intensity"].tolist() == [0.5, 0.25, 1] * 2
    assert points.scanners().tolist() == [[600000, 800000, 50]] * 3 + [[0, 0, 0]] * 3
    assert np.isnan(points.colors[3:, :3]).all() and points.colors[1].tolist() == [1, 0, 0, 1]
    assert "Passed over 2 cells of the scanner's grid that have no point" in points.said


def test_a_scanner_that_is_far_from_its_points_is_no_place(read):
    """Programs that convert other formats write points in common coordinates, and 0 as the place."""
    far = GRID + np.array([600000, 800000, 50, 0, 0, 0, 0])
    points = read(ptx_scan(far, 2, np.eye(4)) + ptx_scan(GRID, 2, np.eye(4)))
    assert np.isnan(points.scanners()[:4]).all() and (points.scanners()[4:] == 0).all()
    assert read(ptx_scan(far, 2, np.eye(4))).scanners() is None


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        (
            lambda text: text.replace("2\n2\n", "2\n99999999999\n", 1),
            "says that it has 199,999,999,998 points, but only",
        ),
        (lambda text: text.replace("2\n2\n", "2\n-2\n", 1), "no size of a grid"),
        (lambda text: text[: text.rindex("\n", 0, -9)], "but only 3 follow"),
        (lambda text: text + "2\n2\n0 0 0\n", "lacks its ten lines"),
        (lambda text: text.replace("255 0 0", "255 0"), "Line 13 of the file has 6 numbers where others have 7"),
    ],
)
def test_damaged_ptx_is_one_sentence(read, change, sentence):
    with pytest.raises(ValueError, match=sentence):
        read(change(ptx_scan(GRID, 2, TURN)))


def test_the_user_says_what_columns_are(tmp_path):
    (tmp_path / "scan").write_text("".join(f"{k} 7 {k * 2} 1 0.5 {k * 3}\n" for k in range(9)))
    assert text_columns_of(tmp_path / "scan")[:3] == ("x", "y", "z")
    found = read_contents(tmp_path / "scan", text_columns=("x", "-", "Height", "intensity", "-", "y"))
    assert found.positions[2].tolist() == [2, 6, 4] and found.attributes["intensity"].tolist() == [1] * 9
    assert "as chosen, as x column_2 z intensity column_5 y" in found.said[0]
    for wrong in (("x", "y", "z"), ("x", "y", "z", "-", "-", "x"), ("x", "y", *"----")):
        with pytest.raises(ValueError, match="The text has 6 columns, which must be named once each"):
            read_contents(tmp_path / "scan", text_columns=wrong)


def test_other_files_have_no_columns_of_text(tmp_path):
    (tmp_path / "scan").write_text(ptx_scan(np.ones((4, 3)), 2, np.eye(4)))
    assert text_columns_of(tmp_path / "scan") == ()


def test_several_counts_are_no_points(tmp_path):
    rows = [f"{k} {k % 3} 1 9" for k in range(12)]
    (tmp_path / "scan.pts").write_text("\n".join(["5", *rows[:5], " 7 ", *rows[5:]]))
    found = read_contents(tmp_path / "scan.pts")
    assert len(found.positions) == 12 and not any("says that it has" in each for each in found.said)
    (tmp_path / "scan.pts").write_text("\n".join(["5", *rows[:5], "8", *rows[5:]]))
    assert "Read 12 points, where the file says that it has 13" in read_contents(tmp_path / "scan.pts").said
