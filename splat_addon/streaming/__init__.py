# SPDX-License-Identifier: GPL-3.0-or-later
"""More surfels than memory holds: a file of blocks, from which a view reads the surfels that it needs.

A file (`layout`) holds the rows of all surfels and merged surfels in the order of their blocks, and the table of blocks
of a hierarchy. `writing` makes it out of core, from portions of neighbours (`buckets`), each with a hierarchy of its
own. Points that are no surfels yet are sorted likewise (`point_files`), and converted on the way (`point_writing`).
`directory` and `block_file` open it, `table` and `pages` keep the blocks and rows that were read last within a
budget of memory, and `stream` answers a view with ordinary `Surfels`; blocks that have not been read yet, or cannot be
read, are replaced by their parents. `checking` reads a whole file and compares it with its checksums.
"""

from .block_file import BlockFile
from .checking import check, described
from .layout import SCAN_COLUMNS, as_bytes, measured
from .own_files import id_of, own_file
from .point_writing import write_points
from .stream import Stream, Unreadable
from .writing import PORTION, WritingCancelled, write_blocks

__all__ = [
    "PORTION",
    "SCAN_COLUMNS",
    "BlockFile",
    "Stream",
    "Unreadable",
    "WritingCancelled",
    "as_bytes",
    "check",
    "described",
    "id_of",
    "measured",
    "own_file",
    "write_blocks",
    "write_points",
]
