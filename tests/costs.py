# SPDX-License-Identifier: GPL-3.0-or-later
"""A pytest plugin: the processor time of each test file, with the processes that its tests started.

scripts/test.py names a folder in the environment and reports what it finds there; without it, nothing is measured.
"""

import json
import os
from collections import Counter
from pathlib import Path

import pytest

FOLDER_VARIABLE = "SURFEL_TEST_COSTS"

#: The name of what is no test's: starting Python, imports, and collecting the tests.
OVERHEAD = "starting and collecting"

COSTS = Counter()


def processor_time(with_others: bool = True) -> float:
    """Seconds of this process, and of those that it started and that have ended."""
    return sum(os.times()[: 4 if with_others else 2])


@pytest.hookimpl(wrapper=True)
def pytest_runtest_protocol(item):
    started = processor_time()
    try:
        return (yield)
    finally:
        COSTS[item.nodeid.split("::")[0]] += processor_time() - started


def pytest_sessionfinish(session):
    folder = os.environ.get(FOLDER_VARIABLE)
    if folder:
        # a process that hands tests to others has waited for these, and they count themselves
        runs_tests = hasattr(session.config, "workerinput") or not session.config.getoption("numprocesses", None)
        COSTS[OVERHEAD] = processor_time(runs_tests) - COSTS.total()
        Path(folder, f"{os.getpid()}.json").write_text(json.dumps(COSTS))
