# SPDX-License-Identifier: GPL-3.0-or-later
"""More surfels than memory holds: a file of blocks, from which a view reads the surfels that it needs.

A file (`layout`) holds the rows of all surfels and merged surfels in the order of their blocks, and the table of blocks
of a hierarchy. `writing` makes it out of core, from portions of neighbours (`buckets`), each with a hierarchy of its
own. `block_file` opens it, `pages` keeps the rows that were read last within a budget of memory, and `stream` answers a
view with ordinary `Surfels`; blocks that have not been read yet are replaced by their parents.
"""

from .block_file import BlockFile, described
from .stream import Stream
from .writing import PORTION, WritingCancelled, write_blocks

__all__ = ["PORTION", "BlockFile", "Stream", "WritingCancelled", "described", "write_blocks"]
