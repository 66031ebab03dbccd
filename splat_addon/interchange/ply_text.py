# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads the points of a text PLY file: fast where each line is a point, and otherwise number by number, which tells
what is wrong and where.

Slips whose meaning is plain are read: blank lines, lines of comment, points wrapped over lines or put on one, numbers
of Fortran (1.5D+00) and Windows (-1.#IND, -nan(ind)). All others give a sentence with the line's number.
"""

from __future__ import annotations

import io
import re
import warnings
from collections.abc import Iterator
from itertools import islice
from typing import BinaryIO, TextIO

import numpy as np

from .ply_header import Element, Header

#: Words at the start of a line of comment.
_COMMENTS = ("#", "comment", "//")

#: How some programs write numbers that float() does not read -> what it reads.
_SPELLINGS = (
    (re.compile(r"[-+]?(?:nan\(.*\)|1\.#(?:ind|qnan|snan)\d*)", re.IGNORECASE), "nan"),
    (re.compile(r"([-+]?)1\.#inf\d*", re.IGNORECASE), r"\1inf"),
    (re.compile(r"([-+]?[\d.]+)d([-+]?\d+)", re.IGNORECASE), r"\1e\2"),
)


def read_text(stream: BinaryIO, size: int, header: Header, vertex: Element) -> dict[str, np.ndarray]:
    """(N,) columns by property name. size: of the file in bytes; stream: anywhere in it. Raises ValueError with a
    sentence."""
    before = sum(element.count for element in header.elements[: header.elements.index(vertex)])
    # Each value takes a digit and a separator, except for the last value in the file.
    least = 2 * vertex.count * len(vertex.types) + before - 1
    if least > size - header.size:
        raise ValueError(
            f"The PLY file says that it has {vertex.count:,} points of {len(vertex.types)} numbers, "
            f"but only {size - header.size:,} letters follow; it is cut off or damaged; copy it again."
        )
    table = _table(stream, header, before, vertex) if vertex.count else np.empty((0, len(vertex.types)))
    return {name: _as_type(column, code) for (name, code), column in zip(vertex.types.items(), table.T, strict=True)}


def _table(stream: BinaryIO, header: Header, before: int, vertex: Element) -> np.ndarray:
    """(N, columns) float64. before: rows of elements before the points."""
    text = io.TextIOWrapper(stream, "latin-1")  # whose lines end with LF, CR LF or CR
    try:
        text.seek(header.size)
        table = _table_of_lines(text, before, vertex)
        if table is None:
            text.seek(header.size)
            table = _table_of_numbers(text, header, before, vertex)
        return table
    finally:
        text.detach()


def _table_of_lines(lines: TextIO, before: int, vertex: Element) -> np.ndarray | None:
    """(N, columns) float64, or None if the lines are not one point each, of as many numbers as were declared."""
    try:
        with warnings.catch_warnings():
            # what has no numbers is told by `_table_of_numbers`
            warnings.simplefilter("ignore", UserWarning)
            table = np.loadtxt(islice(lines, before, before + vertex.count), np.float64, comments=None, ndmin=2)
    except ValueError:
        return None
    return table if table.shape == (vertex.count, len(vertex.types)) else None


def _table_of_numbers(text: TextIO, header: Header, before: int, vertex: Element) -> np.ndarray:
    """(N, columns) float64. Raises ValueError with a sentence if the numbers are not those of the points alone."""
    width = len(vertex.types)
    lines = _numbered_words(text, header.lines + 1)
    for _ in islice(lines, before):
        pass
    odd = []  # the first line that is not one point: its number, and how many words it has
    numbers = _numbers(lines, vertex.count * width, width, odd)
    table = np.fromiter(numbers, np.float64)
    if len(table) < vertex.count * width:
        raise ValueError(
            f"The PLY file says that it has {vertex.count:,} points of {width} numbers, "
            f"but only {len(table) // width:,} whole ones follow; it is cut off or damaged; copy it again."
        )
    if odd and (len(table) > vertex.count * width or sum(1 for _ in lines) != _rows_after(header, vertex)):
        number, found = odd[0]
        names = " ".join(vertex.types)
        raise ValueError(
            f"Line {number:,} of the PLY file has {found:,} numbers, where the header declares {width} for each point, "
            f"{names[:80]!r}; correct one of them."
        )
    return table.reshape(vertex.count, width)


def _numbers(lines: Iterator[tuple[int, list[str]]], most: int, width: int, odd: list) -> Iterator[float]:
    """The numbers of lines until there are `most` or, within a line, more."""
    count = 0
    while count < most:
        number, words = next(lines, (0, []))
        if not words:
            return
        if len(words) != width and not odd:
            odd.append((number, len(words)))
        for word in words:
            yield _number(word, number)
        count += len(words)


def _numbered_words(lines: TextIO, first: int) -> Iterator[tuple[int, list[str]]]:
    """The number, counted from `first`, and the words of each line that is neither blank nor a comment."""
    for number, line in enumerate(lines, first):
        words = line.split()
        if words and not line.lstrip().lower().startswith(_COMMENTS):
            yield number, words


def _number(word: str, line: int) -> float:
    try:
        return float(word)
    except ValueError:
        for pattern, meant in _SPELLINGS:
            if pattern.fullmatch(word):
                return float(pattern.sub(meant, word))
    remedy = "write numbers with a point and blanks between them" if "," in word else "correct it"
    raise ValueError(f"Line {line:,} of the PLY file has {word[:40]!r} where a number must be; {remedy}.")


def _rows_after(header: Header, vertex: Element) -> int:
    """How many rows the elements after the points have, each of which is a line."""
    return sum(element.count for element in header.elements[header.elements.index(vertex) + 1 :])


def _as_type(column: np.ndarray, code: str) -> np.ndarray:
    """Text converted to the declared type; numbers out of range are clamped to the type's range."""
    if code[0] != "f":
        limits = np.iinfo(code)
        # the largest numbers of 64 bits that float64 has too
        column = np.clip(np.nan_to_num(column), max(limits.min, -(2.0**62)), min(limits.max, 2.0**62))
    with np.errstate(over="ignore"):
        return column.astype(code)
