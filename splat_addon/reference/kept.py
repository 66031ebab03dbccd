# SPDX-License-Identifier: GPL-3.0-or-later
"""Caches results in files, so that other processes need not compute them again; they expire when their sources change.

Tests and benches store exact pictures here, which are slow to compute.
"""

from __future__ import annotations

import ast
import hashlib
import io
import pickle
import shutil
from collections.abc import Callable, Iterator
from contextlib import suppress
from dataclasses import fields, is_dataclass
from functools import cache, wraps
from pathlib import Path

import numpy as np

from ..claims import ClaimedError
from ..whole_files import write_whole

ROOT = Path(__file__).resolve().parents[2]
#: Results of different numpy versions differ only by rounding; versions 1 and 2 have separate caches.
NUMPY = np.__version__.partition(".")[0]

#: Number of folders per name that are kept, because developers switch between versions.
KEPT = 4


@cache
def folder(name: str, *sources: str) -> Path:
    """The folder build/`name`/KEY, which is empty after a change to any file that these patterns match."""
    digest = hashlib.sha256()
    for file in sorted(file for pattern in sources for file in ROOT.glob(pattern)):
        digest.update(file.read_bytes())
    kept = ROOT / "build" / name / digest.hexdigest()[:16]
    kept.mkdir(parents=True, exist_ok=True)
    kept.touch()
    for old in sorted(kept.parent.iterdir(), key=lambda other: other.stat().st_mtime)[:-KEPT]:
        shutil.rmtree(old, ignore_errors=True)
    return kept


@cache
def dependencies() -> tuple[str, ...]:
    """The files that the reference consists of and those that it imports, directly or not, with tables beside them.

    Not among them: the renderer's passes, shaders and Blender's side, so that work on those empties no cache.
    """
    found, left = set(), list(ROOT.glob("splat_addon/reference/**/*.py"))
    while left:
        file = left.pop()
        if file not in found:
            found.update((file, *file.parent.glob("*.npy")))
            left += imported(file)
    return tuple(sorted(file.relative_to(ROOT).as_posix() for file in found))


def imported(file: Path) -> Iterator[Path]:
    """The files of the product that a file imports from; the product imports relatively."""
    for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
        if isinstance(node, ast.ImportFrom) and node.level:
            place = file.parents[node.level - 1].joinpath(*(node.module or "").split("."))
            for path in (place, *(place / alias.name for alias in node.names)):
                yield from (f for f in (path.with_suffix(".py"), path / "__init__.py") if f.is_file())


def write(file: Path, contents: bytes) -> None:
    """Write a file completely or not at all: other processes may read it at any time, or write the same."""
    with suppress(ClaimedError):
        write_whole(file, contents)


class _Contents(pickle.Pickler):
    """Writes the fields of dataclasses, without what they remember of what was asked of them before."""

    def reducer_override(self, value):
        if not is_dataclass(value) or isinstance(value, type):
            return NotImplemented
        return tuple, ((type(value).__qualname__, *(getattr(value, f.name) for f in fields(value))),)


def contents(value) -> bytes:
    """Bytes that are the same for the same values, whatever was computed from them."""
    written = io.BytesIO()
    _Contents(written, protocol=5).dump(value)
    return written.getvalue()


def remembered(function: Callable) -> Callable:
    """`function`, which must be pure and part of the reference, with results cached in a file by the contents of its
    arguments."""

    @wraps(function)
    def result(*arguments, **options):
        key = hashlib.sha256(contents((function.__name__, arguments, options))).hexdigest()
        file = folder(f"truths-numpy-{NUMPY}", *dependencies()) / key[:32]
        if file.exists():
            return pickle.loads(file.read_bytes())
        found = function(*arguments, **options)
        write(file, pickle.dumps(found, protocol=5))
        return found

    return result
