# SPDX-License-Identifier: GPL-3.0-or-later
"""The cut of a view through blocks of which only some are in memory.

As in `hierarchy.cuts`, but a block makes room for its children only once all that the view needs of them are there.
Roots always are, so no place is ever left bare.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ..hierarchy import Sight
from ..hierarchy.blocks import Blocks, ranges
from ..hierarchy.cuts import may_be_seen, pixels_of_errors
from .pages import Pages


class Cut(NamedTuple):
    """drawn: numbers of the blocks to draw. wanted: pages that would make it finer, those of the largest errors
    first."""

    drawn: np.ndarray
    wanted: np.ndarray


def descend(blocks: Blocks, pages: Pages, sight: Sight, beside: float | None) -> Cut:
    """The cut as far as pages are there, which are noted as used.

    beside: blocks outside the picture may be off by this many times the tolerance; None leaves them out.
    """
    front, drawn, wanted, urgency = np.arange(int(blocks.roots)), [], [], []
    front, pixels = _errors(blocks, front, sight, beside)
    while len(front):
        pages.use(blocks.first[front], blocks.last[front])
        starts, ends = blocks.first_child[front], blocks.last_child[front]
        is_fine = (pixels <= sight.tolerance) | (starts == ends)
        drawn.append(front[is_fine])
        coarse, pixels = front[~is_fine], pixels[~is_fine]
        counts = ends[~is_fine] - starts[~is_fine]
        children, owners = ranges(starts[~is_fine], counts), np.repeat(np.arange(len(coarse)), counts)
        kept, own_pixels = _errors(blocks, children, sight, beside)
        if len(kept) < len(children):
            owners = owners[np.isin(children, kept, assume_unique=True)]
        first, last = blocks.first[kept], blocks.last[kept]
        is_here = pages.have(first, last)
        lacks = np.zeros(len(coarse), bool)
        lacks[owners[~is_here]] = True
        drawn.append(coarse[lacks])
        wanted.append(kept[~is_here])
        urgency.append(pixels[owners[~is_here]])
        goes_on = ~lacks[owners]
        front, pixels = kept[goes_on], own_pixels[goes_on]
    if not drawn:
        return Cut(front, front)
    rows = np.concatenate(wanted)[np.argsort(-np.concatenate(urgency), kind="stable")]
    return Cut(np.concatenate(drawn), pages.missing(blocks.first[rows], blocks.last[rows]))


def _errors(blocks: Blocks, rows: np.ndarray, sight: Sight, beside: float | None) -> tuple[np.ndarray, np.ndarray]:
    """The blocks that count, and the error of each in pixels."""
    is_seen = may_be_seen(blocks, rows, sight)
    if beside is None:
        rows = rows[is_seen]
        return rows, pixels_of_errors(blocks, rows, sight)
    pixels = pixels_of_errors(blocks, rows, sight)
    outside = np.flatnonzero(~is_seen)
    pixels[outside] = _pixels_all_round(blocks, rows[outside], sight) / beside
    return rows, pixels


def _pixels_all_round(blocks: Blocks, rows: np.ndarray, sight: Sight) -> np.ndarray:
    """(n,) largest error of each block in pixels, whatever direction the eye looks in."""
    error = blocks.errors[rows].max(axis=1, initial=0.0) * sight.pixels
    if sight.is_parallel:
        return error
    apart = np.maximum(np.maximum(blocks.low[rows] - sight.eye[:3], sight.eye[:3] - blocks.high[rows]), 0)
    distance = np.linalg.norm(apart, axis=1) * np.linalg.norm(sight.depth[:3])
    return error / np.maximum(distance, sight.near)
