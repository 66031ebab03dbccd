# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads and writes numpy's .npz files, in which machines hand parts of their work to one another.

It sits in the bottom layer, because both sampling (blocks of surfels) and rendering (tiles of pictures) use it.

numpy's own reader takes any type that a file names, and allocates what its header says before it looks for the numbers.
This one takes types from a fixed list, and no more numbers than there are bytes.
"""

from __future__ import annotations

import io
import os
import zipfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np

from .whole_files import whole_file

#: The types that an array may have.
_TYPES = {np.dtype(code) for code in ("?", "u1", "<i2", "<i4", "<u4", "<i8", "<u8", "<f4", "<f8")}

#: numpy's function that reads the header of each version of its format.
_HEADERS = {(1, 0): np.lib.format.read_array_header_1_0, (2, 0): np.lib.format.read_array_header_2_0}


class StoredArrays:
    """The arrays of a file, each read when it is asked for. names: theirs."""

    def __init__(self, archive: zipfile.ZipFile):
        self._archive = archive
        self.names = [name.removesuffix(".npy") for name in archive.namelist()]

    def __contains__(self, name: str) -> bool:
        return name in self.names

    def __getitem__(self, name: str) -> np.ndarray:
        """An array of the type and shape that the file gives it, if it has as many bytes."""
        member = self._archive.getinfo(f"{name}.npy")
        if member.compress_type != zipfile.ZIP_STORED:
            raise ValueError("Compressed arrays are not written, and could be of any size.")
        stream = io.BytesIO(self._archive.read(member))
        shape, is_fortran, kind = _HEADERS[np.lib.format.read_magic(stream)](stream)
        if kind not in _TYPES or is_fortran or any(length < 0 for length in shape):
            raise ValueError(f"An array of the type {kind} is not written.")
        return np.frombuffer(stream.read(), kind).reshape(shape)

    def take(self, name: str, kind: type, shape: tuple[int, ...]) -> np.ndarray:
        """An array that must have this type and shape. shape: -1 for any length."""
        array = self[name]
        fits = len(array.shape) == len(shape) and all(n in (-1, own) for n, own in zip(shape, array.shape, strict=True))
        if array.dtype != kind or not fits:
            raise ValueError(f"{name} is {array.dtype} {array.shape} and not {np.dtype(kind)} {shape}.")
        return array


@contextmanager
def opened_arrays(path: str | os.PathLike, kind: str, remedy: str) -> Iterator[StoredArrays]:
    """The arrays of a file; nothing in it is executed. The context must only read and check them.

    Raises OSError if the file cannot be opened. Whatever else fails in the context means that the file is damaged, and
    raises ValueError with a sentence. kind, remedy: what the file should be, and what to do if it is not.
    """
    with open(path, "rb") as stream:
        try:
            with zipfile.ZipFile(stream) as archive:
                yield StoredArrays(archive)
        except MemoryError:
            raise
        except Exception as error:  # zipfile and numpy raise a dozen kinds
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
