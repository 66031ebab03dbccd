# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads the lines of text files of points, a portion at a time, and says which line is wrong."""

from __future__ import annotations

import re
import warnings
from collections.abc import Iterator
from dataclasses import dataclass
from io import TextIOWrapper
from itertools import islice
from typing import BinaryIO

import numpy as np

from .clouds import COLOR, PORTION, Table

#: Bytes at the beginning of a file that tell what it is.
HEAD = 1 << 16

#: A line that says how many rows follow.
_COUNT = re.compile(r"\s*[0-9]{1,18}\s*")

#: Words at the start of a line of comment.
COMMENTS = ("#", "//", "!")


@dataclass
class Lines:
    """The lines of an opened text file; `number` lines were read so far. size: of the file in bytes."""

    stream: BinaryIO
    size: int
    number: int = 0

    def __post_init__(self):
        # any bytes are letters of this encoding; a mark of UTF-8 counts as blank
        self._text = TextIOWrapper(self.stream, "latin-1")

    def take(self, count: int) -> list[str]:
        """The next lines, fewer at the end of the file."""
        lines = list(islice(self._text, count))
        self.number += len(lines)
        return lines

    @property
    def share(self) -> float:
        """The share of the file that was read."""
        return min(self.stream.tell() / max(self.size, 1), 1.0)

    def rows(
        self, count: int | None, width: int, separator: str | None = None, counts: list[int] | None = None
    ) -> Iterator[np.ndarray]:
        """(n, width) float64 of each portion of the next `count` lines, or of all that follow. Blank lines and those of
        comment are none. separator: None for blanks. counts: as of `table_of`. Raises ValueError with a sentence."""
        left = count
        while left is None or left > 0:
            first = self.number + 1
            lines = self.take(PORTION if left is None else min(left, PORTION))
            if not lines:
                return
            table = table_of(lines, width, separator, first, counts)
            if left is not None:
                left -= len(lines)
            yield table


def table_of(
    lines: list[str], width: int, separator: str | None, first: int, counts: list[int] | None = None
) -> np.ndarray:
    """(n, width) float64. first: the number of the first line. counts: gets whole numbers that stand alone on a line;
    None: there may be none. Raises ValueError with a sentence."""
    if separator == ";":  # then a comma may stand for the point of a number
        lines = [line.replace(",", ".") for line in lines]
    kept = [line for line in lines if not _says_nothing(line)]
    if not kept:
        return np.empty((0, width))
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", UserWarning)
            table = np.loadtxt(kept, np.float64, comments=None, delimiter=separator, ndmin=2)
        if table.shape == (len(kept), width):
            return table
    except ValueError:
        pass
    rows = []
    for number, line in enumerate(lines, first):
        if counts is not None and width > 1 and _COUNT.fullmatch(line):
            counts.append(int(line))
        elif not _says_nothing(line):
            rows.append(_numbers(line, width, separator, number))
    return np.array(rows).reshape(-1, width)


def words_of(line: str, separator: str | None) -> list[str]:
    """The words of a line; a separator at its end adds none."""
    words = [word.strip().strip('"') for word in line.strip().split(separator)]
    return words[:-1] if separator and words and not words[-1] else words


def _numbers(line: str, width: int, separator: str | None, number: int) -> list[float]:
    words = words_of(line, separator)
    if len(words) != width:
        cure = "correct or delete it" if line.endswith("\n") else "the file ends within it: copy it again"
        raise ValueError(
            f"Line {number:,} of the file has {len(words):,} numbers where others have {width}, {line[:60].strip()!r}; "
            f"{cure}."
        )
    try:
        return [float(word) for word in words]
    except ValueError:
        pass
    raise ValueError(f"Line {number:,} of the file is not all numbers, {line[:60].strip()!r}; correct or delete it.")


def _says_nothing(line: str) -> bool:
    line = line.lstrip()
    return not line or line.startswith(COMMENTS)


def is_text(head: bytes) -> bool:
    """Whether a file that begins so can be text of numbers."""
    return bool(head) and not any(byte < 9 or 13 < byte < 32 or byte == 127 for byte in head[:4096])


def lines_of(head: bytes) -> list[str]:
    """The whole lines at the beginning of a file."""
    lines = head.decode("latin-1").removeprefix("\xef\xbb\xbf").splitlines()
    # the last one may go on beyond what was read
    return lines[:-1] if len(head) >= HEAD and not head.endswith((b"\n", b"\r")) else lines


def numbers_in(line: str, separator: str | None = None) -> list[float]:
    """The numbers of a line; none if a word is no number."""
    try:
        return [float(word) for word in words_of(line, separator)]
    except ValueError:
        return []


def with_whole_colors(table: Table) -> Table:
    """A table of text whose colours are of 8 or 16 bits as integers, as if the file had said so."""
    colors = [table[name] for name in COLOR if name in table]
    if not colors or max(c.max(initial=0) for c in colors) <= 1:  # 1 may be white
        return table
    for kind in (np.uint8, np.uint16):
        if all(((c >= 0) & (c <= np.iinfo(kind).max) & (c == np.rint(c))).all() for c in colors):
            return table | {name: table[name].astype(kind) for name in COLOR if name in table}
    return table
