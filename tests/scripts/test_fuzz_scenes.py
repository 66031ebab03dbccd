# SPDX-License-Identifier: GPL-3.0-or-later
"""The watcher of random scenes goes on after a process that crashed or hung, and says at which case and step it did."""

import json
import sys
from types import SimpleNamespace

import pytest

from bench import fuzz_scenes

#: A process that is given its first case, and does what that case is about.
WORKER = """
import json, os, sys, time
for case in range(int(sys.argv[1]), int(sys.argv[1]) + int(sys.argv[2])):
    print(json.dumps({"case": case, "step": "export"}), flush=True)
    if case == 1: os.abort()
    if case == 3: time.sleep(60)
    print(json.dumps({"case": case, "held": {"nodes": case}}), flush=True)
"""


@pytest.fixture
def records(monkeypatch, tmp_path):
    """The records of five cases: the second crashes, and the fourth hangs."""
    monkeypatch.setattr(fuzz_scenes, "HANG", 0.5)
    monkeypatch.setattr(
        fuzz_scenes,
        "module_process",
        lambda python, module, *arguments: {"args": [sys.executable, "-c", WORKER, *map(str, arguments)], "env": {}},
    )
    options = SimpleNamespace(first=0, cases=5, every=1)
    return list(fuzz_scenes.watched(options, tmp_path / "stderr.txt"))


def test_each_case_is_made_once_and_what_ends_or_hangs_is_named(records):
    assert [record["case"] for record in records] == [0, 1, 2, 3, 4]
    assert [record.get("how") for record in records] == [None, "crashes", None, "hangs", None]
    assert {record["step"] for record in records if "how" in record} == {"export"}
    assert json.dumps(records).count("held") == 3
