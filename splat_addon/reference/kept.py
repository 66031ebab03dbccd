# SPDX-License-Identifier: GPL-3.0-or-later
"""Files with what one process found and another need not find again; they fall with their sources.

Tests and benches keep exact pictures here, which are slow: whichever asks first computes them for all.
"""

from __future__ import annotations

import hashlib
import os
import pickle
import shutil
from collections.abc import Callable
from functools import cache, wraps
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
#: Of one numpy's results a next one's differ by roundings alone; 1 and 2 keep their own.
NUMPY = np.__version__.partition(".")[0]

#: Folders of a name that stay: a developer goes back and forth.
KEPT = 4


@cache
def folder(name: str, *sources: str) -> Path:
    """build/`name`/KEY, which is empty when a file that these patterns match changes."""
    digest = hashlib.sha256()
    for file in sorted(file for pattern in sources for file in ROOT.glob(pattern)):
        digest.update(file.read_bytes())
    kept = ROOT / "build" / name / digest.hexdigest()[:16]
    kept.mkdir(parents=True, exist_ok=True)
    kept.touch()
    for old in sorted(kept.parent.iterdir(), key=lambda other: other.stat().st_mtime)[:-KEPT]:
        shutil.rmtree(old, ignore_errors=True)
    return kept


def write(file: Path, contents: bytes) -> None:
    """Whole or not at all: another process may read it at any time."""
    written = file.with_name(f"{file.name}.{os.getpid()}")
    written.write_bytes(contents)
    os.replace(written, file)


def remembered(function: Callable) -> Callable:
    """`function`, of the product and pure, whose result for arguments of equal contents is read from a file."""

    @wraps(function)
    def result(*arguments, **options):
        key = hashlib.sha256(pickle.dumps((function.__name__, arguments, options), protocol=5)).hexdigest()
        file = folder(f"truths-numpy-{NUMPY}", "splat_addon/**/*.py") / key[:32]
        if file.exists():
            return pickle.loads(file.read_bytes())
        found = function(*arguments, **options)
        write(file, pickle.dumps(found, protocol=5))
        return found

    return result
