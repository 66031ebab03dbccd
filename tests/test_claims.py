# SPDX-License-Identifier: GPL-3.0-or-later
"""Of two runs that make the same result, the second is refused; what a killed one left hinders nobody and goes."""

import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

from splat_addon import claims
from splat_addon.claims import ClaimedError, claimed, mark, remove_leftovers
from splat_addon.whole_files import unfinished, write_whole

#: Holds a claim, with something unfinished, until it is told to end or killed.
OTHER = """
import sys
from splat_addon.whole_files import unfinished
with unfinished(sys.argv[1], print) as folder:
    (folder / "half").write_text("of it")
    print("made", flush=True)
    sys.stdin.readline()
    (folder / "half").rename(folder / "a")
"""


@pytest.fixture
def other(tmp_path):
    """A process that makes the file `a`."""
    command = [sys.executable, "-c", OTHER, str(tmp_path / "a")]
    root = Path(__file__).resolve().parent.parent
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, cwd=root, text=True) as process:
        assert process.stdout.readline() == "made\n"
        yield process
        process.kill()


def names(folder):
    return sorted(path.name for path in folder.iterdir())


def test_a_second_run_is_refused_and_the_first_ends_its_work(other, tmp_path):
    before = names(tmp_path)
    with pytest.raises(ClaimedError, match=r"Another run is making .*a at this moment"):
        write_whole(tmp_path / "a", b"mine")
    remove_leftovers([tmp_path / "a"])
    assert names(tmp_path) == before and len(before) == 2
    write_whole(tmp_path / "b", b"another result")
    other.communicate("go on\n")
    assert other.returncode == 0 and names(tmp_path) == ["a", "b"] and (tmp_path / "a").read_text() == "of it"


@pytest.mark.parametrize("way", [lambda file: write_whole(file, b"mine"), lambda file: remove_leftovers([file])])
def test_what_a_killed_run_left_goes(way, other, tmp_path):
    other.kill()
    other.wait()
    assert len(names(tmp_path)) == 2
    way(tmp_path / "a")
    assert not [name for name in names(tmp_path) if "unfinished" in name]


def test_leftovers_of_a_result_with_a_similar_name_stay(tmp_path):
    with unfinished(tmp_path / "a.unfinished-b", print) as folder:
        (folder / "a.unfinished-b").write_text("its own")
        write_whole(tmp_path / "a", b"mine")
    assert names(tmp_path) == ["a", "a.unfinished-b"]


def test_claims_of_a_thread_nest_and_another_thread_is_refused(tmp_path):
    with claimed(tmp_path / "a"), claimed(tmp_path / "a"):
        with ThreadPoolExecutor(1) as other, pytest.raises(ClaimedError):
            other.submit(write_whole, tmp_path / "a", b"theirs").result()
        write_whole(tmp_path / "a", b"mine")
    assert names(tmp_path) == ["a"]


def test_a_link_and_its_file_are_one_result(tmp_path):
    (tmp_path / "a").touch()
    try:
        (tmp_path / "link").symlink_to(tmp_path / "a")
    except OSError:
        pytest.skip("Links need a right on Windows.")
    with claimed(tmp_path / "link"), ThreadPoolExecutor(1) as other, pytest.raises(ClaimedError):
        other.submit(write_whole, tmp_path / "a", b"theirs").result()


def test_a_disk_that_cannot_lock_is_written_to_and_nothing_is_removed(tmp_path, monkeypatch):
    def cannot(_):
        raise OSError(38, "Function not implemented")

    monkeypatch.setattr(claims, "_lock", cannot)
    (tmp_path / f"{mark(tmp_path / 'a')}-another").mkdir()
    write_whole(tmp_path / "a", b"mine")
    assert names(tmp_path) == [".a.unfinished-another", "a"]


@pytest.mark.skipif(sys.platform == "win32", reason="Windows removes no open file.")
def test_a_lock_that_its_owner_removes_while_another_opens_it_is_taken_anew(tmp_path, monkeypatch):
    lock, turns = claims._lock, []

    def removed(stream):
        turns.append(stream)
        lock(stream)
        if len(turns) == 1:
            (tmp_path / mark(tmp_path / "a")).unlink()

    monkeypatch.setattr(claims, "_lock", removed)
    with claimed(tmp_path / "a"):
        assert len(turns) == 2 and (tmp_path / mark(tmp_path / "a")).exists()
