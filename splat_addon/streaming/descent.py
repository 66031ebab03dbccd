# SPDX-License-Identifier: GPL-3.0-or-later
"""The cut of a view through blocks of which only some are in memory.

As in `hierarchy.cuts`, but a block makes room for its children only once all that the view needs of them are there.
Roots always are, so no place is ever left bare.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ..hierarchy import Sight
from ..hierarchy.blocks import Blocks
from ..hierarchy.cuts import Boxes, may_be_seen, pixels_of_errors
from ..runs import ranges
from .pages import Pages, Readable
from .table import Table


class Descent(NamedTuple):
    """drawn: numbers of the blocks to draw. wanted: pages that would make it finer, those of the largest errors
    first. is_torn: whether some are coarser than the view asks for because those below them cannot be read.
    """

    drawn: np.ndarray
    wanted: np.ndarray
    is_torn: bool


def descend(
    table: Table, pages: Pages | Readable, sight: Sight, beside: float | None, most: int | None = None
) -> Descent:
    """The cut as far as pages are there, which are noted as used.

    beside: blocks outside the picture may be off by this many times the tolerance; None leaves them out. most: rows
        that it may have, if the roots have no more; the blocks of the largest errors of each level become finer.
    Whatever the table says, it ends, and takes memory in proportion to the file: see `_Bounds`.
    """
    front, drawn, wanted, urgency, is_torn = np.arange(int(table.blocks.roots)), [], [], [], False
    blocks, bounds = table.blocks, _Bounds(table)
    are_counted, pixels = _errors(blocks, front, sight, beside)
    front = front[are_counted]
    room = np.inf if most is None else most - _rows(blocks, front).sum()
    while len(front):
        pages.use(blocks.first[front], blocks.last[front])
        starts, ends = blocks.first_child[front], blocks.last_child[front]
        is_fine = (pixels <= sight.tolerance) | (starts == ends)
        are_lost = ~bounds.load(starts[~is_fine], ends[~is_fine])
        if are_lost.any():
            is_torn, is_fine[~is_fine] = True, are_lost
        drawn.append(front[is_fine])
        coarse, pixels = front[~is_fine], pixels[~is_fine]
        counts = ends[~is_fine] - starts[~is_fine]
        children, owners = ranges(starts[~is_fine], counts), np.repeat(np.arange(len(coarse)), counts)
        are_counted, own_pixels = _errors(blocks, children, sight, beside)
        kept, owners = children[are_counted], owners[are_counted]
        first, last = blocks.first[kept], blocks.last[kept]
        is_here = pages.have(first, last)
        lacks = np.zeros(len(coarse), bool)
        lacks[owners[~is_here]] = True
        more = np.bincount(owners, _rows(blocks, kept), len(coarse)) - _rows(blocks, coarse)
        fits = _fits(more, pixels, room)
        goes = fits & ~lacks
        room -= more[goes].sum()
        drawn.append(coarse[~goes])
        is_wanted = ~is_here & fits[owners]
        is_torn |= bool(pages.are_lost(first[is_wanted], last[is_wanted]).any())
        wanted.append(kept[is_wanted])
        urgency.append(pixels[owners[is_wanted]])
        goes_on = goes[owners]
        front, pixels = kept[goes_on], own_pixels[goes_on]
    if not drawn:
        return Descent(front, front, False)
    rows = np.concatenate(wanted)[np.argsort(-np.concatenate(urgency), kind="stable")]
    return Descent(np.concatenate(drawn), pages.missing(blocks.first[rows], blocks.last[rows]), is_torn)


class _Bounds:
    """Loads the children of a descent's levels, as long as these are no more blocks, with no more rows, than the file
    has: in a tree, each block has one parent, and each row is in one block."""

    def __init__(self, table: Table):
        self._table, roots = table, slice(int(table.blocks.roots))
        self._blocks = len(table.blocks)
        self._rows = table.rows - int((table.blocks.last[roots] - table.blocks.first[roots]).sum())

    def load(self, first: np.ndarray, last: np.ndarray) -> np.ndarray:
        """As `Table.load`; none, if these runs would be too much."""
        self._blocks -= int((last - first).sum())
        nothing = np.zeros(len(first), bool)
        if self._blocks < 0:
            return nothing
        are_here = self._table.load(first, last)
        children = ranges(first[are_here], (last - first)[are_here])
        self._rows -= int(_rows(self._table.blocks, children).sum())
        return are_here if self._rows >= 0 else nothing


def _rows(blocks: Blocks, numbers: np.ndarray) -> np.ndarray:
    """(n,) the number of rows of each block."""
    return blocks.last[numbers] - blocks.first[numbers]


def _fits(more: np.ndarray, pixels: np.ndarray, room: float) -> np.ndarray:
    """(n,) bool: which blocks may become finer, those of the largest errors first. more: rows that this adds."""
    fits = np.ones(len(more), bool)
    if np.isfinite(room):
        order = np.argsort(-pixels, kind="stable")
        fits[order] = np.cumsum(more[order]) <= room
    return fits


def _errors(blocks: Blocks, rows: np.ndarray, sight: Sight, beside: float | None) -> tuple[np.ndarray, np.ndarray]:
    """(n,) bool: which blocks count; and the errors of these in pixels."""
    boxes = Boxes.of(blocks, rows)
    is_seen = may_be_seen(blocks, rows, boxes, sight)
    if beside is None:
        return is_seen, pixels_of_errors(blocks, rows[is_seen], boxes.some(is_seen), sight)
    pixels = pixels_of_errors(blocks, rows, boxes, sight)
    outside = np.flatnonzero(~is_seen)
    pixels[outside] = _pixels_all_round(blocks, rows[outside], sight) / beside
    return np.ones(len(rows), bool), pixels


def _pixels_all_round(blocks: Blocks, rows: np.ndarray, sight: Sight) -> np.ndarray:
    """(n,) largest error of each block in pixels, whatever direction the eye looks in."""
    error = blocks.errors[rows].max(axis=1, initial=0.0).astype(np.float64) * sight.pixels
    if sight.is_parallel:
        return error
    apart = np.maximum(np.maximum(blocks.low[rows] - sight.eye[:3], sight.eye[:3] - blocks.high[rows]), 0)
    distance = np.linalg.norm(apart, axis=1) * np.linalg.norm(sight.depth[:3])
    return error / np.maximum(distance, sight.near)
