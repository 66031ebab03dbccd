# SPDX-License-Identifier: GPL-3.0-or-later
"""A merged surfel differs from those that it stands for by no more than its bounds, whatever these surfels are."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial import cKDTree

from splat_addon.clip_lines import kept
from splat_addon.hierarchy import surroundings
from splat_addon.quaternions import quaternion_axes

from ..rendering.creased import clipped_iron
from .conftest import ball, cut_sheet, leaves_of, make_surfels, sheet

ROUNDING = 1e-4
ANGLES = np.linspace(0, 2 * np.pi, 24, endpoint=False)
CIRCLE = np.stack([np.cos(ANGLES), np.sin(ANGLES)], axis=1)


def ellipse_points(surfels, rows, places):
    """The (n, k, 3) points of ellipses at places (k, 2) given in half-axes."""
    u, v = (axis[rows].astype(float) for axis in surfels.half_axes())
    return surfels.positions[rows][:, None] + places[:, :1] * u[:, None] + places[:, 1:] * v[:, None]


def check(surfels):
    check_bounds(surfels, *leaves_of(surfels)[:3])


def check_bounds(surfels, below, nodes, errors):
    x, y, z = (axis.astype(float) for axis in quaternion_axes(nodes.rotations))
    lines, reflex = surfels.clip_lines()
    node_lines, are_reflex = nodes.clip_lines()
    assert not are_reflex.any()
    disc = np.concatenate([CIRCLE * r for r in (0.25, 0.5, 0.75, 1)] + [[(0, 0)]])
    for k in range(len(nodes)):
        rows = below[len(surfels) + k]
        off, extent, _ = errors[k] + ROUNDING
        offsets = ellipse_points(surfels, rows, CIRCLE) - nodes.positions[k]
        assert np.abs(offsets @ z[k]).max() <= off
        flat = np.stack([offsets @ x[k], offsets @ y[k]], axis=-1) / nodes.scales[k]
        # measured along the ray to the middle, which is at least the true distance
        beyond = np.linalg.norm(flat * nodes.scales[k], axis=-1) * (
            1 - 1 / np.maximum(np.linalg.norm(flat, axis=-1), 1)
        )
        assert nearest_outside(flat, nodes.scales[k], beyond) <= extent
        own = kept_points(nodes, np.array([k]), disc, node_lines, are_reflex) - nodes.positions[k]
        covered = kept_points(surfels, rows, disc, lines, reflex) - nodes.positions[k]
        places = np.stack([covered @ x[k], covered @ y[k]], axis=-1) / nodes.scales[k]
        for *way, distance in node_lines[k]:
            past = -(places @ way + distance) / np.linalg.norm(way / nodes.scales[k])
            assert past.max() <= extent + ROUNDING
        apart, _ = cKDTree(places * nodes.scales[k]).query(np.stack([own @ x[k], own @ y[k]], axis=-1))
        # coverage is tested at places a quarter of a half-axis apart, of which lines may leave none
        assert apart.max(initial=0) <= extent + surfels.radius[rows].max() / 4


def kept_points(surfels, rows, places, lines, reflex):
    """The points of ellipses at places (k, 2) that their own lines keep, all in one array."""
    points = ellipse_points(surfels, rows, places)
    of_points = np.repeat(rows, len(places))
    return points.reshape(-1, 3)[kept(np.tile(places, (len(rows), 1)), lines[of_points], reflex[of_points])]


def nearest_outside(flat, scales, beyond):
    """The largest distance from the ellipse of places (in half-axes) outside it, at most `beyond`."""
    outside = np.linalg.norm(flat, axis=-1) > 1
    if not outside.any():
        return 0.0
    fine = np.linspace(0, 2 * np.pi, 256)
    rim = np.stack([np.cos(fine), np.sin(fine)], axis=1) * scales
    distance = np.linalg.norm((flat[outside] * scales)[:, None] - rim, axis=-1).min(axis=1)
    return float(np.minimum(distance, beyond[outside]).max())


@settings(max_examples=settings.default.max_examples // 4)
@given(st.integers(0, 2**32 - 1))
def test_no_point_of_any_surfel_is_farther_than_its_node_says(seed):
    check(strays(seed))


def strays(seed, count=150, **fields):
    """A bumpy surface of irregular discs that face both ways, some of them far away."""
    random = np.random.default_rng(seed)
    place = random.uniform(-1, 1, (count, 2))
    positions = np.column_stack([place, random.uniform(0, 0.5) * np.sin(place @ random.uniform(-4, 4, 2))])
    positions[: count // 10] = random.uniform(-2, 2, (count // 10, 3))
    normals = np.column_stack([random.normal(0, random.uniform(0, 1), (count, 2)), random.choice([-1, 1], count)])
    colors = np.column_stack([random.uniform(0, 2, (count, 3)), random.uniform(0, 1, count)])
    given = {"colors": colors, "materials": random.integers(0, 2, count)}
    return make_surfels(positions, normals, random.uniform(0.02, 0.3, (count, 2)), **{**given, **fields})


@settings(max_examples=settings.default.max_examples // 5)
@given(st.integers(0, 2**32 - 1))
def test_what_clip_lines_take_away_counts_as_sticking_out(seed):
    random = np.random.default_rng(seed)
    lines = {
        name: np.column_stack(
            [random.integers(-(2**15), 2**15, 150), random.integers(0, 15000, 150) * random.integers(0, 2, 150)]
        ).astype(np.int16)
        for name in ("clip_line", "clip_line_2")
    }
    check(strays(seed, **lines))


def test_a_clip_line_adds_what_it_takes_away(monkeypatch):
    monkeypatch.setattr(surroundings, "AT_BORDERS", 1)
    positions, normals = sheet(count=3)
    line = np.tile(np.array([0, 8192], np.int16), (9, 1))  # half of a half-axis
    plain, clipped = (leaves_of(make_surfels(positions, normals, **f))[2][0, 1] for f in ({}, {"clip_line": line}))
    assert np.isclose(clipped - plain, 0.05 / 2)


@pytest.mark.parametrize("count", [100, 6000])
def test_errors_never_shrink_up_the_tree(count):
    surfels = make_surfels(*ball(count), half=1.25 * (4 * np.pi / count) ** 0.5)
    _, _, errors, levels = leaves_of(surfels)
    every = np.concatenate([np.zeros((count, 3)), errors])
    numbers = np.arange(count)
    for level in levels:
        parents = np.repeat(level.numbers, level.counts)
        assert (every[parents] >= every[numbers[level.children]]).all()
        numbers = level.numbers
    assert levels


def test_what_is_shown_changes_by_no_more_than_the_bound():
    surfels = strays(3)
    below, nodes, errors, _ = leaves_of(surfels)
    for k in range(len(nodes)):
        rows = below[len(surfels) + k]
        turned = np.linalg.norm(surfels.normals[rows] - nodes.normals[k], axis=1).max() / 2
        tinted = np.abs(surfels.colors[rows] - nodes.colors[k]).max()
        assert errors[k, 2] >= nodes.radius[k] * min(max(turned, tinted), 1) - ROUNDING


def test_a_smooth_surface_is_known_to_a_share_of_its_cells():
    """Bounds must also be tight: on a smooth surface a level is off by at most the size of its cells."""
    count = 20000
    surfels = make_surfels(*ball(count), half=1.25 * (4 * np.pi / count) ** 0.5)
    _, nodes, errors, levels = leaves_of(surfels)
    first = slice(0, int((levels[0].counts > 1).sum()))
    assert np.median(errors[first, 1] / nodes.radius[first]) < 0.4
    assert np.median(errors[first, 0] / nodes.radius[first]) < 0.2


@pytest.mark.parametrize("turn", [0.0, 0.3, 1.2])
@pytest.mark.parametrize("width", [0.01, 0.07, 0.4])
def test_bounds_hold_where_merged_surfels_end_at_lines(turn, width):
    """A strip, narrower or wider than the cells, is cut from a sheet by two lines. Two others make a corner."""
    surfels = cut_sheet([(turn, -width / 2), (turn + np.pi, -width / 2)])
    below, nodes, errors, _ = leaves_of(surfels)
    assert nodes.is_cut().mean() > 0.3
    check_bounds(surfels, below, nodes, errors)
    check(cut_sheet([(turn, -width / 2), (turn + 1.8, -width / 2)]))


def test_bounds_hold_at_convex_and_reflex_corners():
    """What one line of a reflex corner keeps beyond the other must not be cut away."""
    surfels = clipped_iron((8, 8), 40)[0].surfels[0].surfels
    assert surfels.clip_lines()[1].any()
    below, nodes, errors, _ = leaves_of(surfels)
    assert nodes.is_cut().mean() > 0.3
    check_bounds(surfels, below, nodes, errors)
