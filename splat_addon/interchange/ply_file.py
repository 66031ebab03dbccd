# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads and writes the vertices of a PLY file as named columns. Sizes are checked against the file before any array is
allocated, so a small file cannot ask for a huge allocation."""

from __future__ import annotations

import os
import warnings
from collections.abc import Iterator
from itertools import islice
from typing import BinaryIO

import numpy as np

from .ply_header import TYPES, Element, Header, read_header
from .whole_file import whole_file

_VERTEX = "vertex"

#: numpy's type code -> the type name that every reader knows
_TYPE_NAMES = {code: name for name, code in reversed(TYPES.items())}

#: Digits that preserve every bit, by type code.
_TEXT_FORMATS = {"f4": "%.9g", "f8": "%.17g"}


def read_vertices(path: str | os.PathLike) -> tuple[dict[str, np.ndarray], tuple[str, ...]]:
    """(N,) columns by property name, in the types declared in the header, and the header's comments.

    Raises ValueError with one sentence for a file that is not PLY or is damaged, OSError if it cannot be opened.
    """
    return next(vertex_portions(path))


def vertex_count(path: str | os.PathLike) -> int:
    """The number of vertices that the header declares. Raises as `read_vertices`."""
    with open(path, "rb") as stream:
        return _vertices(read_header(stream)).count


def vertex_portions(
    path: str | os.PathLike, most: int | None = None
) -> Iterator[tuple[dict[str, np.ndarray], tuple[str, ...]]]:
    """The vertices as in `read_vertices`, but at most `most` at a time; at least one portion, which may be empty. A
    text file is a single portion.
    """
    size = os.path.getsize(path)
    with open(path, "rb") as stream:
        header = read_header(stream)
        vertex = _vertices(header)
        if None in vertex.types.values():
            name = next(name for name, code in vertex.types.items() if code is None)
            raise ValueError(f"The property {name[:40]!r} of the PLY file's points is a list; only numbers can be.")
        if not vertex.types:
            raise ValueError("The points in the PLY file have no properties, not even a position.")
        before = header.elements[: header.elements.index(vertex)]
        if header.byte_order is None:
            yield _read_text(stream, size, header, before, vertex), header.comments
        else:
            for columns in _read_binary(stream, size, header, before, vertex, most):
                yield columns, header.comments


def _vertices(header: Header) -> Element:
    vertex = next((element for element in header.elements if element.name == _VERTEX), None)
    if vertex is None:
        raise ValueError(f"The PLY file has no element '{_VERTEX}', so there are no points in it.")
    return vertex


def write_vertices(
    path: str | os.PathLike, columns: dict[str, np.ndarray], comments: tuple[str, ...], ascii: bool
) -> None:
    """A PLY file with (N,) columns as vertex properties, in the columns' types; little endian unless `ascii`.

    The file appears under its name only once it is complete. Raises OSError if it cannot be written.
    """
    codes = {name: np.asarray(column).dtype.str[1:] for name, column in columns.items()}
    count = len(next(iter(columns.values())))
    rows = np.empty(count, np.dtype([(name, "<" + code) for name, code in codes.items()]))
    for name, column in columns.items():
        rows[name] = column
    head = ["ply", f"format {'ascii' if ascii else 'binary_little_endian'} 1.0"]
    head += [f"comment {comment}" for comment in comments]
    head += [f"element {_VERTEX} {count}"]
    head += [f"property {_TYPE_NAMES[code]} {name}" for name, code in codes.items()]
    with whole_file(path) as stream:
        stream.write("\n".join([*head, "end_header", ""]).encode("ascii"))
        if ascii:
            np.savetxt(stream, rows, fmt=" ".join(_TEXT_FORMATS.get(code, "%d") for code in codes.values()))
        else:
            # not `tofile`, whose error on a full disk names only two numbers
            stream.write(rows.view(np.uint8).data)


def _read_binary(
    stream: BinaryIO, size: int, header: Header, before, vertex: Element, most: int | None
) -> Iterator[dict[str, np.ndarray]]:
    skipped = 0
    for element in before:
        if None in element.types.values():
            raise ValueError(
                f"The PLY element {element.name[:40]!r} has lists and stands before the points, which cannot be "
                f"found so; save the file with the points first."
            )
        skipped += element.count * _row_type(element, header).itemsize
    row = _row_type(vertex, header)
    available = size - header.size - skipped
    if vertex.count * row.itemsize > available:
        raise ValueError(
            f"The PLY file says that it has {vertex.count:,} points of {row.itemsize} bytes, "
            f"but only {max(available, 0):,} bytes are left for them; it is cut off or damaged."
        )
    stream.seek(header.size + skipped)
    for first in range(0, max(vertex.count, 1), most or max(vertex.count, 1)):
        count = min(most or vertex.count, vertex.count - first)
        rows = np.frombuffer(stream.read(count * row.itemsize), row)
        yield {name: np.ascontiguousarray(rows[name], rows[name].dtype.newbyteorder("=")) for name in vertex.types}


def _row_type(element: Element, header: Header) -> np.dtype:
    return np.dtype([(name, header.byte_order + code) for name, code in element.types.items()])


def _read_text(stream: BinaryIO, size: int, header: Header, before, vertex: Element) -> dict[str, np.ndarray]:
    lines = sum(element.count for element in before)
    # Each value takes a digit and a separator, except for the last value in the file.
    least = 2 * vertex.count * len(vertex.types) + lines - 1
    if least > size - header.size:
        raise ValueError(
            f"The PLY file says that it has {vertex.count:,} points of {len(vertex.types)} numbers, "
            f"but only {size - header.size:,} letters follow; it is cut off or damaged."
        )
    text = (line.decode("latin-1") for line in islice(stream, lines, lines + vertex.count))
    try:
        with warnings.catch_warnings():
            # Files without data get their own error message below.
            warnings.simplefilter("ignore", UserWarning)
            table = np.loadtxt(text, np.float64, comments=None, ndmin=2) if vertex.count else np.empty((0, 0))
    except ValueError as error:
        raise ValueError(f"The PLY file's points cannot be read: {error!s:.120}.".replace("\n", " ")) from None
    if vertex.count and table.shape != (vertex.count, len(vertex.types)):
        raise ValueError(
            f"The PLY file says that it has {vertex.count:,} points of {len(vertex.types)} numbers, but "
            f"{table.shape[0]:,} of {table.shape[1]} were found; it is cut off or damaged."
        )
    columns = table.T if vertex.count else np.empty((len(vertex.types), 0))
    return {name: _as_type(column, code) for (name, code), column in zip(vertex.types.items(), columns, strict=True)}


def _as_type(column: np.ndarray, code: str) -> np.ndarray:
    """Text converted to the declared type; numbers out of range are clamped to the type's range."""
    if code[0] != "f":
        limits = np.iinfo(code)
        column = np.clip(np.nan_to_num(column), limits.min, limits.max)
    with np.errstate(over="ignore"):
        return column.astype(code)
