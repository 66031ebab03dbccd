# SPDX-License-Identifier: GPL-3.0-or-later
"""Lists what scripts/bench.py can run: every module of scripts/bench and scripts/figures. Needs no environment.

Such a module has a docstring that says what it measures or draws, and a function `run(options, report)`. It may have
`arguments(parser)` with its own options, `QUICK`, the defaults of a tiny run, and `DEVICES`, the devices that it draws
on.
"""

from __future__ import annotations

import ast
from pathlib import Path

SCRIPTS = Path(__file__).resolve().parent.parent
FOLDERS = ("bench", "figures")


def modules() -> dict[str, str]:
    """Name on the command line -> dotted module name, ordered by folder, then by name."""
    found = {}
    for folder in FOLDERS:
        for path in sorted((SCRIPTS / folder).iterdir()):
            if not path.name.startswith("_") and (path.suffix == ".py" or (path / "__init__.py").is_file()):
                found[path.stem] = f"{folder}.{path.stem}"
    return found


def summary(module: str) -> str:
    """The first line of the docstring, read without importing the module."""
    path = SCRIPTS.joinpath(*module.split("."))
    source = path / "__init__.py" if path.is_dir() else path.with_suffix(".py")
    return ast.get_docstring(ast.parse(source.read_text(encoding="utf-8"))).split("\n")[0]
