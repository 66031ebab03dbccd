# SPDX-License-Identifier: GPL-3.0-or-later
"""Few points of a large scan are even, and of LAS, LAZ and COPC the others are not read."""

import struct

import numpy as np
import pytest

from scan_files.formats import copc_file, las_file, las_rows
from splat_addon.interchange import las, point_pieces, read_contents


def line(count, packed):
    """A file of `count` points along x in steps of 0.001, whose intensity is their number."""
    rows = np.zeros(count, las_rows(0, 1).dtype)
    rows["X"], rows["intensity"] = np.arange(count), np.arange(count) % 60000
    return las_file(rows, 0, 2, packed, scale=(0.001,) * 3, offset=(0, 0, 0))


@pytest.mark.parametrize("packed", [False, True])
def test_points_of_las_lie_everywhere_and_are_right(packed, tmp_path, monkeypatch):
    (tmp_path / "scan").write_bytes(line(260_000, packed))
    read, count = las._table, []
    monkeypatch.setattr(las, "_table", lambda rows, header: count.append(len(rows)) or read(rows, header))
    points = read_contents(tmp_path / "scan", most=600)
    number = np.rint(points.positions[:, 0] * 1000).astype(int)
    assert 300 <= len(number) <= 600 and sum(count) < 20 * 600
    assert np.array_equal(points.attributes["intensity"], number % 60000)
    assert np.diff(number).max() < 4 * 260_000 / len(number), "there is a gap"
    assert f"Took {len(number)} of 260,000 points, evenly" in points.said


def test_of_more_points_than_are_decompressed_all_chunks_have_some(tmp_path, monkeypatch):
    monkeypatch.setattr(las, "_MOST_DECOMPRESSED", 26_000)
    (tmp_path / "scan").write_bytes(line(260_000, True))
    number = np.rint(read_contents(tmp_path / "scan", most=600).positions[:, 0] * 1000).astype(int)
    assert set(number // 50_000) == {0, 1, 2, 3, 4, 5} and (number % 50_000).max() < 5000


def test_a_file_with_fewer_points_is_whole(tmp_path):
    (tmp_path / "scan").write_bytes(line(500, True))
    points = read_contents(tmp_path / "scan", most=500)
    assert len(points.positions) == 500 and not any("evenly" in each for each in points.said)


@pytest.mark.parametrize("pages", [1, 3])
def test_the_coarsest_levels_of_copc_are_read(pages, tmp_path):
    nodes, levels = [], [0, 2, 1, 1, 2, 2]
    for k, level in enumerate(levels):
        nodes.append(np.zeros(50 + k, las_rows(6, 1).dtype))
        nodes[-1]["X"], nodes[-1]["intensity"] = np.arange(50 + k), 100 + level
    (tmp_path / "scan").write_bytes(copc_file(nodes, levels, pages))
    assert len(read_contents(tmp_path / "scan").positions) == sum(map(len, nodes))
    for most, deepest in ((50, 0), (60, 1), (170, 2)):
        found = read_contents(tmp_path / "scan", most=most).attributes["intensity"]
        assert np.unique(found).tolist() == list(range(100, 101 + deepest))
        assert most / 2 <= len(found) <= most


def test_damaged_levels_end_in_a_sentence(tmp_path):
    rows = [np.zeros(40, las_rows(6, 1).dtype)] * 2
    data = copc_file(rows, [0, 1])
    at = 375 + 54 + 40
    root, length = struct.unpack_from("<2Q", data, at)
    for change in (
        {at: struct.pack("<Q", 1 << 40)},
        {at + 8: struct.pack("<Q", length - 1)},
        {root + 16: struct.pack("<Q", 1000)},
        {root + 28: struct.pack("<i", -1), root + 16: struct.pack("<Qi", root, 32)},
    ):
        damaged = bytearray(data)
        for place, what in change.items():
            damaged[place : place + len(what)] = what
        (tmp_path / "scan").write_bytes(damaged)
        with pytest.raises(ValueError, match="octree"):
            read_contents(tmp_path / "scan", most=10)


def test_other_formats_are_read_whole_and_thinned(tmp_path):
    (tmp_path / "scan").write_text("\n".join(f"{k} 0 1" for k in range(5000)))
    points = read_contents(tmp_path / "scan", most=100)
    assert 50 <= len(points.positions) <= 100 and np.ptp(np.diff(points.positions[:, 0])) == 0
    assert point_pieces(tmp_path / "scan").count == 5000
