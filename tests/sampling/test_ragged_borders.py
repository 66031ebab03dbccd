# SPDX-License-Identifier: GPL-3.0-or-later
"""For a border of many edges, the search finds the same two lines as a comparison of all pairs of edges."""

import numpy as np
import pytest

from splat_addon.clip_lines import kept
from splat_addon.sampling.edges import ragged_borders
from splat_addon.sampling.edges.meetings import line_along, nearest_on_segment
from splat_addon.sampling.edges.ragged_borders import ALL, BOTH, EITHER, FIRST, two_lines

PLACES, WEIGHTS = ragged_borders.places()
PLACES = PLACES.T.astype(float)


def ragged(random, count):
    """(2, count + 1) corners of a border across the circle, with the surface at the left."""
    x = np.concatenate([[-1.5], np.sort(random.uniform(-1.1, 1.1, count - 1)), [1.5]])
    border = np.stack([x, random.normal(0, 0.35, count + 1)])
    turn = random.uniform(0, 2 * np.pi)
    return np.array([(np.cos(turn), -np.sin(turn)), (np.sin(turn), np.cos(turn))]) @ border


def is_inside(border):
    """(p,) bool: which places are to the left of the border, found by counting the crossings of a ray."""
    (x, y), turned = border[:, :-1], border[:, 1:] - border[:, :-1]
    axis = border[:, -1] - border[:, 0]
    along = axis / np.hypot(*axis)
    across = np.array((-along[1], along[0]))
    share = ((PLACES @ along)[:, None] - along @ np.stack([x, y])) / (along @ turned)
    height = (PLACES @ across)[:, None] - across @ np.stack([x, y]) - share * (across @ turned)
    on = (share >= 0) & (share < 1)
    assert on.any(axis=1).all()
    return np.where(on, height, 0).sum(axis=1) > 0


def shown(lines, kind):
    first, second = (PLACES @ line[:2] + line[2] >= 0 for line in lines)
    return {FIRST: first, BOTH: first & second, EITHER: first | second, ALL: np.full(len(first), True)}[kind]


def wrong(lines, kind, belongs):
    return WEIGHTS[shown(lines, kind) != belongs].sum() / WEIGHTS.sum()


@pytest.mark.parametrize("counts", [(2,), (6,), (2, 3, 4, 5, 6) * 30], ids=["two", "six", "mixed"])
def test_the_best_of_all_pairs_is_found(counts):
    random = np.random.default_rng(4)
    borders = [ragged(random, count) for count in counts]
    ordered = []
    for border in borders:
        start, end = border[:, :-1].astype(np.float32), border[:, 1:].astype(np.float32)
        nearest = np.argsort(nearest_on_segment(start, end)[1])
        ordered.append((start[:, nearest], end[:, nearest]))
    start, end = (np.concatenate(ends, axis=1) for ends in zip(*ordered, strict=True))
    lines, owner = line_along(start, end), np.repeat(np.arange(len(counts)), counts)
    best, kind, beyond = two_lines(start, end, lines, owner)
    assert np.array_equal(owner[best], np.arange(len(counts)))
    excess, misjudged = [], 0
    for number, border in enumerate(borders):
        mine, belongs = np.flatnonzero(owner == number), is_inside(border)
        pairs = [(k, what) for k in mine for what in (FIRST, BOTH, EITHER, ALL)]
        least = min(wrong((lines[:, mine[0]], lines[:, k]), what, belongs) for k, what in pairs)
        chosen = lines[:, mine[0]], lines[:, best[number]]
        excess.append(wrong(chosen, kind[number], belongs) - least)
        misjudged += beyond[number] != (shown(chosen, kind[number]) & ~belongs).any()
    # Rounding decides of which of two edges a place beside the corner that they share is.
    assert misjudged <= 0.02 * len(borders)
    assert np.mean(np.array(excess) > 2e-4) < 0.02 and max(excess) <= WEIGHTS.max() / WEIGHTS.sum()


def test_the_splat_of_a_corner_ends_at_its_two_edges():
    corner = np.array([(-1.0, 0.3), (0.1, -0.2), (0.9, 0.7)], np.float32).T
    lines = line_along(corner[:, :-1], corner[:, 1:])
    best, kind, beyond = two_lines(corner[:, :-1], corner[:, 1:], lines, np.zeros(2, int))
    assert best.tolist() == [1] and kind.tolist() == [BOTH] and not beyond.any()
    turned = -lines[:, ::-1]
    best, kind, beyond = two_lines(corner[:, :0:-1], corner[:, -2::-1], turned, np.zeros(2, int))
    assert best.tolist() == [1] and kind.tolist() == [EITHER] and not beyond.any()
    outside = kept(PLACES, np.repeat(turned.T[None], len(PLACES), axis=0), np.full(len(PLACES), True))
    assert np.array_equal(outside, ~((PLACES @ lines[:2] + lines[2]) > 0).all(axis=1))
