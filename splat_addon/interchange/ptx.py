# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads PTX (Leica): one or several scans on grids, each with the scanner's place and a matrix into common coordinates.

A scan has ten lines before its points: columns and rows of the grid, the scanner's place and three axes, and the
matrix, which points are multiplied with from the left. A cell of the grid without a point is written as 0 0 0.
"""

from __future__ import annotations

import os
from collections.abc import Iterator

import numpy as np

from .clouds import COLOR, Cloud, Table, as_table, placed, without
from .text_rows import Lines, is_text, lines_of, numbers_in, with_whole_colors

#: Numbers on each line before the points.
_HEAD = (1, 1, 3, 3, 3, 3, 4, 4, 4, 4)
#: Columns of a point -> their names after x y z.
_COLUMNS = {3: (), 4: ("intensity",), 6: COLOR, 7: ("intensity", *COLOR)}


def is_this(head: bytes) -> bool:
    lines = lines_of(head)[: len(_HEAD)] if is_text(head) else ()
    return len(lines) == len(_HEAD) and all(len(numbers_in(line)) == n for line, n in zip(lines, _HEAD, strict=True))


def opened(path: str | os.PathLike) -> Cloud:
    """The points of all scans. Raises OSError."""
    cloud = Cloud(iter(()))
    cloud.portions = _portions(path, cloud)
    return cloud


def _portions(path: str | os.PathLike, cloud: Cloud) -> Iterator[tuple[float, Table]]:
    empty = 0
    with open(path, "rb") as stream:
        lines = Lines(stream, os.path.getsize(path))
        while (head := _head(lines)) is not None:
            count, matrix = head
            scan = len(cloud.places)
            cloud.places[scan] = matrix[:3, 3]
            for table, nothing in _scan(lines, count, matrix, scan):
                empty += int(nothing.sum())
                yield lines.share, without(table, nothing)
    if empty:
        cloud.said.append(f"Passed over {empty:,} cells of the scanner's grid that have no point")


def _head(lines: Lines) -> tuple[int, np.ndarray] | None:
    """The number of cells and the (4, 4) matrix of the next scan; None at the end of the file."""
    first, head = lines.number + 1, lines.take(len(_HEAD))
    if not "".join(head).strip():
        return None
    rows = [numbers_in(line) for line in head]
    if [len(row) for row in rows] != list(_HEAD) or not np.isfinite(np.concatenate(rows)).all():
        raise ValueError(
            f"The scan that begins at line {first:,} of the PTX file lacks its ten lines of sizes, place and matrix; "
            "the file is cut off or damaged; copy it again."
        )
    columns, grid_rows = rows[0][0], rows[1][0]
    if min(columns, grid_rows) < 0 or columns * grid_rows > 2**62 or columns % 1 or grid_rows % 1:
        raise ValueError(
            f"Line {first:,} of the PTX file has no size of a grid, {columns:g} by {grid_rows:g}; correct it."
        )
    # rows of the file are what points, as rows, are multiplied with
    return int(columns * grid_rows), np.array(rows[6:]).T


def _scan(lines: Lines, count: int, matrix: np.ndarray, scan: int) -> Iterator[tuple[Table, np.ndarray]]:
    """The columns of the points of a scan, and (n,) bool: which of them are empty cells."""
    found, width = 0, 0
    start, first = lines.number + 1, lines.take(min(count, 1))
    width = len(numbers_in(first[0])) if first else 3
    if width not in _COLUMNS:
        raise ValueError(f"Line {start:,} of the PTX file has {width} numbers for a point; 3, 4, 6 or 7 can be read.")
    for rows in _with_first(first, lines, count, width):
        found += len(rows)
        with np.errstate(over="ignore", invalid="ignore"):
            table = as_table(placed(rows[:, :3], matrix))
        table |= with_whole_colors({name: rows[:, 3 + k].copy() for k, name in enumerate(_COLUMNS[width])})
        table["scan"] = np.full(len(rows), scan, np.int32)
        yield table, ~rows[:, :3].any(axis=1)
    if found < count:
        raise ValueError(
            f"Scan {scan + 1} of the PTX file says that it has {count:,} points, but only {found:,} follow; it is cut "
            "off or damaged."
        )


def _with_first(first: list[str], lines: Lines, count: int, width: int) -> Iterator[np.ndarray]:
    if first:
        yield np.array([numbers_in(first[0])])
        yield from lines.rows(count - 1, width)
