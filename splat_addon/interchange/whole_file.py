# SPDX-License-Identifier: GPL-3.0-or-later
"""A file that appears under its name only when it is complete."""

from __future__ import annotations

import os
import stat
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import BinaryIO


@contextmanager
def whole_file(path: str | os.PathLike) -> Iterator[BinaryIO]:
    """A stream whose bytes are the file `path` when the context ends without an error; else all is as before.

    They are written beside it, under a name that nobody can know beforehand. A link stays, and what it points to is
    written; an earlier file hands on its permissions, and a device is written to itself. Raises OSError.
    """
    target = Path(os.path.realpath(path))
    if target.exists() and not target.is_file():
        with open(target, "wb") as stream:
            yield stream
        return
    number, unfinished = tempfile.mkstemp(dir=target.parent, prefix=f".{target.name[:40]}-")
    try:
        with open(number, "wb") as stream:
            yield stream
        os.chmod(unfinished, stat.S_IMODE(target.stat().st_mode) if target.exists() else _mode_of_new_files())
        os.replace(unfinished, target)
    except BaseException:
        Path(unfinished).unlink(missing_ok=True)
        raise


def _mode_of_new_files() -> int:
    """What `open` would give a new file; asking for the mask is only possible by setting it."""
    mask = os.umask(0o077)
    os.umask(mask)
    return 0o666 & ~mask
