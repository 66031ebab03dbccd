# SPDX-License-Identifier: GPL-3.0-or-later
"""Sets of surfels made of others."""

from __future__ import annotations

import numpy as np

from .layout import LAYOUT, OPTIONAL_LAYOUT
from .surfels import Surfels, field_values


def concatenate(parts: list[Surfels]) -> Surfels:
    """One set from several that share an origin.

    The result has an optional field if any part has it; other parts are filled with its default from OPTIONAL_LAYOUT.
    """
    if any((p.origin != parts[0].origin).any() for p in parts):
        raise ValueError("Only surfels with the same origin can be joined; move them to one origin first.")
    there = [n for n in OPTIONAL_LAYOUT if any(getattr(p, n) is not None for p in parts)]
    joined = {n: np.concatenate([field_values(p, n) for p in parts]) for n in (*LAYOUT, *there)}
    return Surfels(origin=parts[0].origin, is_solid=all(p.is_solid for p in parts), **joined)


def portions(surfels: Surfels, size: int, run: range | None = None) -> tuple[Surfels, ...]:
    """Consecutive runs of at most `size` surfels that share the arrays; the set itself if it is small enough. run: of
    these surfels only, without steps; nothing if it is empty."""
    if run is None:
        run = range(len(surfels))
        if len(surfels) <= size:
            return (surfels,)
    runs = (slice(start, min(start + size, run.stop)) for start in range(run.start, run.stop, size))
    return tuple(
        Surfels(
            origin=surfels.origin,
            is_solid=surfels.is_solid,
            **{name: array[run] for name, array in surfels.arrays().items()},
        )
        for run in runs
    )


def prepared(parts: tuple[Surfels, ...]) -> tuple[Surfels, ...]:
    """The same sets, with what every picture asks for found already; a thread may do that."""
    for part in parts:
        _ = (
            part.is_transparent,
            part.local_bounds,
            part.local_hull,
            part.largest,
            part.largest_grain,
            part.clipped_count,
            part.brightest,
        )
    return parts


def empty_surfels(origin=(0.0, 0.0, 0.0)) -> Surfels:
    """A set of no surfels."""
    return Surfels(origin=origin, **{n: np.zeros((0, c) if c > 1 else 0, t) for n, (c, t) in LAYOUT.items()})
