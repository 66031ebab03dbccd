# SPDX-License-Identifier: GPL-3.0-or-later
"""Every file of the project is written here: it appears under its name once it is whole, and before that not at all.

It is written in a hidden folder beside its place, on the same disk, flushed to the disk, read back, and only then
renamed. What was there before stays until then: a full disk, a killed process or an error changes nothing. Whoever
deletes what a result was made from does so after that. It sits in the bottom layer, for all others to use.
"""

from __future__ import annotations

import os
import shutil
import stat
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from functools import partial
from pathlib import Path
from typing import BinaryIO

from .claims import WritingError, claimed, mark, resolved


class NotWholeError(WritingError):
    """A file could not be written to its end, or cannot be read back."""


@contextmanager
def unfinished(result: str | os.PathLike, check: Callable[[Path], object]) -> Iterator[Path]:
    """A folder in which to write `result`, and files that belong beside it, under their own names.

    When the context ends without an error, `check` reads back each of them, and raises OSError, ValueError,
    RuntimeError or EOFError if it is not whole. Then they get their places: `result` where its link points to, if it is
    one, with the mode of the file that it replaces. Folders in the folder are scratch.

    Raises OSError, ClaimedError if another run makes the same result, and NotWholeError with a sentence; then no file
    has been replaced, and nothing is left.
    """
    target, name = resolved(result), Path(result).name
    with _naming(target), claimed(target):
        folder = target.with_name(f"{mark(target)}-{os.urandom(4).hex()}")
        # not `tempfile.mkdtemp`, whose folder on Windows makes files that only their owner may read
        folder.mkdir()
        try:
            yield folder
            files = _files(folder)
            places = {file: target if file.name == name else target.with_name(file.name) for file in files}
            if not files:
                raise NotWholeError(f"Nothing was written for {target}.")
            for file, place in places.items():
                _make_sure(file, place, check)
            for file, place in places.items():
                os.replace(file, place)
            _flush_folder(target.parent)
        finally:
            shutil.rmtree(folder, ignore_errors=True)


@contextmanager
def whole_file(path: str | os.PathLike, check: Callable[[Path], object]) -> Iterator[BinaryIO]:
    """Open a stream that becomes the file `path`, as in `unfinished`. A device is written to directly."""
    target = resolved(path)
    if target.exists() and not target.is_file():
        with open(target, "wb") as stream:
            yield stream
        return
    with unfinished(target, check) as folder, open(folder / target.name, "wb") as stream:
        yield stream


def write_whole(path: str | os.PathLike, contents: bytes) -> None:
    """Write a file that memory holds. Raises as `unfinished`."""
    with whole_file(path, partial(_compare, contents)) as stream:
        stream.write(contents)


def _compare(contents: bytes, file: Path) -> None:
    if file.read_bytes() != contents:
        raise ValueError("It differs from what was written.")


@contextmanager
def _naming(target: Path) -> Iterator[None]:
    """Let an error name this file that names none, as that of a full disk, or a hidden one."""
    try:
        yield
    except OSError as error:
        is_hidden = error.filename is None or mark(target) in os.path.basename(os.fspath(error.filename))
        if error.errno is not None and is_hidden:
            error.filename = str(target)
        raise


def _files(folder: Path) -> list[Path]:
    return sorted(path for path in folder.iterdir() if path.is_file())


def _make_sure(file: Path, place: Path, check: Callable[[Path], object]) -> None:
    """Flush a file to the disk, read it back, and give it the mode of the one that it replaces."""
    with open(file, "rb+") as stream:
        os.fsync(stream.fileno())
    try:
        check(file)
    except (OSError, ValueError, RuntimeError, EOFError) as error:
        why = error.strerror or error if isinstance(error, OSError) else error
        raise NotWholeError(
            f"{place} could not be written whole, so nothing was changed; is the disk full? {why}"
        ) from error
    if place.is_file():
        os.chmod(file, stat.S_IMODE(place.stat().st_mode))


def _flush_folder(folder: Path) -> None:
    """Have the disk know the new names before anybody deletes what a result was made from; Windows does so itself."""
    if os.name != "nt":
        number = os.open(folder, os.O_RDONLY)
        with suppress(OSError):  # some network disks flush no folders
            os.fsync(number)
        os.close(number)
