# SPDX-License-Identifier: GPL-3.0-or-later
"""Where the scanner went: the places that a file names, or, of a flight, estimated from pulses with several returns.

All returns of a pulse lie on one ray, which comes from the scanner. Rays of pulses that were sent shortly after one
another meet where it was, so a flight is found as Gatziolis and McGaughey (2019, "Reconstructing aircraft trajectories
from multi-return airborne laser-scanning data") do; here each piece of it is a straight line that least squares fit,
with less weight for rays that pass far from it.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise

import numpy as np

from .points import Points

#: Seconds without pulses that end a flight line; pulses and seconds that a piece has at least, and pieces in all.
_PAUSE, _FEWEST, _SHORTEST, _MOST = 5.0, 40, 0.5, 400

#: Shares of the pulses that are the shortest: their directions are the least precise.
_TOO_SHORT = 0.5

#: Times that the weights of rays are worked out again.
_ROUNDS = 10

#: Seconds over which a flight is straight.
_SMOOTH = 1.5

#: Largest standard error of a place, as a share of how far away what it saw is.
_VAGUE = 0.1


def scanner_path(points: Points) -> tuple[np.ndarray, bool] | None:
    """(n, 4) float64 places x y z of the scanner, each with its time in the file's seconds, or with its scan's number
    if the file names it; and whether it is estimated. None if nothing is known."""
    scanners = points.scanners()
    if scanners is not None:
        known = np.unique(scanners[np.isfinite(scanners).all(axis=1)], axis=0)
        named = [(*place, number) for number, place in points.places.items() if (known == place).all(axis=1).any()]
        return np.array(named, np.float64), False
    flight = _flight(points)
    return None if flight is None else (flight, True)


def _flight(points: Points) -> np.ndarray | None:
    """(n, 4) places and times of a scanner that flew; None if the points do not tell them."""
    names = "gps_time", "return_number", "number_of_returns"
    if not points.attributes.keys() >= set(names):
        return None
    times, numbers, counts = (points.attributes[name] for name in names)
    rows = np.flatnonzero((counts > 1) & np.isfinite(times) & np.isfinite(points.positions).all(axis=1))
    rows = rows[np.lexsort((numbers[rows], times[rows]))]
    when = times[rows].astype(np.float64)
    # the first and the last return of each pulse, which has one time
    if not len(rows):
        return None
    begins = np.flatnonzero(np.diff(when, prepend=-np.inf) > 0)
    ends = np.append(begins[1:], len(rows)) - 1
    first, last = points.positions[rows[begins]], points.positions[rows[ends]]
    lengths = np.linalg.norm(first - last, axis=1)
    # two pulses of several scanners may have one time: then there are more returns than the pulse has
    is_pulse = (ends > begins) & (ends - begins < counts[rows[begins]]) & (lengths > 0)
    if is_pulse.sum() < _FEWEST:
        return None
    is_pulse &= lengths >= np.quantile(lengths[is_pulse], _TOO_SHORT)
    first, last, when, lengths = first[is_pulse], last[is_pulse], when[begins[is_pulse]], lengths[is_pulse]
    found = [_place(first[some], last[some], when[some], lengths[some]) for some in _pieces(when)]
    found = [place for place in found if place is not None]
    return _smooth(np.array(found)) if found else None


def _smooth(places: np.ndarray) -> np.ndarray:
    """(n, 4) places and times of (n, 5) places, times and standard errors: each from the straight line through its
    neighbours in time that fits best where errors are small."""
    made = places[:, :4].copy()
    for row, time in enumerate(places[:, 3]):
        since = places[:, 3] - time
        near = np.abs(since) < _PAUSE
        weights = np.exp(-((since[near] / _SMOOTH) ** 2) / 2) / np.maximum(places[near, 4], 1e-9)
        line = np.stack([np.ones(near.sum()), since[near]], axis=1) * weights[:, None]
        fit = np.linalg.lstsq(line, (places[near, :3] - places[row, :3]) * weights[:, None], rcond=1e-6)[0]
        made[row, :3] += fit[0]
    return made


def _pieces(when: np.ndarray) -> Iterator[slice]:
    """Runs of (n,) ascending times that are long enough, as even as possible in each flight line."""
    starts = np.flatnonzero(np.diff(when, prepend=-np.inf) > _PAUSE)
    for start, end in zip(starts, np.append(starts[1:], len(when)), strict=True):
        seconds = when[end - 1] - when[start]
        pieces = int(min((end - start) // _FEWEST, seconds // _SHORTEST, _MOST // len(starts) + 1))
        cuts = when[start] + seconds * np.arange(1, pieces) / max(pieces, 1)
        edges = np.searchsorted(when[start:end], cuts) + start
        for low, high in pairwise([start, *edges, end]):
            if pieces and high - low >= _FEWEST:
                yield slice(low, high)


def _place(first: np.ndarray, last: np.ndarray, when: np.ndarray, lengths: np.ndarray) -> tuple[float, ...] | None:
    """x, y, z, time and standard error in the middle of a straight piece of flight, from rays through (n, 3) points;
    None if they do not meet well enough."""
    middle, time = last.mean(axis=0), (when[0] + when[-1]) / 2
    along = (first - last) / lengths[:, None]
    span = max((when[-1] - when[0]) / 2, 1e-9)
    # (I - u u') (place + (t - time) motion - point) = 0
    across = np.eye(3) - along[:, :, None] * along[:, None]
    rows = np.concatenate([across, across * ((when - time) / span)[:, None, None]], axis=2)
    wanted = np.einsum("nij,nj->ni", across, last - middle)
    weights = lengths.copy()
    for _ in range(_ROUNDS):
        weighted = rows * weights[:, None, None]
        normal = np.einsum("nij,nik->jk", weighted, weighted)
        if not np.linalg.cond(normal) < 1e14:
            return None
        solved = np.linalg.solve(normal, np.einsum("nij,ni->j", weighted, wanted * weights[:, None]))
        off = np.linalg.norm(rows @ solved - wanted, axis=1) * lengths
        usual = max(float(np.median(off)), 1e-12)
        weights = lengths / np.sqrt(1 + (off / (2 * usual)) ** 2)
    missed = weights * np.linalg.norm(rows @ solved - wanted, axis=1)
    variance = (missed**2).sum() / max(2 * len(rows) - 6, 1)
    error = np.sqrt(variance * np.trace(np.linalg.inv(normal)[:3, :3]))
    distance = float(np.linalg.norm(solved[:3]))
    return (*(middle + solved[:3]), time, float(error)) if error < _VAGUE * distance else None
