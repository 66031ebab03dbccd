# SPDX-License-Identifier: GPL-3.0-or-later
"""Places of entries are arrays in the order of the entries."""

from splat_addon.blender.export.places import in_order, parts_at


def test_rows_of_several_kinds_come_in_their_order():
    rows, of = in_order([[0, 3, 4], [], [1, 2, 5]])
    assert rows.tolist() == [0, 1, 2, 3, 4, 5] and of.tolist() == [0, 2, 2, 0, 0, 2]
    assert [each.tolist() for each in in_order([])] == [[], []]


def test_what_is_in_several_parts_is_there_part_by_part():
    rows, parts = parts_at(in_order([[0, 2], [1], [3]])[1], [2, 1, 0])
    assert rows.tolist() == [0, 0, 1, 2, 2] and parts.tolist() == [0, 1, 2, 0, 1]
