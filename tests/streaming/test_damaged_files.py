# SPDX-License-Identifier: GPL-3.0-or-later
"""Whatever a file says, opening it ends in a sentence that names it, and a view of it ends, in memory of the file's
size; what cannot be read is drawn coarser, and said.
"""

import os
import tracemalloc

import numpy as np
import pytest

from bench.fuzz.edited_blocks import EditedBlocks
from splat_addon.streaming import Stream, Unreadable, check, described, write_blocks
from splat_addon.streaming.layout import HEAD, PAGE, UNCHECKED_VERSION
from splat_addon.surfels import portions

from .conftest import ball, sight

FINE = sight((0, 0, 2), 0.0)


@pytest.fixture(scope="session")
def sound(tmp_path_factory):
    """The bytes of a file of several portions and pages of blocks."""
    path = tmp_path_factory.mktemp("sound") / "a.surfelblocks"
    write_blocks(path, portions(ball(12_000), 4000), portion=3000)
    assert check(path) == 12_000
    return path.read_bytes()


@pytest.fixture
def path(tmp_path):
    return tmp_path / "a.surfelblocks"


@pytest.fixture
def edited(sound, path):
    """edited(change, ...): the path of a file that `change(EditedBlocks)` changed, with right checksums."""

    def make(change, **options):
        parts = EditedBlocks(sound)
        change(parts)
        path.write_bytes(parts.packed(**options))
        return path

    return make


def says(**values):
    return lambda parts: parts.directory.update(values)


def says_of(name, **values):
    return lambda parts: parts.directory["arrays"][name].update(values)


def has(name, row, value):
    return lambda parts: parts.arrays[name].__setitem__(row, value)


@pytest.mark.parametrize(
    "change",
    [
        says_of("high", type="O"),
        says_of("low", type="<f8"),
        says_of("first", type="<i8,<i8"),
        says_of("low", offset=-1),
        says_of("low", offset=1 << 62),
        says_of("low", offset="x"),
        says_of("low", shape=None),
        says_of("first", shape=[1 << 50]),
        says_of("rows", count=-1),
        says_of("rows", count=1 << 60),
        says_of("rows", count=True),
        says_of("row_sums", checksum=0),
        says(fields=[]),
        says(fields={"positions": 3}),
        says(fields={"__class__": 1}),
        says(roots=0),
        says(roots=1 << 40),
        says(surfels=1 << 40),
        says(origin=[1]),
        says(origin=[10**400, 0, 0]),
        says(origin=[float("nan"), 0, 0]),
        says(is_solid="yes"),
        says(arrays=None),
        lambda parts: parts.directory["arrays"].pop("row_sums"),
        lambda parts: parts.directory["arrays"]["low"].pop("type"),
    ],
)
def test_every_number_and_type_of_a_directory_is_checked(change, edited):
    path = edited(change, are_sums_right=False)
    for opened in (described, check, lambda path: Stream(path, 0)):
        with pytest.raises(ValueError, match=r"a.surfelblocks is damaged: .*; copy or store it again"):
            opened(path)


@pytest.mark.parametrize("text", [b"[" * 100_000, b"[]", b"\xff", b"9" * 10_000, b""])
def test_what_is_no_directory_is_refused(text, edited):
    with pytest.raises(ValueError, match=r"a.surfelblocks is damaged"):
        described(edited(lambda parts: None, text=text))


def test_what_is_no_file_is_refused_and_not_waited_for(tmp_path):
    if hasattr(os, "mkfifo"):
        os.mkfifo(tmp_path / "pipe.surfelblocks")
        with pytest.raises(ValueError, match=r"pipe.surfelblocks is not a file"):
            described(tmp_path / "pipe.surfelblocks")
    with pytest.raises(ValueError, match="is not a file"):
        described(tmp_path)


@pytest.mark.parametrize("version", [UNCHECKED_VERSION, 2])
@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("first", 10**9),
        ("first", -1),
        ("last", 10**9),
        ("last", np.iinfo(np.int64).min),
        ("first_child", 0),
        ("first_child", -(10**9)),
        ("last_child", 10**7),
        ("low", np.nan),
        ("errors", np.inf),
        ("angles", np.nan),
    ],
)
def test_numbers_of_a_root_out_of_bounds_are_refused(name, value, version, edited):
    path = edited(has(name, 1, value), version=version)
    with pytest.raises(ValueError, match=r"a.surfelblocks is damaged"):
        Stream(path, 0)


@pytest.mark.parametrize(
    ("name", "value"), [("first", 10**9), ("last_child", 10**9), ("first_child", 0), ("low", np.nan)]
)
def test_numbers_of_another_block_out_of_bounds_make_its_parents_drawn(name, value, edited, sound):
    parts = EditedBlocks(sound)
    assert len(parts.arrays["first"]) > PAGE + 1
    path = edited(has(name, PAGE + 1, value))
    stream = Stream(path, 1 << 30)
    with pytest.raises(Unreadable, match=r"a.surfelblocks is damaged.*copy or store it again") as error:
        stream.seen(FINE)
    assert len(stream.coarsest) < len(error.value.seen.surfels) < 12_000 and error.value.seen.is_whole
    with pytest.raises(ValueError, match="is damaged"):
        check(path)


def test_roots_with_more_rows_than_there_are_are_refused(edited):
    def greedy(parts):
        parts.directory["roots"] = len(parts.arrays["first"])
        parts.arrays["first"][:], parts.arrays["last"][:] = 0, PAGE
        parts.arrays["first_child"][:] = parts.arrays["last_child"][:]

    path = edited(greedy)
    tracemalloc.start()
    with pytest.raises(ValueError, match=r"a.surfelblocks is damaged"):
        Stream(path, 0)
    assert tracemalloc.get_traced_memory()[1] < 5e6
    tracemalloc.stop()


def test_blocks_with_several_parents_cannot_make_a_descent_long_or_large(edited):
    """Each block has all that follow it for children, and 1,024 rows: without bounds, 2^1000 blocks."""

    def tangled(parts):
        count = len(parts.arrays["first"])
        parts.arrays["first_child"][:] = np.maximum(np.arange(count) + 1, parts.directory["roots"])
        parts.arrays["last_child"][:] = np.minimum(parts.arrays["first_child"] + PAGE, count)
        parts.arrays["first_child"][-1] = parts.arrays["last_child"][-1] = count
        parts.arrays["first"][:], parts.arrays["last"][:] = 0, PAGE

    stream = Stream(edited(tangled), 1 << 30)
    tracemalloc.start()
    with pytest.raises(Unreadable) as error:
        stream.seen(FINE)
    assert len(error.value.seen.surfels) <= stream.file.rows and tracemalloc.get_traced_memory()[1] < 50e6
    tracemalloc.stop()


def test_surfels_of_an_endless_error_do_not_make_the_choice_of_the_coarsest_endless(edited):
    def wrong(parts):
        leaves = parts.arrays["first_child"] == parts.arrays["last_child"]
        parts.arrays["errors"][leaves] = 3e38

    assert len(Stream(edited(wrong), 0).at_most(10**9)) == 12_000


@pytest.mark.parametrize("name", ["rows", "first_child", "low"])
def test_a_flipped_bit_is_noticed_and_makes_few_surfels_coarser(name, sound, path, whole):
    parts = EditedBlocks(sound)
    place = parts.directory["arrays"][name]["offset"] + (parts.arrays[name][: PAGE + 1].nbytes)
    data = bytearray(sound)
    data[place] ^= 1
    path.write_bytes(data)
    stream = Stream(path, 1 << 30)
    with pytest.raises(Unreadable, match=r"a.surfelblocks is damaged") as error:
        stream.seen(FINE)
    seen = error.value.seen
    assert 8000 < len(seen.surfels) < 12_000 and seen.is_whole and not seen.is_short
    with pytest.raises(Unreadable, match=r"a.surfelblocks is damaged"):
        stream.at_most(10**9)
    with pytest.raises(ValueError, match=r"a.surfelblocks is damaged"):
        check(path)


def test_a_root_that_is_no_surfel_is_refused(edited):
    with pytest.raises(ValueError, match=r"a.surfelblocks is damaged"):
        Stream(edited(lambda parts: parts.arrays["rows"]["rotations"].__setitem__(-1, np.nan)), 0)


def test_rows_beside_the_roots_that_are_no_surfels_do_not_take_these_along(edited, sound):
    """In a page that the roots have rows in."""
    parts = EditedBlocks(sound)
    first, roots = parts.arrays["first"], parts.directory["roots"]
    merged = parts.arrays["last_child"] > parts.arrays["first_child"]
    rows = first[roots:][np.isin(first[roots:] // PAGE, first[:roots] // PAGE) & merged[roots:]]
    stream = Stream(edited(lambda parts: parts.arrays["rows"]["normals"].__setitem__(rows, np.nan)), 0)
    for _ in range(2):
        stream.begin_frame()
        with pytest.raises(Unreadable, match=r"a.surfelblocks is damaged"):
            stream.seen(sight((0, 0, 9), 9.0))
    assert len(stream.seen(sight((0, 0, 1e5))).surfels) == len(stream.coarsest)


def test_rows_that_are_no_surfels_are_drawn_coarser(edited):
    stream = Stream(edited(lambda parts: parts.arrays["rows"]["rotations"].__setitem__(50, np.nan)), 1 << 30)
    with pytest.raises(Unreadable, match=r"a.surfelblocks is damaged") as error:
        stream.seen(FINE)
    assert 8000 < len(error.value.seen.surfels) < 12_000


@pytest.mark.parametrize("version", [UNCHECKED_VERSION, 2])
@pytest.mark.parametrize("kept", [0, 40_000])
def test_a_file_that_is_cut_off_while_a_view_reads_it_is_drawn_with_what_was_read(kept, version, edited):
    path = edited(lambda parts: None, version=version)
    stream = Stream(path, 1 << 30)
    before = stream.seen(sight((0, 0, 50), 5.0))
    with open(path, "r+b") as file:
        file.truncate(kept)
    stream.begin_frame()
    with pytest.raises(Unreadable, match=r"a.surfelblocks was changed while it was read") as error:
        stream.seen(FINE)
    assert len(before.surfels) <= len(error.value.seen.surfels) < 12_000


@pytest.mark.parametrize("version", [UNCHECKED_VERSION, 2])
def test_a_file_that_is_written_again_while_a_view_reads_it_is_noticed(version, edited, sound):
    """In place, with as many bytes: only checksums, or the time, tell."""
    path = edited(lambda parts: None, version=version)
    stream = Stream(path, 1 << 30)
    parts = EditedBlocks(sound)
    parts.arrays["rows"]["colors"] = 0.25
    with open(path, "r+b") as file:
        file.write(parts.packed(version))
    os.utime(path, ns=(1, 1))
    with pytest.raises(Unreadable, match=r"a.surfelblocks was changed while it was read") as error:
        stream.seen(FINE)
    assert len(stream.coarsest) <= len(error.value.seen.surfels) < 1000
    assert (error.value.seen.surfels.colors[:, 3] == 1).all()


def test_what_could_not_be_read_is_tried_again_in_the_next_frame(sound, path, monkeypatch):
    path.write_bytes(sound)
    stream = Stream(path, 1 << 30)
    with monkeypatch.context() as failing:
        failing.setattr(stream.file, "_stream", Failing(stream.file._stream))
        with pytest.raises(Unreadable, match=r"a.surfelblocks cannot be read: Input/output error"):
            stream.seen(FINE)
    stream.begin_frame()
    assert len(stream.seen(FINE).surfels) == 12_000


class Failing:
    """A file on a drive that fails."""

    def __init__(self, stream):
        self._stream = stream

    def seek(self, offset):
        raise OSError(5, "Input/output error")

    def fileno(self):
        return self._stream.fileno()


def test_the_version_without_checksums_is_read(edited):
    path = edited(lambda parts: [parts.directory["arrays"].pop(n) for n in ("row_sums", "block_sums")], version=1)
    assert check(path) == len(Stream(path, 1 << 30).seen(FINE).surfels) == 12_000


def test_no_gigabyte_is_taken_because_a_small_file_says_so(path):
    data = HEAD.pack(b"SURFELBL", 2, 0, HEAD.size, (1 << 40) - HEAD.size)
    with open(path, "wb") as file:
        file.write(data)
        file.truncate(1 << 40)  # sparse
    tracemalloc.start()
    with pytest.raises(ValueError, match="its directory has 1,099,511,627,744 bytes"):
        described(path)
    assert tracemalloc.get_traced_memory()[1] < 1e6
    tracemalloc.stop()
