# SPDX-License-Identifier: GPL-3.0-or-later
"""Lets the tests import the scripts as they import each other; last on the path, where Python's own `test` wins."""

import subprocess
import sys
from pathlib import Path

import pytest

SCRIPTS = Path(__file__).resolve().parents[2] / "scripts"
if str(SCRIPTS) not in sys.path:
    sys.path.append(str(SCRIPTS))


@pytest.fixture(scope="session")
def bench():
    """bench(name, arguments ...) is the finished `scripts/bench.py NAME ARGUMENTS`, in the Python of the tests."""
    from environment.module import module_process

    def run(*arguments):
        return subprocess.run(**module_process(sys.executable, "measuring", *arguments), capture_output=True, text=True)

    return run
