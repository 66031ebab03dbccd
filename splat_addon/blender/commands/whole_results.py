# SPDX-License-Identifier: GPL-3.0-or-later
"""Files that appear under their names only when they are whole, whatever happens to the process that writes them.

They are written in a hidden folder beside their place, which is on the same disk, and renamed when all are there. What
a process leaves that was killed is removed by the next that makes the same result.
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
    """A folder for `result` and what belongs to it, each of which gets to the folder of `result` when the context ends
    without an error. Raises OSError, and ValueError where nothing was written.
    """
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
    """Those of processes that were killed while they made `result`."""
    if result.parent.is_dir():
        for path in result.parent.iterdir():
            if path.name.startswith(_prefix(result)):
                shutil.rmtree(path, ignore_errors=True)


def _prefix(result: Path) -> str:
    return f".{result.name}.unfinished-"


def _flush(file: Path) -> None:
    """To the disk itself, before the name says that it is whole."""
    with open(file, "rb+") as stream:
        os.fsync(stream.fileno())
