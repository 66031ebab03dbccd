# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes files that appear under their names only once they are complete, even if the writing process is killed.

They are written in a hidden folder beside their destination, on the same disk, and renamed when all are complete.
Leftovers of a killed process are removed by the next one that makes the same result.
"""

from __future__ import annotations

import os
import shutil
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path


@contextmanager
def unfinished(result: Path) -> Iterator[Path]:
    """A folder for `result` and files that belong to it; they are moved to the folder of `result` if the context ends
    without an error. Raises OSError, and ValueError if nothing was written."""
    result.parent.mkdir(parents=True, exist_ok=True)
    remove_leftovers(result)
    folder = Path(tempfile.mkdtemp(prefix=_prefix(result), dir=result.parent))
    try:
        yield folder
        written = sorted(folder.iterdir())
        if not written:
            raise ValueError(f"Nothing was written for {result}.")
        for file in written:
            _flush(file)
        for file in written:
            os.replace(file, result.parent / file.name)
    finally:
        shutil.rmtree(folder, ignore_errors=True)


def remove_leftovers(result: Path) -> None:
    """Remove what killed processes left while making `result`."""
    if result.parent.is_dir():
        for path in result.parent.iterdir():
            if path.name.startswith(_prefix(result)):
                shutil.rmtree(path, ignore_errors=True)


def _prefix(result: Path) -> str:
    return f".{result.name}.unfinished-"


def _flush(file: Path) -> None:
    """Flush a file to the disk before its name declares it complete."""
    with open(file, "rb+") as stream:
        os.fsync(stream.fileno())
