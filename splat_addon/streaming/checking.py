# SPDX-License-Identifier: GPL-3.0-or-later
"""What a file of blocks holds, and whether all of it is as it was written."""

from __future__ import annotations

import os

import numpy as np

from ..runs import ranges
from .block_file import BlockFile
from .layout import PAGE
from .pages import AT_ONCE
from .table import Table


def described(path: str | os.PathLike) -> dict:
    """What a file holds, in plain values. Raises OSError or ValueError as `BlockFile`."""
    file = BlockFile(path)
    try:
        blocks = Table(file, 0).blocks
        corners = blocks.low[: file.roots].min(axis=0), blocks.high[: file.roots].max(axis=0)
        low, high = ((file.origin + corner).tolist() for corner in corners)
        return {
            "file": str(file.path),
            "bytes": file.path.stat().st_size,
            "surfels": file.count,
            "rows": file.rows,
            "blocks": file.size,
            "fields": list(file.kind.names),
            "solid": file.is_solid,
            "low": low,
            "high": high,
        }
    finally:
        file.close()


def check(path: str | os.PathLike) -> int:
    """Read a whole file and hold it against its checksums; returns its number of surfels.

    Raises OSError if it cannot be read, ValueError with a sentence if anything in it is not as it was written: sizes,
    checksums, the range of every number, or the tree, in which every block but the roots has one parent and the blocks
    without children hold all surfels.
    """
    file = BlockFile(path)
    try:
        pages = np.arange(-(-file.rows // PAGE))
        for start in range(0, len(pages), AT_ONCE):
            if not file.read_rows(pages[start : start + AT_ONCE])[1].all():
                raise ValueError(file.fault())
        if not _is_tree(file):
            raise ValueError(file.fault())
        return file.count
    finally:
        file.close()


def _is_tree(file: BlockFile) -> bool:
    """Whether all blocks can be read, every one but the roots has one parent, and their rows are those of the file."""
    has_parent, children, surfels = np.zeros(file.size, bool), 0, 0
    for page in range(-(-file.size // PAGE)):
        columns = file.read_blocks(page)
        if columns is None:
            return False
        counts = columns["last_child"] - columns["first_child"]
        has_parent[ranges(columns["first_child"], counts)] = True
        children += int(counts.sum())
        surfels += int((columns["last"] - columns["first"])[counts == 0].sum())
    return children == file.size - file.roots and bool(has_parent[file.roots :].all()) and surfels == file.count
