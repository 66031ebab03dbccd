# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads and writes the vertices of a PLY file as named columns. Sizes are checked against the file before any array is
allocated, so a small file cannot ask for a huge allocation."""

from __future__ import annotations

import os
from collections.abc import Iterator
from functools import partial
from pathlib import Path
from typing import BinaryIO, NamedTuple

import numpy as np

from ..whole_files import whole_file
from .ply_header import TYPES, Element, Header, read_header
from .ply_text import read_text

_VERTEX = "vertex"

#: Names of the element that holds the points, in small letters, the usual one first.
_POINTS = (_VERTEX, "vertices", "point", "points", "splat", "splats")

#: numpy's type code -> the type name that every reader knows
_TYPE_NAMES = {code: name for name, code in reversed(TYPES.items())}

#: Digits that preserve every bit, by type code.
_TEXT_FORMATS = {"f4": "%.9g", "f8": "%.17g"}


class Vertices(NamedTuple):
    """columns: (N,) by property name, in the types declared in the header. comments: the header's.
    others: rows of the elements that are not the points, by name, without empty ones."""

    columns: dict[str, np.ndarray]
    comments: tuple[str, ...]
    others: dict[str, int]


def read_vertices(path: str | os.PathLike) -> Vertices:
    """The vertices of a PLY file.

    Raises ValueError with one sentence for a file that is not PLY or is damaged, OSError if it cannot be opened.
    """
    return next(vertex_portions(path))


def read_element(path: str | os.PathLike, name: str) -> dict[str, np.ndarray]:
    """The columns of another element of numbers; none if the file has no such element. Raises as `read_vertices`."""
    size = os.path.getsize(path)
    with open(path, "rb") as stream:
        header = read_header(stream)
        element = next(
            (each for each in header.elements if each.name == name and None not in each.types.values()), None
        )
        if element is None or not element.types:
            return {}
        if header.byte_order is None:
            return read_text(stream, size, header, element)
        return next(_read_binary(stream, size, header, element, None))


def vertex_count(path: str | os.PathLike) -> int:
    """The number of vertices that the header declares. Raises as `read_vertices`."""
    with open(path, "rb") as stream:
        return _vertices(read_header(stream)).count


def vertex_portions(path: str | os.PathLike, most: int | None = None) -> Iterator[Vertices]:
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
        others = {each.name: each.count for each in header.elements if each is not vertex and each.count}
        if header.byte_order is None:
            yield Vertices(read_text(stream, size, header, vertex), header.comments, others)
        else:
            for columns in _read_binary(stream, size, header, vertex, most):
                yield Vertices(columns, header.comments, others)


def _vertices(header: Header) -> Element:
    by_name = {element.name.lower(): element for element in header.elements}
    for name in _POINTS:
        if name in by_name:
            return by_name[name]
    others = ", ".join(repr(element.name[:40]) for element in header.elements[:8]) or "none"
    raise ValueError(f"The PLY file has no element '{_VERTEX}', so there are no points in it; its elements: {others}.")


def write_vertices(
    path: str | os.PathLike, columns: dict[str, np.ndarray], comments: tuple[str, ...], ascii: bool
) -> None:
    """A PLY file with (N,) columns as vertex properties, in the columns' types; little endian unless `ascii`.

    Raises as `whole_files.unfinished`.
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
    with whole_file(path, partial(_check_end, count)) as stream:
        stream.write("\n".join([*head, "end_header", ""]).encode("ascii"))
        if ascii:
            np.savetxt(stream, rows, fmt=" ".join(_TEXT_FORMATS.get(code, "%d") for code in codes.values()))
        else:
            # not `tofile`, whose error on a full disk names only two numbers
            stream.write(rows.view(np.uint8).data)


def _check_end(count: int, file: Path) -> None:
    """Raise OSError or ValueError if a written file does not end with the last of `count` rows."""
    with open(file, "rb") as stream:
        header = read_header(stream)
        if header.byte_order is None:
            stream.seek(header.size)
            found = sum(chunk.count(b"\n") for chunk in iter(partial(stream.read, 1 << 20), b""))
        else:
            found = (os.path.getsize(file) - header.size) / _row_type(_vertices(header), header).itemsize
    if not count == found == _vertices(header).count:
        raise ValueError(f"It has {found:,.0f} of {count:,} points.")


def _read_binary(
    stream: BinaryIO, size: int, header: Header, vertex: Element, most: int | None
) -> Iterator[dict[str, np.ndarray]]:
    skipped = 0
    for element in header.elements[: header.elements.index(vertex)]:
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
            f"but only {max(available, 0):,} bytes are left for them; it is cut off or damaged; copy it again."
        )
    stream.seek(header.size + skipped)
    for first in range(0, max(vertex.count, 1), most or max(vertex.count, 1)):
        count = min(most or vertex.count, vertex.count - first)
        rows = np.frombuffer(stream.read(count * row.itemsize), row)
        yield {name: np.ascontiguousarray(rows[name], rows[name].dtype.newbyteorder("=")) for name in vertex.types}


def _row_type(element: Element, header: Header) -> np.dtype:
    return np.dtype([(name, header.byte_order + code) for name, code in element.types.items()])
