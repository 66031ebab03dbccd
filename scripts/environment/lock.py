# SPDX-License-Identifier: GPL-3.0-or-later
"""A lock between processes: a second first run waits while another creates the environment."""

from __future__ import annotations

import os
import time
from contextlib import contextmanager
from pathlib import Path
from typing import BinaryIO, Iterator

if os.name == "nt":
    import msvcrt
else:
    import fcntl

#: Seconds between two attempts.
_PAUSE = 0.2


@contextmanager
def alone(path: Path, waiting: str) -> Iterator[None]:
    """Hold the lock in this context; the system releases it if the process dies.

    path: of the lock file, which is created if necessary, and stays. waiting: printed once if another process holds the
        lock.
    """
    with open(path, "ab") as stream:
        if not _locked(stream, True):
            print(waiting, flush=True)
            while not _locked(stream, True):
                time.sleep(_PAUSE)
        try:
            yield
        finally:
            _locked(stream, False)


def _locked(stream: BinaryIO, is_wanted: bool) -> bool:
    """Take or release the lock; False if another process has it."""
    try:
        if os.name == "nt":
            stream.seek(0)
            msvcrt.locking(stream.fileno(), msvcrt.LK_NBLCK if is_wanted else msvcrt.LK_UNLCK, 1)
        else:
            fcntl.flock(stream, fcntl.LOCK_EX | fcntl.LOCK_NB if is_wanted else fcntl.LOCK_UN)
    except OSError:
        return False
    return True
