# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads and writes numpy's .npz files, in which machines hand parts of their work to one another.

It sits in the bottom layer, because both sampling (blocks of surfels) and rendering (tiles of pictures) use it.
"""

from __future__ import annotations

import os
import zipfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np

from .whole_files import whole_file


@contextmanager
def opened_arrays(path: str | os.PathLike, kind: str, remedy: str) -> Iterator[np.lib.npyio.NpzFile]:
    """The arrays of a file; nothing in it is executed. The context must only read them.

    Raises OSError if the file cannot be opened. Whatever else fails in the context means that the file is damaged, and
    raises ValueError with a sentence. kind, remedy: what the file should be, and what to do if it is not.
    """
    with open(path, "rb") as stream:
        try:
            with np.load(stream, allow_pickle=False) as arrays:
                yield arrays
        except MemoryError:
            raise
        except Exception as error:  # numpy and zipfile raise a dozen kinds
            raise ValueError(f"{path} is damaged or is not {kind}; {remedy}.") from error


def write_arrays(path: str | os.PathLike, arrays: dict[str, np.ndarray]) -> None:
    """Write arrays by name. Raises as `whole_files.unfinished`."""
    with whole_file(path, _check) as stream:
        np.savez(stream, **arrays)


def _check(file: Path) -> None:
    """Compare each array with its checksum. Raises OSError or ValueError."""
    try:
        with zipfile.ZipFile(file) as arrays:
            if damaged := arrays.testzip():
                raise ValueError(f"Its array {damaged} is damaged.")
    except (zipfile.BadZipFile, EOFError) as error:
        raise ValueError(f"It is no whole archive: {error}.") from error


def is_archive(file: Path) -> bool:
    """Whether a file is there that ends as such a file does: not one that is cut off."""
    return file.is_file() and zipfile.is_zipfile(file)
