# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs pytest inside a Blender program: `blender --background --python tests/run_in_blender.py -- PYTEST ARGUMENTS`.

scripts/test.py --blender starts it, and names a folder with the packages that the program's Python lacks.
"""

import os
import runpy
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent


def run() -> int:
    """Run pytest; returns its exit code."""
    packages = os.environ.get("SURFEL_TEST_PACKAGES")
    if packages:
        sys.path.append(packages)
    sys.path.insert(0, str(ROOT))
    os.chdir(ROOT)
    import pytest

    return int(pytest.main(sys.argv[sys.argv.index("--") + 1 :]))


leaving = runpy.run_path(str(ROOT / "scripts" / "environment" / "leaving.py"))
leaving["run_and_leave"](run)
