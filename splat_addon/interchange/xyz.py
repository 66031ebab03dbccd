# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads points of text files: PTS, XYZ, CSV and the like, a point on each line.

What the columns are is told by a line of names before the first numbers, or else by their number and their first
values, and it is said; or the user says it. A line with a single number before the points, or between them, is the
count of those that follow, as PTS has it.
"""

from __future__ import annotations

import os
import re
from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from .clouds import COLOR, Cloud, Table
from .columns import NORMAL, POSITION
from .text_rows import COMMENTS, HEAD, Lines, is_text, lines_of, numbers_in, with_whole_colors, words_of

#: Lines at the beginning that are looked at, and columns that points may have.
_LOOKED_AT, _MOST_COLUMNS = 200, 100

#: Stands for a column that is left out.
LEFT_OUT = "-"

#: Column -> names that programs give it, in small letters without anything else.
_NAMES = {
    "x": ("x", "easting", "east", "coordx", "xcoord", "xcoordinate", "posx", "px"),
    "y": ("y", "northing", "north", "coordy", "ycoord", "ycoordinate", "posy", "py"),
    "z": ("z", "height", "elevation", "altitude", "coordz", "zcoord", "zcoordinate", "posz", "pz"),
    "red": ("r", "red"),
    "green": ("g", "green"),
    "blue": ("b", "blue"),
    **{f"n{axis}": (f"n{axis}", f"normal{axis}") for axis in "xyz"},
    "intensity": ("i", "intensity", "reflectance", "scalarintensity"),
}
_COLUMNS = {name: column for column, names in _NAMES.items() for name in names}


@dataclass(frozen=True)
class _Layout:
    """start: number of lines before the first point. count: the points that the file says it has, or None. names: of
    the columns. separator: None for blanks. how: they were found, the word for it."""

    start: int
    count: int | None
    names: tuple[str, ...]
    separator: str | None
    how: str


def is_this(head: bytes) -> bool:
    return _layout(head) is not None


def columns_of(head: bytes) -> tuple[str, ...]:
    """What the columns of a file are that begins so, as it names them or as they are guessed; none if it is no text of
    points."""
    layout = _layout(head)
    return () if layout is None else layout.names


def _chosen(columns: tuple[str, ...], width: int) -> tuple[str, ...]:
    """The names of the columns as the user says them. Raises ValueError with a sentence."""
    names = tuple(_COLUMNS.get(name.lower(), name) for name in columns)
    kept = [name for name in names if name != LEFT_OUT]
    if len(names) != width or len(set(kept)) < len(kept) or not set(POSITION) <= set(kept):
        raise ValueError(
            f"The text has {width} columns, which must be named once each, among them x, y and z, and {LEFT_OUT} for "
            f"one to leave out, not {' '.join(columns)[:80]!r}."
        )
    return tuple(name if name != LEFT_OUT else f"column_{k + 1}" for k, name in enumerate(names))


def opened(path: str | os.PathLike, columns: tuple[str, ...] = ()) -> Cloud:
    """The points of the file. columns: what its columns are, "-" for one to leave out; by default as named or guessed.
    Raises ValueError with a sentence if there are others, OSError."""
    with open(path, "rb") as stream:
        layout = _layout(stream.read(HEAD))
    if columns:
        layout = replace(layout, names=_chosen(columns, len(layout.names)), how="chosen")
    cloud = Cloud(iter(()))
    cloud.portions = _portions(path, layout, cloud.said)
    return cloud


def _portions(path: str | os.PathLike, layout: _Layout, said: list[str]) -> Iterator[tuple[float, Table]]:
    said.append(f"Took the columns of the text, as {layout.how}, as {' '.join(layout.names)}")
    found, counts = 0, []
    with open(path, "rb") as stream:
        lines = Lines(stream, os.path.getsize(path))
        lines.take(layout.start)
        for rows in lines.rows(None, len(layout.names), layout.separator, counts):
            found += len(rows)
            yield lines.share, with_whole_colors(dict(zip(layout.names, rows.T.copy(), strict=True)))
    told = None if layout.count is None else layout.count + sum(counts)
    if told not in (None, found):
        said.append(f"Read {found:,} points, where the file says that it has {told:,}")


def _layout(head: bytes) -> _Layout | None:
    """How the points are written; None if there are none."""
    if not is_text(head):
        return None
    lines = lines_of(head)[:_LOOKED_AT]
    rows = [_row(line) for line in lines]
    start = next((number for number, row in enumerate(rows) if len(row) >= 3), None)
    if start is None or len(rows[start]) > _MOST_COLUMNS:
        return None
    width, separator = len(rows[start]), _separator(lines[start])
    counts = [int(row[0]) for row in rows[:start] if len(row) == 1 and 0 <= row[0] < 2**62]
    named = [line for line, row in zip(lines[:start], rows, strict=False) if line.strip() and not row]
    names = _given_names(named[-1], separator, width) if named else ()
    guessed = _guessed_names(np.array([row for row in rows[start:] if len(row) == width]))
    return _Layout(start, counts[0] if counts else None, names or guessed, separator, "named" if names else "guessed")


def _row(line: str) -> list[float]:
    separator = _separator(line)
    return numbers_in(line.replace(",", ".") if separator == ";" else line, separator)


def _separator(line: str) -> str | None:
    return next((each for each in ";," if each in line), None)


def _given_names(line: str, separator: str | None, width: int) -> tuple[str, ...]:
    """The names of the columns in a line before the points; none if it does not name x, y and z."""
    text = line.strip()
    for comment in COMMENTS:
        text = text.removeprefix(comment)
    words = words_of(text, separator)
    plain = [re.sub(r"[\[(].*|[^a-z]", "", word.lower()) for word in words]
    names = [_COLUMNS.get(each, word[:40]) for each, word in zip(plain, words, strict=True)]
    is_whole = len(names) == width and set(POSITION) <= set(names) and len(set(names)) == width
    return tuple(names) if is_whole else ()


def _guessed_names(rows: np.ndarray) -> tuple[str, ...]:
    """The names of columns by their first values: x y z; then an intensity, if the others are not all triples; then
    colours and normals."""
    width = rows.shape[1]
    names = [*POSITION, *(["intensity"] if width % 3 == 1 else [])]
    while width - len(names) >= 3:
        group = rows[:, len(names) : len(names) + 3]
        names += _group(group, names)
    return (*names, *(f"column_{k + 1}" for k in range(len(names), width)))


def _group(group: np.ndarray, names: list[str]) -> tuple[str, ...]:
    with np.errstate(over="ignore", invalid="ignore"):
        is_unit = bool((np.abs(np.linalg.norm(group, axis=1) - 1) < 0.02).mean() > 0.9)
        is_color = bool(((group >= 0) & (group <= 65535) & (group == np.rint(group))).all())
        is_color = is_color or bool(((group >= 0) & (group <= 1)).all() and not is_unit)
    if is_unit and NORMAL[0] not in names:
        return NORMAL
    if is_color and COLOR[0] not in names:
        return COLOR
    return tuple(f"column_{len(names) + k + 1}" for k in range(3))
