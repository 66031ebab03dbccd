# SPDX-License-Identifier: GPL-3.0-or-later
"""One process at a time: a second first run waits for the environment that another one makes."""

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

#: Seconds between two tries.
_PAUSE = 0.2


@contextmanager
def alone(path: Path, waiting: str) -> Iterator[None]:
    """No other process is in this context for the same file meanwhile; the system lets go of it when a process dies.

    path: of the lock, which is made where it is not there, and stays. waiting: printed once where another is first.
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
    """Takes the lock, or lets go of it; False where another process has it."""
    try:
        if os.name == "nt":
            stream.seek(0)
            msvcrt.locking(stream.fileno(), msvcrt.LK_NBLCK if is_wanted else msvcrt.LK_UNLCK, 1)
        else:
            fcntl.flock(stream, fcntl.LOCK_EX | fcntl.LOCK_NB if is_wanted else fcntl.LOCK_UN)
    except OSError:
        return False
    return True
