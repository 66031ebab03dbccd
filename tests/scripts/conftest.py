# SPDX-License-Identifier: GPL-3.0-or-later
"""Lets the tests import the scripts as they import each other; last on the path, where Python's own `test` wins."""

import sys
from pathlib import Path

SCRIPTS = Path(__file__).resolve().parents[2] / "scripts"
if str(SCRIPTS) not in sys.path:
    sys.path.append(str(SCRIPTS))
