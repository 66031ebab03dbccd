# SPDX-License-Identifier: GPL-3.0-or-later
"""A file of blocks holds every surfel bit by bit; a damaged or foreign one is refused with a sentence; what fails
leaves nothing behind.
"""

import struct

import numpy as np
import pytest

from splat_addon.runs import ranges
from splat_addon.streaming import BlockFile, WritingCancelled, check, write_blocks
from splat_addon.streaming.layout import PAGE
from splat_addon.surfels import Surfels, empty_surfels

from .conftest import ball, sorted_rows, whole_table


def stored(path):
    """The surfels of a file, without merged ones."""
    file = BlockFile(path)
    blocks, (rows, are_good) = whole_table(file), file.read_rows(np.arange(-(-file.rows // PAGE)))
    assert are_good.all()
    leaves = blocks.first_child == blocks.last_child
    first, last = blocks.first[leaves], blocks.last[leaves]
    rows = rows.reshape(-1)[ranges(first, last - first)]
    return Surfels(origin=file.origin, **{name: rows[name] for name in file.kind.names})


@pytest.mark.parametrize("name", ["one_portion", "many_portions"])
def test_it_holds_every_surfel_once_bit_by_bit(name, whole, request):
    found = stored(request.getfixturevalue(name))
    assert len(found) == len(whole)
    assert np.array_equal(sorted_rows(found), sorted_rows(whole))


def test_portions_are_runs_of_neighbours(many_portions):
    file = BlockFile(many_portions)
    blocks = whole_table(file)
    assert file.roots >= 8
    leaves = blocks.first_child == blocks.last_child
    assert np.median((blocks.high - blocks.low).max(axis=1)[leaves]) < 0.4


def test_optional_fields_and_an_origin_come_back(tmp_path):
    fields = {"roughness": np.linspace(0, 1, 5000), "clip_line": np.ones((5000, 2), np.int16)}
    fields["normal_along_y"] = np.arange(10_000, dtype=np.int16).reshape(-1, 2)
    surfels = ball(5000, origin=(1e6, 2.0, 3.0), is_solid=True, **fields)
    write_blocks(tmp_path / "a.surfelblocks", [surfels])
    file, found = BlockFile(tmp_path / "a.surfelblocks"), stored(tmp_path / "a.surfelblocks")
    assert file.is_solid and (file.origin == surfels.origin).all()
    assert np.array_equal(sorted_rows(found), sorted_rows(surfels))


def test_parts_with_other_origins_are_moved_to_the_first(tmp_path):
    here, there = ball(3000, origin=(1e5, 0, 0)), ball(3000, origin=(1e5, 4, 0))
    write_blocks(tmp_path / "a.surfelblocks", [here, there])
    found = stored(tmp_path / "a.surfelblocks")
    expected = np.concatenate([here.positions, there.positions + np.float32([0, 4, 0])])
    assert np.array_equal(np.sort(found.positions, axis=0), np.sort(expected, axis=0))


def test_many_surfels_at_one_place_are_no_obstacle(tmp_path):
    surfels = ball(6000)
    heap = Surfels(**{**surfels.arrays(), "positions": np.zeros((6000, 3))})
    assert write_blocks(tmp_path / "a.surfelblocks", [heap], portion=1000) == len(stored(tmp_path / "a.surfelblocks"))


def test_a_file_tells_whether_any_of_its_surfels_are_transparent(tmp_path):
    colors = np.ones((100, 4))
    colors[:10, 3] = 0.5
    pale = Surfels(**{**ball(100).arrays(), "colors": colors})
    write_blocks(tmp_path / "a.surfelblocks", [ball(10), pale])
    write_blocks(tmp_path / "b.surfelblocks", [ball(10)])
    assert [BlockFile(tmp_path / name).is_transparent for name in ("a.surfelblocks", "b.surfelblocks")] == [True, False]


def test_what_cannot_be_stored_is_refused(tmp_path):
    with pytest.raises(ValueError, match="no surfels"):
        write_blocks(tmp_path / "a.surfelblocks", [empty_surfels()])
    with pytest.raises(ValueError, match="read twice"):
        write_blocks(tmp_path / "a.surfelblocks", iter([ball(100)]))
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("step", ["Counting", "Sorting", "Merging"])
def test_cancelling_leaves_nothing_and_keeps_an_older_file(step, tmp_path):
    path = tmp_path / "a.surfelblocks"
    path.write_bytes(b"older")
    with pytest.raises(WritingCancelled):
        write_blocks(path, [ball(3000), ball(3000)], lambda share, name: name != step, portion=1000)
    assert [p.name for p in tmp_path.iterdir()] == ["a.surfelblocks"] and path.read_bytes() == b"older"


@pytest.mark.parametrize("expected", [0, 9000, 100])
def test_progress_rises_to_the_end(expected, tmp_path):
    shares = []
    write_blocks(tmp_path / "a.surfelblocks", [ball(3000)] * 3, lambda share, _: shares.append(share), 1000, expected)
    assert shares == sorted(shares) and shares[-1] == 1
    assert sum(0 < share <= 0.1 for share in shares) >= (3 if expected else 0)


def test_a_portion_tells_while_it_is_merged(tmp_path):
    steps = []
    write_blocks(tmp_path / "a.surfelblocks", [ball(30_000)], lambda share, step: steps.append((step, share)))
    merging = [share for step, share in steps if step == "Merging"]
    assert len(set(merging)) > 6 and max(np.diff(merging)) < 0.3


@pytest.mark.parametrize("step", ["Counting", "Sorting", "Merging"])
def test_ctrl_c_leaves_nothing(step, tmp_path):
    def press(share, name):
        if name == step:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        write_blocks(tmp_path / "a.surfelblocks", [ball(3000)], press, portion=1000)
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(
    ("damage", "sentence"),
    [
        (lambda b: b[:-1], "cut off or damaged"),
        (lambda b: b[: len(b) // 2], "cut off or damaged"),
        (lambda b: b[:20], "not a file of surfels"),
        (lambda b: b"", "not a file of surfels"),
        (lambda b: b"ply\n" + b, "not a file of surfels"),
        (lambda b: b[:8] + struct.pack("<I", 9) + b[12:], "version 9"),
        (lambda b: b[:-9] + b"x" + b[-8:], "checksum"),
        (lambda b: b + b"more", "cut off or damaged"),
    ],
)
def test_a_damaged_or_foreign_file_is_refused_with_a_sentence(damage, sentence, one_portion, tmp_path):
    path = tmp_path / "bad.surfelblocks"
    path.write_bytes(damage(one_portion.read_bytes()))
    with pytest.raises(ValueError, match=sentence):
        BlockFile(path)


def test_surfels_of_extreme_sizes_and_places_are_kept(tmp_path):
    surfels = ball(2000)
    positions, scales = surfels.positions.copy(), surfels.scales.copy()
    positions[:3], positions[3:6], scales[6:9], scales[9:12] = 3e38, -3e38, 1e-45, 3e38
    extreme = Surfels(**{**surfels.arrays(), "positions": positions, "scales": scales})
    write_blocks(tmp_path / "a.surfelblocks", [extreme], portion=700)
    assert check(tmp_path / "a.surfelblocks") == 2000
    assert np.array_equal(sorted_rows(stored(tmp_path / "a.surfelblocks")), sorted_rows(extreme))
