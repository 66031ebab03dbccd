# SPDX-License-Identifier: GPL-3.0-or-later
"""A written file exists as a whole or not at all, and no other file is touched."""

import os
import stat
from pathlib import Path

import pytest

from splat_addon.interchange import write_ply

needs_posix = pytest.mark.skipif(os.name != "posix", reason="links and modes are POSIX")


@pytest.fixture
def written(surfels, tmp_path):
    """written(name="a.ply") -> the path of a file with ten surfels."""

    def write(name="a.ply"):
        write_ply(tmp_path / name, surfels(10))
        return tmp_path / name

    return write


@pytest.fixture
def mask():
    """Sets the process's umask so that new files get rw-r-----."""
    old = os.umask(0o027)
    yield
    os.umask(old)


def mode(path):
    return stat.S_IMODE(path.stat().st_mode)


def test_nothing_is_left_beside_it(written, tmp_path):
    written()
    assert [path.name for path in tmp_path.iterdir()] == ["a.ply"]


def test_a_users_own_file_of_a_similar_name_is_left_alone(written, tmp_path):
    (tmp_path / "a.ply.part").write_text("mine")
    written()
    assert (tmp_path / "a.ply.part").read_text() == "mine"


@needs_posix
def test_a_link_stays_and_what_it_points_to_is_written(written, tmp_path):
    (tmp_path / "store").mkdir()
    (tmp_path / "a.ply").symlink_to(tmp_path / "store" / "b.ply")
    assert written().is_symlink() and (tmp_path / "store" / "b.ply").read_bytes().startswith(b"ply\n")


@needs_posix
def test_no_link_that_was_laid_before_is_followed(written, tmp_path):
    for name in ("a.ply.part", "a.ply.tmp", ".a.ply"):
        (tmp_path / name).symlink_to(tmp_path / "victim")
    written()
    assert not (tmp_path / "victim").exists()


@needs_posix
def test_a_new_file_has_the_mode_of_any_other(mask, written):
    assert mode(written()) == 0o640


@needs_posix
def test_an_earlier_file_hands_on_its_mode(written):
    written().chmod(0o600)
    assert mode(written()) == 0o600


def test_a_failed_write_leaves_the_earlier_file(written, surfels, tmp_path, monkeypatch):
    before = written().read_bytes()

    def full(*arguments, **options):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("numpy.savetxt", full)
    with pytest.raises(OSError, match="No space left"):
        write_ply(tmp_path / "a.ply", surfels(20), ascii=True)
    assert [path.name for path in tmp_path.iterdir()] == ["a.ply"]
    assert (tmp_path / "a.ply").read_bytes() == before


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="/dev/full is Linux's")
def test_a_full_disk_is_said_to_be_full(surfels):
    with pytest.raises(OSError, match="No space left on device"):
        write_ply("/dev/full", surfels(100_000))
    assert Path("/dev/full").is_char_device()
