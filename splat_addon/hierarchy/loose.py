# SPDX-License-Identifier: GPL-3.0-or-later
"""What merges from whole pieces, which nothing continues, is drawn as large as what it stands for.

Merged surfels overlap, so that a surface has no holes between them. A leaf that becomes one surfel has no neighbours:
overlapping nothing, it would cover two and a half times its area, and the crowns of trees would grow with distance.
"""

from __future__ import annotations

import numpy as np

from ..large_surfels import SAMPLE_SIZE
from ..surfels import Surfels
from .extremes import extreme
from .nodes import LEAST_SHOWN, MERGED_OVERLAP, Leaves, Table
from .pieces import Pieces, consists_of_pieces, pieces
from .runs import Runs

#: How far the surfels of a piece extend beyond their cells on both sides together, in radii; not those of clip lines.
_BEYOND = 1.13
#: How far the border of a square is from that of an ellipse that covers as much, in half-axes: at its corners, doubled.
_OF_SQUARE = 0.3


class Loose:
    """What is known of the rows of a level while a hierarchy is built: of which pieces they are, whether nothing
    continues them, and what they cover then, square object units."""

    def __init__(self, surfels: Surfels, may_be_apart: bool = True):
        count, leaves = len(surfels), Leaves(surfels)
        may_be_apart = may_be_apart and count > 1 and not surfels.is_solid and extreme(leaves) is None
        self._seeks = may_be_apart and consists_of_pieces(leaves)
        self._numbers, self._are, self._areas = np.full(count, -1), np.zeros(count, bool), np.zeros(count)
        has_borders = self._seeks and not surfels.clipped_count
        self._grain = float(np.median(surfels.radius)) if has_borders else 0.0

    def found(self, current: Table | Leaves, rows: np.ndarray, cell: float) -> Pieces | None:
        """The pieces among rows that may merge; None if it does not pay to look for any."""
        if not self._seeks:
            return None
        made = pieces(current, rows, cell, self._numbers)
        single = made.single[~self._are[made.single]]
        if isinstance(current, Table) and len(single):
            self._are[single], self._areas[single] = True, self._covered(current.of_rows(single))
        self._numbers = made.larger
        return made

    def go_on(self, rows: np.ndarray, runs: Runs, waiting: np.ndarray, whole: int, parents: Table) -> None:
        """Go on to the next level: the parents of runs of rows, of which the first are whole pieces, and what waits."""
        if not self._seeks:
            return
        ellipses, are = _ellipses(parents), np.logical_and.reduceat(self._are[rows], runs.starts)
        # what lies behind one another, or overlaps, covers once
        areas = ellipses * -np.expm1(-np.add.reduceat(self._areas[rows], runs.starts) / ellipses)
        are[:whole], areas[:whole] = True, self._covered(parents.of_rows(np.arange(whole)))
        numbers = self._numbers[rows[runs.starts]]
        self._numbers = np.concatenate([numbers, self._numbers[waiting]])
        self._are, self._areas = (np.concatenate(p) for p in ((are, self._are[waiting]), (areas, self._areas[waiting])))

    def _covered(self, table: Table) -> np.ndarray:
        """(n,) areas of pieces: of the cells of their surfels, or of the ellipses that stand for them where surfels
        overlap by more, and of what extends beyond."""
        edges = np.array(_lengths(table)) / MERGED_OVERLAP
        share = table.column("areas").astype(np.float64) / SAMPLE_SIZE**2 / np.maximum(edges.prod(axis=0), 1e-300)
        return np.prod(edges * np.sqrt(np.minimum(share, 1)) + _BEYOND * self._grain, axis=0)

    def extents(self, parents: Table, whole: int) -> np.ndarray:
        """(whole,) how far the borders of the first rows of a level, whole pieces, are off as they are drawn, object
        units: less than beside others, and more where a piece is not compact."""
        some = parents.of_rows(np.arange(whole))
        filled = some.column("areas") / SAMPLE_SIZE**2 / np.maximum(self._areas[:whole], 1e-300)
        off = some.column("radii") * (_OF_SQUARE + 1 - np.minimum(filled, 1))
        return np.maximum(off, some.column("overhang"))

    def sizes(self, parents: Table) -> np.ndarray:
        """(n,) float32 factors of the axes of the first rows of a level: loose ones cover their area where renderers
        shorten merged surfels, as far as they do at most. Those that end at clip lines stay."""
        made = np.ones(len(parents), np.float32)
        rows = np.flatnonzero(self._are[: len(parents)])
        if "lines" in parents.widths:
            rows = rows[~parents.column("lines")[:, rows].any(axis=0)]
        some = parents.of_rows(rows)
        made[rows] = np.sqrt(np.minimum(self._areas[rows] / (LEAST_SHOWN * _ellipses(some)), 1))
        return made


def bare(parents: Table, sizes: np.ndarray) -> np.ndarray:
    """(n,) a bound on how far what they stand for is beside merged surfels with axes that are so many times as long."""
    return parents.column("uncovered") + (1 - sizes) * parents.column("radii")


def resized(table: Table, sizes: np.ndarray) -> Table:
    """Merged surfels with axes that are so many times as long."""
    if (sizes == 1).all():
        return table
    made = Table(table.widths, table.rows.copy())
    for name in ("first_axis", "second_axis", "changes"):
        if name in table.widths:
            made.put(name, made.column(name) * sizes, np.arange(len(sizes)))
    return made


def _lengths(table: Table) -> list[np.ndarray]:
    return [np.linalg.norm(table.column(name).astype(np.float64), axis=0) for name in ("first_axis", "second_axis")]


def _ellipses(table: Table) -> np.ndarray:
    """(n,) areas of ellipses."""
    return np.pi * np.maximum(np.prod(_lengths(table), axis=0), 1e-300)
