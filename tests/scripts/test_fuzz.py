# SPDX-License-Identifier: GPL-3.0-or-later
"""The fuzzer runs, makes the same files again, tells faults from sentences, and survives what it finds."""

import sys

import numpy as np
import pytest

from bench.fuzz import reading, watching
from bench.fuzz.formats import FORMATS, Coarser
from splat_addon.interchange import read_contents


def test_it_runs_and_finds_nothing(bench, tmp_path):
    done = bench("fuzz", "--format", "surfels", "--files", "20", "--out", tmp_path)
    assert done.returncode == 0, done.stdout + done.stderr
    (row,) = [line for line in (tmp_path / "fuzz.md").read_text().splitlines() if line.startswith("| surfels")]
    read, coarser, refused, *faults, _ = map(int, row.replace("|", " ").split()[1:])
    assert read + refused == 20 and min(read, refused) > 0 and not any((coarser, *faults))


@pytest.mark.parametrize("name", ["surfels", "tiles"])
def test_the_same_numbers_make_the_same_files(name, tmp_path):
    files = [[FORMATS[name](tmp_path).damaged(np.random.default_rng([1, k])) for k in range(5)] for _ in range(2)]
    assert files[0] == files[1] and len(set(files[0])) == 5


def does(answer, tmp_path):
    """A format whose files do what `answer` does."""

    class Kind:
        def read(self, file, random):
            found = answer(tmp_path / "a.ply")
            yield np.zeros(1) if found is None else found

    return Kind()


def raises(error):
    def answer(path):
        raise error

    return answer


@pytest.mark.parametrize(
    ("answer", "outcome"),
    [
        (lambda path: None, "read"),
        (lambda path: np.array([np.nan]), "not finite"),
        (lambda path: path.write_text("no") and read_contents(path), "refused"),
        (lambda path: np.zeros(3).reshape(2), "unworded"),
        (raises(ValueError("This is raised outside the extension.")), "unworded"),
        (raises(KeyError("arrays")), "unworded"),
        (raises(RecursionError()), "unworded"),
        (raises(MemoryError()), "memory"),
        (raises(Coarser("A sentence.")), "coarser"),
    ],
)
def test_faults_are_told_from_sentences(answer, outcome, tmp_path):
    assert reading._outcome(does(answer, tmp_path), b"", None)[0] == outcome


#: A process that reads two files and dies at the third, one that goes on there, and one that says nothing.
_DIES = 'print(\'[{0}, "read", "", 1]\\n[{1}, "read", "", 1]\', flush=True); import os; os.kill(os.getpid(), {2})'
_SLEEPS = "import time; time.sleep(60)"


def test_a_process_that_dies_or_says_nothing_is_counted_and_replaced(monkeypatch, tmp_path):
    slow = int(watching._SLOW)
    codes = iter([_DIES.format(0, 1, 11), _DIES.format(3, 4, slow), _SLEEPS, _DIES.format(7, 8, 11)])
    monkeypatch.setattr(watching, "_SILENCE", 2)
    monkeypatch.setattr(watching, "module_process", lambda *_: {"args": [sys.executable, "-c", next(codes)]})
    found = list(watching.watched("blocks", 0, range(9), tmp_path))
    assert [one.number for one in found] == list(range(9))
    outcomes = ["read", "read", "crash", "read", "read", "hang", "hang", "read", "read"]
    assert [one.outcome for one in found] == outcomes and [one.is_fault for one in found].count(True) == 3
