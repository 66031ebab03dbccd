# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes a file that appears under its name only once it is complete."""

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
    """Open a stream that becomes the file `path` if the context ends without an error; otherwise nothing changes.

    The data goes to a temporary file beside it with an unpredictable name. Links are followed, an existing file's
    permissions are kept, and a device is written to directly. Raises OSError.
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
    """The mode that `open` gives a new file; the umask can only be read by setting it."""
    mask = os.umask(0o077)
    os.umask(mask)
    return 0o666 & ~mask
