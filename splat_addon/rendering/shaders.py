# SPDX-License-Identifier: GPL-3.0-or-later
"""GLSL files to GLSL text: `#include "path"` becomes that file, once a text, and {names} in a path are filled in."""

from __future__ import annotations

import re
from functools import cache
from pathlib import Path

FOLDER = Path(__file__).resolve().parents[2] / "shaders"

_INCLUDE = re.compile(r'^#include "([^"]+)"$', re.MULTILINE)


@cache
def load(path: str, **names: str) -> str:
    """The text of shaders/`path` with its includes. Raises FileNotFoundError for a path that is not there."""
    return _expand(path, tuple(sorted(names.items())), set())


def _expand(path: str, names, seen: set[str]) -> str:
    path = path.format(**dict(names))
    if path in seen:
        return ""
    seen.add(path)
    return _INCLUDE.sub(lambda match: _expand(match.group(1), names, seen), _read(path))


@cache
def _read(path: str) -> str:
    return (FOLDER / path).read_text(encoding="utf-8")
