# SPDX-License-Identifier: GPL-3.0-or-later
"""A written file exists as a whole or not at all, and no other file is touched."""

import os
import stat
from functools import partial
from pathlib import Path

import pytest

from splat_addon.whole_files import NotWholeError, unfinished, whole_file, write_whole

needs_posix = pytest.mark.skipif(os.name != "posix", reason="links and modes are POSIX")


@pytest.fixture
def mask():
    """Sets the process's umask so that new files get rw-r-----."""
    old = os.umask(0o027)
    yield
    os.umask(old)


def mode(path):
    return stat.S_IMODE(path.stat().st_mode)


def names(folder):
    return sorted(path.name for path in folder.iterdir())


def test_nothing_is_left_beside_it(tmp_path):
    write_whole(tmp_path / "a", b"some")
    assert names(tmp_path) == ["a"] and (tmp_path / "a").read_bytes() == b"some"


@pytest.mark.parametrize("name", ["a" * 255, "猫" * 85], ids=["letters", "characters"])
def test_the_longest_names_are_written(name, tmp_path):
    write_whole(tmp_path / name, b"some")
    assert names(tmp_path) == [name]


def test_a_file_that_is_not_read_back_as_it_was_written_is_not_there(tmp_path):
    write_whole(tmp_path / "a", b"before")

    def check(file):
        raise ValueError(f"It has {file.stat().st_size} bytes.")

    with pytest.raises(NotWholeError, match=r"a could not be written whole, so nothing was changed.*It has 4 bytes\."):
        with whole_file(tmp_path / "a", check) as stream:
            stream.write(b"some")
    assert names(tmp_path) == ["a"] and (tmp_path / "a").read_bytes() == b"before"


def test_several_files_appear_together_or_not_at_all(tmp_path):
    def check(file):
        if file.read_bytes() != b"whole":
            raise ValueError("It is not whole.")

    def write(right):
        with unfinished(tmp_path / "left", check) as folder:
            (folder / "scratch").mkdir()
            for name, contents in (("left", b"whole"), ("right", right)):
                (folder / name).write_bytes(contents)

    with pytest.raises(NotWholeError, match="right could not be written whole"):
        write(b"half")
    assert names(tmp_path) == []
    write(b"whole")
    assert names(tmp_path) == ["left", "right"]


def test_nothing_written_is_an_error(tmp_path):
    with pytest.raises(NotWholeError, match="Nothing was written for"), unfinished(tmp_path / "a", print):
        pass
    assert names(tmp_path) == []


@needs_posix
def test_a_link_stays_and_what_it_points_to_is_written(tmp_path):
    (tmp_path / "store").mkdir()
    (tmp_path / "a").symlink_to(tmp_path / "store" / "b")
    write_whole(tmp_path / "a", b"some")
    assert (tmp_path / "a").is_symlink() and (tmp_path / "store" / "b").read_bytes() == b"some"


@needs_posix
def test_a_new_file_has_the_mode_of_any_other(mask, tmp_path):
    write_whole(tmp_path / "a", b"some")
    assert mode(tmp_path / "a") == 0o640


@needs_posix
def test_an_earlier_file_hands_on_its_mode(tmp_path):
    write_whole(tmp_path / "a", b"some")
    (tmp_path / "a").chmod(0o600)
    write_whole(tmp_path / "a", b"more")
    assert mode(tmp_path / "a") == 0o600


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="/dev/full is Linux's")
def test_a_device_is_written_to_directly():
    with pytest.raises(OSError, match="No space left on device"):
        write_whole("/dev/full", bytes(100_000))
    assert Path("/dev/full").is_char_device()


def test_a_folder_that_is_missing_is_an_error_of_the_file(tmp_path):
    with pytest.raises(FileNotFoundError, match=r"No such file or directory: '.*[/\\\\]a'"):
        write_whole(tmp_path / "missing" / "a", b"some")


@pytest.mark.parametrize("step", ["fsync", "replace"])
def test_an_error_of_the_disk_names_the_file_and_changes_nothing(step, tmp_path, monkeypatch):
    write_whole(tmp_path / "a", b"before")
    monkeypatch.setattr(os, step, partial(full, None))
    with pytest.raises(OSError, match=r"No space left on device: .*a'"):
        write_whole(tmp_path / "a", b"some")
    assert names(tmp_path) == ["a"] and (tmp_path / "a").read_bytes() == b"before"


def full(*_):
    raise OSError(28, "No space left on device")
