# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes surfels smaller that stick out beyond a border which two lines cannot follow: smaller splats meet fewer edges.

Samples are closer than splats are large, so smaller ones still cover the surface between them, and `gaps` what they
leave bare.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from .meetings import Meetings

#: The size of such a splat, as a share of what it was, and how often it becomes smaller. In units of 1.25 spacings,
#: cells' corners are at 0.57.
SMALLER, TIMES = np.float32(0.8), 2


def made_smaller(met: Meetings, scales: np.ndarray) -> Meetings:
    """What surfels meet after they have become smaller, in place in (N, 2) `scales`."""
    surfels, first = np.unique(met.surfel, return_index=True)
    scales[surfels] *= SMALLER
    met.seen.inverse[:, met.number.take(first)] *= 1 / SMALLER
    grown = {name: getattr(met, name) * (1 / SMALLER) for name in ("start", "end", "distance")}
    line = met.line.copy()
    line[2] *= 1 / SMALLER
    return replace(met, line=line, **grown).take(np.flatnonzero(grown["distance"] < 1))
