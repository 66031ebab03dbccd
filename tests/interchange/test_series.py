# SPDX-License-Identifier: GPL-3.0-or-later
"""Numbered files are the frames of an animation, by the last number in their names."""

import pytest

from splat_addon.interchange.series import file_numbered, numbered_files


def found(folder, *names, chosen):
    for name in names:
        (folder / name).touch()
    return {number: path.name for number, path in numbered_files(folder / chosen).items()}


def test_the_last_number_in_a_name_counts(tmp_path):
    names = "a2_08.copc.laz", "a2_9.copc.laz", "a2_10.copc.laz", "a3_11.copc.laz", "a2_12.laz", "a2_.copc.laz"
    assert found(tmp_path, *names, chosen="a2_9.copc.laz") == {8: names[0], 9: names[1], 10: names[2]}


def test_a_name_without_a_number_is_no_series(tmp_path):
    assert found(tmp_path, "room.e57", "room1.e57", chosen="room.e57") == {}
    assert found(tmp_path, "7.ply", "b7.ply", chosen="7.ply") == {7: "7.ply"}  # a suffix is none of the name


def test_the_ends_stay_and_a_gap_is_told(tmp_path):
    found(tmp_path, "1.ply", "2.ply", "4.ply", chosen="1.ply")
    files = numbered_files(tmp_path / "4.ply")
    assert [file_numbered(files, n).name for n in (-5, 1, 4, 9)] == ["1.ply", "1.ply", "4.ply", "4.ply"]
    with pytest.raises(ValueError, match="no file number 3, though there are 1 to 4"):
        file_numbered(files, 3)
