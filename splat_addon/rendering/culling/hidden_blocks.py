# SPDX-License-Identifier: GPL-3.0-or-later
"""The blocks of one large object while a pass draws it, from which those are left out that are behind what is drawn."""

from __future__ import annotations

import numpy as np

from ...hierarchy import are_facing
from ...hierarchy.cuts import Boxes
from ..methods import get_method
from ..view import DrawItem
from .cover import Cover

#: A filter may show a block's splats up to this many pixels beside the block's box.
_BESIDE = 3

#: No splat in a box is larger than this many times half the longest edge of the box: half an edge of a box around an
#: ellipse has at least 1 / sqrt(3) of its radius.
_RADII = 2


class BlocksFrontToBack:
    """Blocks that face the viewer are drawn first, the nearest of them before others: those that face away lie behind
    them, unless a surface is open.

    are_waiting: (n,) bool, those of the view's blocks that were neither drawn nor found to be hidden.
    """

    def __init__(self, tile, placed: DrawItem):
        self.placed, self._tile = placed, tile
        self._rows, levels = tile.shown_blocks_of(placed), tile.levels(placed.instance)
        self._counts = (levels.blocks.last - levels.blocks.first)[self._rows]
        self._are_facing = are_facing(levels.blocks, self._rows, tile.sight(placed))
        matrix, boxes = placed.instance.model_view(tile.camera), Boxes.of(levels.blocks, self._rows)
        self._middle, self._half = matrix[:3, :3] @ boxes.middle + matrix[:3, 3:], np.abs(matrix[:3, :3]) @ boxes.half
        self._are_hidden = np.zeros(len(self._rows), bool)
        self.are_waiting = np.ones(len(self._rows), bool)

    def show_next(self, count: int) -> None:
        """Draw the nearest of the blocks that wait, about `count` splats; those that face the viewer before others."""
        are_next = self.are_waiting & self._are_facing
        if not are_next.any():
            are_next = self.are_waiting.copy()
        if self._counts[are_next].sum() > count:
            next_ones = np.flatnonzero(are_next)
            next_ones = next_ones[np.argsort(-self._middle[2, next_ones])]
            last = int(np.searchsorted(np.cumsum(self._counts[next_ones]), count)) + 1
            are_next[next_ones[last:]] = False
        self.are_waiting &= ~are_next
        self._show(are_next)

    def hide_behind(self, cover: Cover) -> None:
        """Leave out what is behind what was drawn."""
        left = np.flatnonzero(~self._are_hidden)
        middle, half = self._middle[:, left], self._half[:, left]
        nearer = get_method(self._tile.plan.method).seems_nearer * _RADII * half.max(axis=0)
        self._are_hidden[left] = cover.hides(middle, half, nearer, _BESIDE)
        self.are_waiting &= ~self._are_hidden

    def show_all(self) -> None:
        """Draw everything that was not found to be hidden."""
        self._show(~self._are_hidden)

    def _show(self, are_shown: np.ndarray) -> None:
        self._tile.shown_blocks[self.placed.instance] = self._rows[are_shown]
