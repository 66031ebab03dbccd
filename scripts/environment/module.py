# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs a module of scripts/ in an environment, where it finds the other scripts and the extension by their names."""

from __future__ import annotations

import os
from pathlib import Path

from .virtual_environment import ROOT


def module_process(python: str | Path, module: str, *arguments: object) -> dict:
    """What `subprocess.run` or `Popen` takes to run `python -m module arguments` from any folder."""
    paths = os.pathsep.join((str(ROOT), str(ROOT / "scripts")))
    # -P: the folder that the user happens to be in is not searched.
    command = [str(python), "-P", "-m", module, *map(str, arguments)]
    return {"args": command, "env": {**os.environ, "PYTHONPATH": paths}}
