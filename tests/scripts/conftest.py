# SPDX-License-Identifier: GPL-3.0-or-later
"""Lets the tests import the scripts as these import each other.

The scripts' folder is last on the path, because Python's own `test` must be found first.
"""

import subprocess
import sys
from pathlib import Path

import pytest

SCRIPTS = Path(__file__).resolve().parents[2] / "scripts"
if str(SCRIPTS) not in sys.path:
    sys.path.append(str(SCRIPTS))


@pytest.fixture(scope="session")
def bench():
    """bench(name, arguments ...) -> the finished `scripts/bench.py NAME ARGUMENTS`, run by the tests' Python."""
    from environment.module import module_process

    def run(*arguments):
        return subprocess.run(**module_process(sys.executable, "measuring", *arguments), capture_output=True, text=True)

    return run
