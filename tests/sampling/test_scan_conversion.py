# SPDX-License-Identifier: GPL-3.0-or-later
"""Scan conversion is exact, even for adversarial fractions, and no sample is lost or doubled at an edge."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from splat_addon.runs import expand
from splat_addon.sampling.ldc.scan_conversion import Spans, batches, scan_convert

LARGEST = 2**25


def samples(u, v, subcells):
    """The set of (triangle, column, row) for (3, t) corners."""
    spans = Spans.joined(list(scan_convert(np.array(u, float), np.array(v, float), subcells)))
    owner, step = expand(spans.counts)
    return list(zip(spans.triangles[owner], spans.columns[owner] + step, spans.rows[owner], strict=True))


@pytest.mark.parametrize("remainder", [1, -1])
def test_an_edge_that_misses_a_cell_centre_by_the_least_fraction_is_on_the_right_side(remainder):
    """Edges A-B are built so that the column's numerator is 1 or -1 modulo its denominator, the worst case for
    rounding.
    """
    random, subcells, checked = np.random.default_rng(0), 1024, 0
    while checked < 300:
        du, dv = (
            int(random.integers(-LARGEST // 4, LARGEST // 4)),
            int(random.integers(LARGEST // 2, LARGEST - subcells)),
        )
        if math.gcd(du, dv) != 1:
            continue
        rise = pow(du, -1, dv) * remainder % dv
        if rise < dv // 8:
            continue
        ua = -((rise * du - remainder) // dv) % subcells + LARGEST // 4
        row = -(-rise // subcells)
        va = row * subcells - rise
        numerator, denominator = ua * dv + rise * du, dv * subcells
        assert numerator % denominator == remainder % denominator
        u, v = np.array([[ua], [ua + du], [LARGEST]], float), np.array([[va], [va + dv], [va + dv]], float)
        spans = Spans.joined(list(scan_convert(u, v, subcells)))
        assert spans.columns[spans.rows == row] == -(-numerator // denominator)
        checked += 1


@given(st.integers(-60, 60), st.integers(1, 60), st.integers(1, 30), st.sampled_from([64, 1024, 8192]))
def test_an_edge_through_cell_centres_passes_them_exactly(columns, rows, repeats, subcells):
    """The edge starts at (2000, 0) and takes `repeats` steps of (columns, rows) cells; every step ends at a cell
    centre.
    """
    u = np.array([[2000], [2000 + columns * repeats], [4000]], float) * subcells
    v = np.array([[0], [rows * repeats], [0]], float) * subcells
    spans = Spans.joined(list(scan_convert(u, v, subcells)))
    assert (spans.columns[spans.rows % rows == 0] == 2000 + columns * np.arange(repeats)).all()


@given(st.lists(st.tuples(st.integers(-32, 32 * 64), st.integers(-32, 32 * 64)), min_size=4, max_size=4))
def test_two_halves_of_a_quad_have_the_samples_of_the_whole(corners):
    """Counted with the sign of their winding, the triangles 012 and 023 have the same samples as 013 and 123."""

    def signed(*ids):
        (ax, ay), (bx, by), (cx, cy) = (corners[i] for i in ids)
        sign = np.sign((bx - ax) * (cy - ay) - (by - ay) * (cx - ax))
        u, v = ([[corners[i][k]] for i in ids] for k in (0, 1))
        return {sample[1:]: sign for sample in samples(u, v, 64)}

    totals = []
    for pair in (((0, 1, 2), (0, 2, 3)), ((0, 1, 3), (1, 2, 3))):
        halves = [signed(*ids) for ids in pair]
        totals.append({s: sum(h.get(s, 0) for h in halves) for s in set().union(*halves)})
    keys = set(totals[0]) | set(totals[1])
    assert all(totals[0].get(s, 0) == totals[1].get(s, 0) for s in keys)


def test_a_sample_on_an_edge_belongs_to_the_triangle_above_and_to_the_right_alone():
    u = [[0, 0], [128, 128], [0, 128]]
    v = [[0, 0], [128, 0], [128, 128]]
    assert samples(u, v, 64) == [(0, 0, 1), (1, 0, 0), (1, 1, 0), (1, 1, 1)]


def test_collinear_corners_have_no_samples():
    assert samples([[0], [640], [320]], [[0], [640], [320]], 64) == []


def test_batches_stay_below_the_limit_and_lose_nothing():
    counts = np.array([3, 3, 5, 20, 1, 1])
    parts = [(part.start, part.stop) for part in batches(counts, 10)]
    assert parts == [(0, 2), (2, 3), (3, 4), (4, 6)]
