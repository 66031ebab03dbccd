# SPDX-License-Identifier: GPL-3.0-or-later
"""The code is formatted, and the scripts start on old versions of Python."""

import subprocess
import sys
from pathlib import Path

import pytest

from environment.interpreters import candidate_commands, probe

ROOT = Path(__file__).resolve().parents[2]


def test_ruff_finds_nothing():
    done = subprocess.run([sys.executable, "-m", "ruff", "check", "."], cwd=ROOT, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr


def start_demo(version):
    """What the demo reports about a missing model, on a Python that can only start it."""
    for command in candidate_commands(version):
        if probe(command)[:1] == (version,):
            script = [str(ROOT / "scripts" / "demo.py"), "nowhere.obj"]
            return subprocess.run([*command, *script], capture_output=True, text=True)
    pytest.skip(f"there is no Python {version} on this machine")


@pytest.mark.parametrize("version", ["3.8", "3.10"])
def test_any_supported_python_starts_the_demo(version):
    assert "nowhere.obj" in start_demo(version).stderr


def test_a_python_too_old_is_told_so():
    assert start_demo("3.6").stderr.startswith("The scripts start with Python 3.8 or newer")
