# SPDX-License-Identifier: GPL-3.0-or-later
"""One run at a time makes a result: it holds a lock file beside it, which the system releases if the process dies.

It sits in the bottom layer, below `whole_files`, through which every file is written. Beside a result NAME that is
being made stand the lock `.NAME.unfinished` and what is not finished yet, `.NAME.unfinished-*`. What dead processes
left of it is removed by the next claim. On a disk that cannot lock, as some network disks, only claims of the same
process are seen, and nothing is removed, because it may be the work of another machine.
"""

from __future__ import annotations

import errno
import hashlib
import os
import re
import shutil
import threading
from collections.abc import Iterable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import BinaryIO

if os.name == "nt":
    import msvcrt
else:
    import fcntl

#: Errors that mean that another process holds the lock; others mean that this disk cannot lock.
_HELD = {errno.EAGAIN, errno.EACCES, errno.EDEADLK}

#: Bytes of a name that still leave room for a prefix and suffixes in the 255 bytes that file systems allow.
_LONGEST = 200

#: result -> thread of this process that makes it
_claims: dict[Path, int] = {}


class WritingError(ValueError):
    """A result cannot be written, for a reason that the system does not report; with a sentence."""


class ClaimedError(WritingError):
    """Another run makes the result."""


@contextmanager
def claimed(result: str | os.PathLike) -> Iterator[None]:
    """Be the only one who makes `result` in this context; its folder must exist. Claims of one thread may nest.

    Raises ClaimedError with a sentence if another run makes it, and OSError if the folder cannot be written to.
    """
    target, thread = resolved(result), threading.get_ident()
    if _claims.get(target) == thread:
        yield
        return
    if _claims.setdefault(target, thread) != thread:
        raise _claimed_error(target)
    try:
        with _locked(target):
            yield
    finally:
        del _claims[target]


def resolved(result: str | os.PathLike) -> Path:
    """The file that has the name of a result; links are followed."""
    return Path(os.path.realpath(result))


def mark(target: Path) -> str:
    """The name of the lock of a result, with which the names of its unfinished files begin."""
    name = target.name
    if len(os.fsencode(name)) > _LONGEST:
        name = f"{name[:40]}-{hashlib.sha256(os.fsencode(name)).hexdigest()[:16]}"
    return f".{name}.unfinished"


def remove_leftovers(results: Iterable[str | os.PathLike]) -> None:
    """Remove what dead processes left while they made any of the results."""
    names: dict[Path, list[str]] = {}
    for result in results:
        target = resolved(result)
        if target.parent not in names:
            names[target.parent] = _hidden_names(target.parent)
        if any(name.startswith(mark(target)) for name in names[target.parent]):
            with suppress(ClaimedError), claimed(target):
                pass


def _hidden_names(folder: Path) -> list[str]:
    return [name for name in os.listdir(folder) if name.startswith(".")] if folder.is_dir() else []


def _claimed_error(target: Path) -> ClaimedError:
    return ClaimedError(f"Another run is making {target} at this moment; wait until it has ended, or stop it.")


@contextmanager
def _locked(target: Path) -> Iterator[None]:
    path = target.with_name(mark(target))
    try:
        taken = _taken(path)
    except OSError as error:
        error.filename = str(target)  # that of the lock means nothing to anybody
        raise
    if taken is None:
        raise _claimed_error(target)
    stream, is_locked = taken
    try:
        if is_locked:
            _remove_unfinished(target)
        yield
    finally:
        # Windows cannot remove an open file; elsewhere a lock that is removed while it is held is nobody's.
        if os.name == "nt":
            stream.close()
        with suppress(OSError):  # on Windows, the next owner has opened it already
            path.unlink()
        stream.close()


def _taken(path: Path) -> tuple[BinaryIO, bool] | None:
    """The open lock file, and whether this disk could lock it; None: another process holds it."""
    while True:
        stream = open(path, "ab")
        try:
            _lock(stream)
        except OSError as error:
            if error.errno in _HELD:
                stream.close()
                return None
            return stream, False
        if _is_still_at(path, stream):
            return stream, True
        stream.close()


def _is_still_at(path: Path, stream: BinaryIO) -> bool:
    """Whether an opened file still has its name: the owner before may have removed it before this one locked it."""
    try:
        return os.path.samestat(os.fstat(stream.fileno()), os.stat(path))
    except FileNotFoundError:
        return False


def _lock(stream: BinaryIO) -> None:
    """Lock a file until it is closed. Raises OSError at once if that is not possible."""
    if os.name == "nt":
        stream.seek(0)
        msvcrt.locking(stream.fileno(), msvcrt.LK_NBLCK, 1)
    else:
        fcntl.flock(stream, fcntl.LOCK_EX | fcntl.LOCK_NB)


def _remove_unfinished(target: Path) -> None:
    # a name that continues with another dot is the mark of another result
    unfinished = re.compile(re.escape(mark(target)) + r"-[^.]*(\.blend@?)?")
    for name in _hidden_names(target.parent):
        if unfinished.fullmatch(name):
            path = target.with_name(name)
            shutil.rmtree(path, ignore_errors=True) if path.is_dir() else path.unlink(missing_ok=True)
