# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs a module of scripts/ in an environment, with the other scripts and the extension importable."""

from __future__ import annotations

import os
from pathlib import Path

from .virtual_environment import ROOT


def module_process(python: str | Path, module: str, *arguments: object) -> dict:
    """Arguments for `subprocess.run` or `Popen` to run `python -m module arguments` from any folder."""
    paths = os.pathsep.join((str(ROOT), str(ROOT / "scripts")))
    # -P: do not search the current folder for modules.
    command = [str(python), "-P", "-m", module, *map(str, arguments)]
    return {"args": command, "env": {**os.environ, "PYTHONPATH": paths}}
