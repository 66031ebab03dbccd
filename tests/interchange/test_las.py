# SPDX-License-Identifier: GPL-3.0-or-later
"""LAS of all versions and point formats, also compressed, gives the numbers that were written."""

import numpy as np
import pytest

from scan_files.formats import OFFSET, SCALE, las_file, las_rows
from splat_addon.interchange import ReadingCancelled, clouds, las, laz, read_contents

COUNT = 700


def rows_of(number, extra=0):
    return las_rows(number, COUNT, extra)


#: point format -> a version that has it
VERSIONS = {0: 0, 1: 1, 2: 2, 3: 2, 4: 3, 5: 3, 6: 4, 7: 4, 8: 4, 9: 4, 10: 4}
#: LAZ by lazrs has no formats 4 and 5.
CASES = [(number, minor, k) for number, minor in VERSIONS.items() for k in (False, True)[: 1 + (number not in (4, 5))]]


@pytest.mark.parametrize(("number", "minor", "is_packed"), CASES)
def test_every_format_gives_what_was_written(read, number, minor, is_packed):
    rows = rows_of(number, extra=3)
    points = read(las_file(rows, number, minor, is_packed))
    expected = np.stack([rows[axis] * s + o for axis, s, o in zip("XYZ", SCALE, OFFSET, strict=True)], 1)
    assert np.array_equal(points.positions, expected)
    assert any(word.startswith("Passed over 3 bytes of each point") for word in points.said)
    is_new, found = number >= 6, points.attributes
    assert np.array_equal(found["intensity"], rows["intensity"])
    assert np.array_equal(found["classification"], rows["class"] if is_new else rows["class"] % 32)
    assert np.array_equal(found["return_number"], rows["returns"] % (16 if is_new else 8))
    assert ("gps_time" in found) == ("gps_time" in rows.dtype.names) and (points.colors is None) == (
        "red" not in rows.dtype.names
    )
    for name, field in {"gps_time": "gps_time", "point_source_id": "source", "user_data": "user"}.items():
        assert name not in found or np.array_equal(found[name], rows[field])
    assert np.allclose(found["scan_angle"], rows["angle"] * (0.006 if is_new else 1.0))
    assert ("infrared" in found) == ("infrared" in rows.dtype.names) and {"point_source_id", "user_data"} <= {*found}


@pytest.mark.parametrize(("most", "white"), [(255, 255), (65535, 65535)])
def test_colours_of_8_and_of_16_bits_are_told_apart_over_the_whole_file(read, monkeypatch, most, white):
    monkeypatch.setattr(las, "PORTION", 100)
    rows = rows_of(2)
    for name in clouds.COLOR:
        rows[name] = 128
    rows["green"][-1] = most
    colors = read(las_file(rows, 2, 2)).colors
    assert colors[-1, 1] == 1 and np.isclose(
        colors[0, 0], ((128 / white + 0.055) / 1.055) ** 2.4 if white == 255 else 128 / white / 12.92
    )


def test_points_without_colours_are_no_black_ones(read):
    rows = rows_of(2)
    for name in clouds.COLOR:
        rows[name] = 0
    points = read(las_file(rows, 2, 2))
    assert points.colors is None and "all of them are black" in points.said[0]


def test_deleted_points_are_left_out_and_counted(read):
    for number, field, bit in ((0, "class", 0x80), (6, "flags", 0x04)):
        rows = rows_of(number)
        rows[field][::7] |= bit
        points = read(las_file(rows, number, 4))
        assert len(points.positions) == COUNT - 100 and "Left out 100 points that the file marks" in points.said[0]


def test_progress_is_told_in_points_and_can_cancel(read, monkeypatch):
    monkeypatch.setattr(las, "PORTION", 300)
    told, data = [], las_file(rows_of(3), 3, 2, True)
    read(data, progress=lambda points, share: told.append((points, share)) or True)
    assert [points for points, _ in told] == [300, 600, 700] and told[-1][1] == 1
    with pytest.raises(ReadingCancelled):
        read(data, progress=lambda points, share: points < 600)


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        (dict(count=2**40), "1,099,511,627,776 points of 33 bytes, but only 23,100 bytes are left"),
        (dict(count=2**40, is_packed=True), "1,099,511,627,776 points, but its chunks have at most 50,000"),
    ],
)
def test_a_count_that_lies_allocates_nothing(read, change, sentence):
    with pytest.raises(ValueError, match=sentence):
        read(las_file(rows_of(6, extra=3), 6, 4, **change))


def test_a_cut_off_file_is_one_sentence(read):
    data = las_file(rows_of(3), 3, 2, True)
    for end in range(4, len(data), len(data) // 40):
        with pytest.raises(ValueError, match=r"cut off|damaged"):
            read(data[:end])


def test_without_the_wheel_a_sentence_says_what_to_do(read, monkeypatch):
    monkeypatch.setattr(laz, "lazrs", None)
    assert len(read(las_file(rows_of(1), 1, 2)).positions) == COUNT
    with pytest.raises(ValueError, match=r"takes the module lazrs, .* or save the file as LAS"):
        read(las_file(rows_of(1), 1, 2, True))


def test_files_of_other_programs_hold_the_same_points_in_three_formats(scans):
    """A COPC file of several pages, LAS with extra bytes, and PTX were made of the same scan."""
    files = ("simple_with_page.copc.laz", "extrabytes.las", "1.2-with-color.ptx")
    places = [read_contents(scans / name).positions for name in files]
    places[0][:, 2] *= 3937 / 1200  # of feet, as only this one says
    first, *others = (each[np.lexsort(each.T)] for each in places)
    assert len(first) == 1065 and all(np.abs(other - first).max() < 1e-6 for other in others)
