# SPDX-License-Identifier: GPL-3.0-or-later
"""Pieces: surfels that touch one another and nothing else, such as a leaf or a blade of grass.

The grid of a level cuts a piece wherever its cells end, and mixes it with others. Instead, a piece stays apart until it
fits into a cell, and becomes one surfel then: a leaf takes one, and not four.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from .families import dot
from .nodes import Leaves, Nodes, Table
from .surroundings import Near, voxels

#: Surfels touch if their centres are this part of their radii apart: neighbours of a grid are at 0.56 at most, and at
#: 1.1 there is a cell between them. And how far one may lie off the other's plane, in these radii.
_TOUCHING, _OFF = 0.65, 0.12
#: Minimum cosine between normals of surfels that touch, and between those of a piece and their mean.
_SMOOTH, _CONE = 0.8, 0.5
#: Neighbours are looked for in voxels as large as this share of the surfels needs, so that a few large ones do not make
#: them all larger; what is larger is of no piece.
_MOST_SURFELS = 0.9
#: Rounds in which surfels learn of which piece they are; larger pieces are not told from what has no end.
_ROUNDS = 6
#: Surfels whose neighbours are looked for at a time.
_PORTION = 1 << 13
#: Places at which a set is looked at, and surfels at each. It consists of pieces if at least this share of what is
#: there belongs to pieces whose sizes lie between the last two numbers; noise makes smaller ones.
_PLACES, _THERE, _OF_PIECES, _LEAST, _MOST = 3, 1 << 12, 0.5, 6, 1 << 9


class Pieces(NamedTuple):
    """Pieces of some rows that fit into a cell. families: rows of those of several, one piece's after the other's, and
    counts: (p,) of each. single: rows that are a piece by themselves. larger: (n,) of each row of the level, the number
    of its piece, if that does not fit; -1 for others."""

    families: np.ndarray
    counts: np.ndarray
    single: np.ndarray
    larger: np.ndarray


def consists_of_pieces(leaves: Leaves) -> bool:
    """Whether it pays to look for pieces: most of what is at a few places of a set is of small ones."""
    places = leaves.column("positions")
    for number in range(_PLACES):
        near = np.arange(len(leaves))
        if len(leaves) > _THERE:
            middle = places[:, (2 * number + 1) * len(leaves) // (2 * _PLACES)]
            away = np.maximum.reduce([np.abs(along - at) for along, at in zip(places, middle, strict=True)])
            near = np.argpartition(away, _THERE)[:_THERE]
        found = _found(leaves, near)
        sizes = np.bincount(found[found >= 0])
        if sizes[(sizes >= _LEAST) & (sizes <= _MOST)].sum() >= _OF_PIECES * len(near):
            return True
    return False


def pieces(table: Table | Leaves, rows: np.ndarray, cell: float, numbers: np.ndarray) -> Pieces:
    """The pieces among some rows of a level. numbers: (n,) the pieces that rows of the level are known to be of, -1 for
    others."""
    numbers = numbers.copy()
    others = rows[numbers[rows] < 0]
    if len(others):
        first, found = numbers.max(initial=-1) + 1, _found(table, others)
        numbers[others] = np.where(found < 0, -1, first + found)
    rows = rows[numbers[rows] >= 0]
    rows = rows[np.argsort(numbers[rows], kind="stable")]
    begins = np.flatnonzero(np.diff(numbers[rows], prepend=-1))
    if not len(begins):
        return Pieces(rows, begins, rows, numbers)
    counts, places = np.diff(np.append(begins, len(rows))), table.column("positions")[:, rows]
    extent = np.maximum.reduceat(places, begins, axis=1) - np.minimum.reduceat(places, begins, axis=1)
    fits = extent.max(axis=0) <= cell
    numbers[rows[np.repeat(fits, counts)]] = -1
    several = fits & (counts > 1)
    return Pieces(rows[np.repeat(several, counts)], counts[several], rows[begins[counts == 1]], numbers)


def apart(larger: np.ndarray, counts: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """An order that separates clusters by piece, and the sizes of their parts. larger: (n,) of `Pieces.larger` in the
    order of the clusters. counts: their sizes."""
    cluster = np.repeat(np.arange(len(counts)), counts)
    order = np.lexsort([larger, cluster])
    is_first = np.ones(len(order), bool)
    is_first[1:] = (np.diff(larger[order]) != 0) | (np.diff(cluster) != 0)
    return order, np.diff(np.append(np.flatnonzero(is_first), len(order)))


def _found(table: Table | Leaves, rows: np.ndarray) -> np.ndarray:
    """(m,) numbers of the pieces of some rows; -1 for those of none, or of one that is too large to tell."""
    if not len(rows):
        return rows
    places, radii = table.column("positions")[:, rows], table.column("radii")[rows]
    reach = float(np.quantile(radii, _MOST_SURFELS))
    order = voxels(places, 2 * _TOUCHING * reach)[1]
    some = table.take(rows[order])
    first, second = _touching(some, voxels(some["positions"], 2 * _TOUCHING * reach)[0])
    own, labels = np.flatnonzero(np.diff(first, prepend=-1)), np.arange(len(rows))
    for _ in range(_ROUNDS):
        before, labels = labels, labels.copy()
        labels[first[own]] = np.minimum.reduceat(before[second], own)
        labels = labels[labels]
        if np.array_equal(labels, before):
            break
    are_open, differ = some["radii"] > 1.05 * reach, labels[first] != labels[second]
    are_open[first[differ]] = are_open[second[differ]] = True
    by_piece = np.argsort(labels, kind="stable")
    begins = np.flatnonzero(np.diff(labels[by_piece], prepend=-1))
    counts, normals = np.diff(np.append(begins, len(rows))), some["normals"][:, by_piece]
    mean = np.add.reduceat(normals, begins, axis=1)
    mean /= np.maximum(np.sqrt(dot(mean, mean)), np.float32(1e-12))
    is_known = np.minimum.reduceat(dot(normals, np.repeat(mean, counts, axis=1)), begins) >= _CONE
    is_known &= ~np.logical_or.reduceat(are_open[by_piece], begins)
    found = np.empty(len(rows), np.int64)
    found[order[by_piece]] = np.repeat(np.where(is_known, np.arange(len(counts)), -1), counts)
    return found


def _touching(some: Nodes, keys: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(k,) pairs of surfels that touch, in the order of the first. keys: (n,) their voxels, ascending."""
    near, firsts, seconds = Near(keys), [], []
    places, normals, radii = some["positions"], some["normals"], some["radii"]
    for start in range(0, len(keys), _PORTION):
        second, counts = near.rows(slice(start, start + _PORTION))
        first = np.repeat(np.arange(start, start + len(counts)), counts)
        away, reach = places[:, second] - places[:, first], radii[first] + radii[second]
        touch = dot(away, away) <= (np.float32(_TOUCHING) * reach) ** 2
        first, second, away, reach = first[touch], second[touch], away[:, touch], reach[touch]
        touch = dot(normals[:, first], normals[:, second]) > _SMOOTH
        touch &= np.abs(dot(away, normals[:, first])) <= np.float32(_OFF) * reach
        touch &= some["materials"][first] == some["materials"][second]
        firsts.append(first[touch])
        seconds.append(second[touch])
    return np.concatenate(firsts), np.concatenate(seconds)
