# SPDX-License-Identifier: GPL-3.0-or-later
"""Results of slow pure functions, kept in files so that the second process of a test run need not find them again."""

from __future__ import annotations

import hashlib
import os
import pickle
import shutil
from collections.abc import Callable
from functools import cache, wraps
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parent.parent


@cache
def folder() -> Path:
    """build/truths/KEY, empty when any Python of the product, or numpy, is another one than the last time."""
    digest = hashlib.sha256(np.__version__.encode())
    for file in sorted((ROOT / "splat_addon").rglob("*.py")):
        digest.update(file.read_bytes())
    truths = ROOT / "build" / "truths"
    made = truths / digest.hexdigest()[:16]
    made.mkdir(parents=True, exist_ok=True)
    for other in truths.iterdir():
        if other != made:
            shutil.rmtree(other, ignore_errors=True)
    return made


def remembered(function: Callable) -> Callable:
    """`function`, whose result for arguments of equal contents is read from a file where there is one."""

    @wraps(function)
    def result(*arguments, **options):
        key = hashlib.sha256(pickle.dumps((function.__name__, arguments, options), protocol=5)).hexdigest()
        file = folder() / key[:32]
        if file.exists():
            return pickle.loads(file.read_bytes())
        found = function(*arguments, **options)
        written = file.with_suffix(f".{os.getpid()}")
        written.write_bytes(pickle.dumps(found, protocol=5))
        os.replace(written, file)
        return found

    return result
