# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes surfels smaller at ragged open borders, which two lines cannot follow: smaller splats meet fewer edges.

Nothing lies beyond an open border that could hide what sticks out, as it does on the rims of range maps. Samples are
closer than splats are large, so smaller ones still cover the surface between them, and `gaps` what they leave bare.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from .borders import Borders
from .meetings import Meetings

#: A splat at such a border is this share of its size: in units of 1.25 spacings, cells' corners are at 0.57.
SMALLER = np.float32(0.7)

#: Beside its nearest edge, a border that two lines cannot follow has at least so many others.
_RAGGED = 3


def smaller_at_openings(
    met: Meetings, starts: np.ndarray, owner: np.ndarray, is_off: np.ndarray, borders: Borders, scales: np.ndarray
) -> Meetings:
    """The meetings of surfels after those at ragged open borders have become smaller, in place in (N, 2) `scales`.

    met: ordered by surfel. starts: (n,) the first meeting of each surfel. owner: (m,) each one's surfel among these.
    is_off: (m,) whether the edge leaves the line along the surfel's nearest one.
    """
    is_open = (np.bincount(borders.edges) == 1).take(borders.edges.take(met.side))
    ragged = np.bincount(owner, is_off, len(starts)) >= _RAGGED
    ragged &= np.bincount(owner, is_open, len(starts)) > 0
    if not ragged.any():
        return met
    first = starts.compress(ragged)
    scales[met.surfel.take(first)] *= SMALLER
    met.seen.inverse[:, met.number.take(first)] *= 1 / SMALLER
    factor = np.where(ragged.take(owner), 1 / SMALLER, np.float32(1))
    line = met.line.copy()
    line[2] *= factor
    values = {name: getattr(met, name) * factor for name in ("start", "end", "distance")}
    return replace(met, line=line, **values).take(np.flatnonzero(values["distance"] < 1))
