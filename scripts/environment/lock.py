# SPDX-License-Identifier: GPL-3.0-or-later
"""One process at a time: a second first run waits for the environment that another one makes."""

from __future__ import annotations

import os
import time
from contextlib import contextmanager
from pathlib import Path
from typing import BinaryIO, Iterator

#: Seconds between two tries.
_PAUSE = 0.2


@contextmanager
def alone(path: Path, waiting: str) -> Iterator[None]:
    """No other process is in this context for the same file meanwhile; the system lets go of it when a process dies.

    path: of the lock, which is made where it is not there, and stays. waiting: printed once where another is first.
    """
    with open(path, "ab") as stream:
        has_told = False
        while not _take(stream):
            if not has_told:
                print(waiting, flush=True)
                has_told = True
            time.sleep(_PAUSE)
        try:
            yield
        finally:
            _let_go(stream)


if os.name == "nt":
    import msvcrt

    def _take(stream: BinaryIO) -> bool:
        stream.seek(0)
        try:
            msvcrt.locking(stream.fileno(), msvcrt.LK_NBLCK, 1)
        except OSError:
            return False
        return True

    def _let_go(stream: BinaryIO) -> None:
        stream.seek(0)
        msvcrt.locking(stream.fileno(), msvcrt.LK_UNLCK, 1)

else:
    import fcntl

    def _take(stream: BinaryIO) -> bool:
        try:
            fcntl.flock(stream, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError:
            return False
        return True

    def _let_go(stream: BinaryIO) -> None:
        fcntl.flock(stream, fcntl.LOCK_UN)
