# SPDX-License-Identifier: GPL-3.0-or-later
"""In every view, the cut draws each visible surfel exactly once: itself, or in one of the nodes above it."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from splat_addon.hierarchy import Sight, Split, build_hierarchy, cut_blocks, entries_of
from splat_addon.hierarchy.blocks import depth_first, make_blocks
from splat_addon.hierarchy.building import build_levels
from splat_addon.runs import ranges

from .conftest import ball, leaves_of, make_surfels, sheet

COUNT = 8000
HALF = 1.25 * (4 * np.pi / COUNT) ** 0.5
SURFELS = make_surfels(*ball(COUNT), half=HALF)
HIERARCHY = build_hierarchy(SURFELS)
HOLLOW = build_hierarchy(make_surfels(SURFELS.positions, -SURFELS.positions, HALF))
BELOW = leaves_of(SURFELS)[0]


def sight(eye, tolerance=1.0, pixels=500.0, hides_backs=False, planes=((0, 0, 0, 1),)):
    """A view from a point towards the origin."""
    eye = np.asarray(eye, float)
    forward = -eye / np.linalg.norm(eye)
    depth = np.append(forward, -forward @ eye)
    return Sight(np.array(planes, float), depth, pixels, 1e-3, np.append(eye, 1), hides_backs, tolerance)


def cut_entries(hierarchy, view):
    return entries_of(hierarchy, cut_blocks(hierarchy.blocks, view))


def drawn(view):
    """How often each surfel of the ball is drawn, itself or by a node, and the total number drawn."""
    entries = cut_entries(HIERARCHY, view)
    entries = np.arange(COUNT) if entries is None else entries
    return np.bincount(np.concatenate([BELOW[e] for e in entries]), minlength=COUNT), len(entries)


@settings(max_examples=settings.default.max_examples // 2)
@given(
    st.tuples(*[st.floats(-30, 30)] * 3).filter(lambda p: np.linalg.norm(p) > 0.1),
    st.floats(0, 20),
)
def test_every_surfel_is_drawn_once(eye, tolerance):
    times, _ = drawn(sight(eye, tolerance))
    assert (times == 1).all()


@settings(max_examples=settings.default.max_examples // 2)
@given(st.floats(2.5, 30), st.floats(-1.2, 0.9), st.floats(0, 20), st.booleans())
def test_a_split_ball_is_its_surfels_beyond_the_split_of_which_those_at_polygons_are_not_merged(
    distance, offset, tolerance, is_parallel
):
    """offset: of the split from the ball's middle."""
    begin, view = distance + offset, sight((0, 0, distance), tolerance)
    split = Split(np.array([[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, -distance]]), begin, begin + 2 * HALF)
    if is_parallel:
        view = replace(view, eye=np.array([0, 0, 1.0, 0]))
    times, _ = drawn(replace(view, split=split))
    away = SURFELS.positions - [0, 0, distance]
    far = -away[:, 2] if is_parallel else np.linalg.norm(away, axis=1)
    assert (times[far > begin] == 1).all() and times.max(initial=0) <= 1
    assert times[far < begin - 40 * HALF].sum() == 0
    entries = cut_entries(HIERARCHY, replace(view, split=split))
    entries = np.arange(COUNT) if entries is None else entries
    merged = np.concatenate([BELOW[e] for e in entries if e >= COUNT] or [np.zeros(0, int)])
    assert (far[merged] > split.end).all()


def test_half_of_a_split_ball_is_left_out_and_most_of_the_other_half_is_merged():
    count = 100_000
    many = build_hierarchy(make_surfels(*ball(count), half=HALF * (COUNT / count) ** 0.5))
    split = Split(np.array([[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, -8.0]]), 8.0, 8.02)
    finest, merged = (len(cut_entries(many, replace(sight((0, 0, 8), t), split=split))) for t in (0, 8))
    assert 0.45 * count < finest < 0.6 * count and merged < 0.4 * finest


@settings(max_examples=settings.default.max_examples // 2)
@given(st.tuples(*[st.floats(-6, 6)] * 3).filter(lambda p: np.linalg.norm(p) > 1.2), st.floats(0, 10))
def test_what_faces_the_eye_is_drawn_where_backs_are_hidden(eye, tolerance):
    times, _ = drawn(sight(eye, tolerance, hides_backs=True))
    facing = (SURFELS.positions * (np.asarray(eye) - SURFELS.positions)).sum(axis=1) > 0
    assert (times[facing] == 1).all() and times.max() == 1


@settings(max_examples=settings.default.max_examples // 2)
@given(st.tuples(*[st.floats(-4, 4)] * 3))
def test_a_hollow_ball_is_drawn_where_it_faces_the_eye(eye):
    """Places and normals in one block then point in opposite directions."""
    entries = cut_entries(HOLLOW, sight(np.asarray(eye) + 1e-3, 0, hides_backs=True))
    entries = np.arange(COUNT) if entries is None else entries
    facing = (SURFELS.positions * (np.asarray(eye) + 1e-3 - SURFELS.positions)).sum(axis=1) < 0
    assert np.isin(np.flatnonzero(facing), entries).all()


def test_most_backs_are_left_out():
    times, _ = drawn(sight((0, 0, 5), 0, hides_backs=True))
    facing = SURFELS.positions[:, 2] > 0.2
    assert (times > 0).sum() < 1.5 * facing.sum()


@settings(max_examples=settings.default.max_examples // 2)
@given(st.tuples(*[st.floats(-1, 1)] * 3).filter(lambda n: np.linalg.norm(n) > 0.1), st.floats(-1, 1))
def test_what_lies_inside_of_the_picture_is_drawn(normal, distance):
    normal = np.asarray(normal) / np.linalg.norm(normal)
    times, _ = drawn(sight((0, 0, 5), 2.0, planes=(np.append(normal, distance),)))
    inside = SURFELS.positions @ normal + distance > 0
    assert (times[inside] == 1).all()


def test_a_tolerance_of_0_draws_the_surfels_as_they_are():
    assert cut_entries(HIERARCHY, sight((0, 0, 3), 0.0)) is None


def test_no_error_that_is_drawn_is_above_the_tolerance():
    view = sight((0, 0, 9), 15.0)
    entries = cut_entries(HIERARCHY, view)
    nodes = entries[entries >= COUNT] - COUNT
    depth = 9 - HIERARCHY.nodes.positions[nodes, 2]
    assert len(nodes) and (HIERARCHY.errors[nodes].max(axis=1) * view.pixels / depth <= view.tolerance).all()


def test_colors_count_only_where_they_are_seen():
    colors = np.ones((COUNT, 4), np.float32)
    colors[:, :3] = np.random.default_rng(0).uniform(0, 1, (COUNT, 3))
    colored = build_hierarchy(replace(SURFELS, colors=colors))
    view = sight((0, 0, 9), 12.0)
    depth_only = replace(view, is_depth_only=True)
    shapes = cut_entries(HIERARCHY, depth_only)
    assert np.array_equal(cut_entries(colored, depth_only), shapes)
    assert len(shapes) < len(cut_entries(colored, view))


def test_a_rough_place_makes_few_others_finer():
    """Of the first level's nodes, which stand for nine surfels each, 12 are too coarse: at most 7 more go with each."""
    surfels = make_surfels(*sheet(180))
    _, errors, levels, geometry = build_levels(surfels)
    first = len(levels[0].numbers)
    errors[:first], errors[first:] = 1, 3
    errors[np.linspace(0, first - 1, 12).astype(int)] = 3
    entries, counts = depth_first(levels, len(surfels))
    blocks = make_blocks(entries, counts, geometry, errors)
    view = Sight(np.zeros((0, 4)), np.array([0, 0, -1.0, 5]), 1.0, 0.0, np.array([0, 0, 1.0, 0]), False, 2.0)
    drawn = cut_blocks(blocks, view)
    merged = ranges(blocks.first[drawn], (blocks.last - blocks.first)[drawn]) >= len(surfels)
    assert first == 3600 and first - 8 * 12 <= merged.sum() <= first - 12


@pytest.mark.parametrize(("distance", "most"), [(1e3, 60), (1e4, 6), (1e6, 6)])
def test_what_is_far_away_is_few_splats(distance, most):
    _, count = drawn(sight((0, 0, distance)))
    assert count <= most


def test_a_parallel_view_has_one_size_of_pixel():
    def count(pixels):
        view = Sight(np.zeros((0, 4)), np.array([0, 0, -1.0, 5]), pixels, 0.0, np.array([0, 0, 1.0, 0]), False, 1.0)
        entries = cut_entries(HIERARCHY, view)
        return COUNT if entries is None else len(entries)

    assert count(0.5) < 100 < count(5.0) < count(1e5) == COUNT
