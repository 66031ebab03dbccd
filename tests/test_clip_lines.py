# SPDX-License-Identifier: GPL-3.0-or-later
"""Packed clip lines are close to the given ones, never cut deeper, and keep their place when axes turn."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from splat_addon.clip_lines import are_reflex, kept, pack_lines, turned, unpack_lines
from splat_addon.interchange import transformed
from splat_addon.quaternions import axes_quaternions
from splat_addon.surfels import Surfels

ANGLES = st.floats(-np.pi, np.pi)
OFFSETS = st.floats(-0.95, 0.95)
PLACES = np.random.default_rng(4).uniform(-1, 1, (400, 2))


def line(angle, offset):
    return np.array([[np.cos(angle), np.sin(angle), offset]])


def sides(first, second):
    """(400,) bool: which of PLACES two packed lines leave."""
    lines = np.stack([unpack_lines(first), unpack_lines(second)], axis=1)
    return kept(PLACES, np.repeat(lines, len(PLACES), 0), np.repeat(are_reflex(first, second), len(PLACES)))


@given(ANGLES, OFFSETS, st.floats(1e-3, 1e3))
def test_a_packed_line_is_the_line_within_its_steps_and_cuts_no_deeper(angle, offset, length):
    packed = pack_lines(length * line(angle, offset))
    a, b, c = unpack_lines(packed)[0]
    assert packed.dtype == np.int16 and packed.nbytes == 4
    assert np.hypot(a - np.cos(angle), b - np.sin(angle)) < 1e-4
    assert -1e-9 <= c - offset < 1e-4


@given(ANGLES, st.floats(1.0, 50.0))
def test_a_line_that_misses_the_ellipse_is_none(angle, offset):
    assert pack_lines(line(angle, offset))[0, 1] == 0


@given(ANGLES, OFFSETS, st.floats(0.05, 3.0), OFFSETS)
def test_the_order_of_two_lines_tells_a_convex_corner_from_a_reflex_one(angle, offset, turn, other):
    first, second = pack_lines(line(angle, offset)), pack_lines(line(angle + turn, other))
    inside = [
        np.einsum("nk,k->n", PLACES, unpack_lines(p)[0, :2]) + unpack_lines(p)[0, 2] >= 0 for p in (first, second)
    ]
    assert np.array_equal(sides(first, second), inside[0] & inside[1])
    assert np.array_equal(sides(second, first), inside[0] | inside[1])


@given(ANGLES, OFFSETS, ANGLES, OFFSETS, st.floats(-7, 7), st.booleans())
def test_turned_lines_keep_the_same_places(angle, offset, other_angle, other_offset, turn, mirrored):
    fields = {"clip_line": pack_lines(line(angle, offset)), "clip_line_2": pack_lines(line(other_angle, other_offset))}
    after = turned(fields, np.array([turn]), np.array([mirrored]))
    u, v = PLACES.T
    sign = -1 if mirrored else 1
    places = np.stack([u * np.cos(turn) + v * np.sin(turn), sign * (v * np.cos(turn) - u * np.sin(turn))], axis=1)
    lines = np.stack([unpack_lines(after[name]) for name in fields], axis=1)
    reflex = are_reflex(after["clip_line"], after["clip_line_2"])
    is_kept = kept(places, np.repeat(lines, len(places), 0), np.repeat(reflex, len(places)))
    before = sides(*fields.values())
    # But for places as near to a line as the packing's steps, or lines that turn by as good as half a turn.
    near = (np.abs(np.einsum("nk,lk->nl", places, lines[0, :, :2]) + lines[0, :, 2]) < 2e-3).any(axis=1)
    opposite = abs(np.sin(angle - other_angle)) < 1e-3
    assert opposite or np.array_equal(is_kept[~near], before[~near])


@given(st.integers(0, 2**32 - 1), st.booleans())
def test_surfels_under_an_affine_map_end_at_the_same_points(seed, mirrors):
    random = np.random.default_rng(seed)
    frame, _ = np.linalg.qr(random.normal(size=(3, 3)))
    frame *= np.sign(np.linalg.det(frame))
    lines = [pack_lines(line(*random.uniform((-3, -0.5), (3, 0.9)))) for _ in range(2)]
    surfels = Surfels(
        positions=[[0, 0, 0]], rotations=axes_quaternions(*(frame.T[k][None] for k in range(3))), scales=[[1.5, 0.6]],
        normals=[frame[:, 2]], colors=[[1, 1, 1, 1]], materials=[0], clip_line=lines[0], clip_line_2=lines[1],
    )  # fmt: skip
    matrix = np.eye(4)
    matrix[:3, :3] = random.normal(size=(3, 3)) + np.diag(random.choice([-2, 2], 3))
    if (np.linalg.det(matrix) < 0) != mirrors:
        matrix[0] *= -1
    after = transformed(surfels, matrix)
    points = np.stack(surfels.half_axes(), axis=1)[0].T @ PLACES.T
    moved = matrix[:3, :3] @ points
    axes = np.stack(after.half_axes(), axis=1)[0].astype(float)
    places = (np.linalg.pinv(axes.T) @ moved).T
    assert_same(surfels, PLACES, after, places)


def assert_same(before, places, after, moved):
    (one, is_reflex), (other, is_other_reflex) = (s.clip_lines() for s in (before, after))
    away = (np.abs(np.einsum("nk,lk->nl", moved, other[0, :, :2]) + other[0, :, 2]) > 5e-3).all(axis=1)
    count = len(places)
    first = kept(places, np.repeat(one, count, 0), np.repeat(is_reflex, count))
    second = kept(moved, np.repeat(other, count, 0), np.repeat(is_other_reflex, count))
    turn = one[0, 0, 0] * one[0, 1, 1] - one[0, 0, 1] * one[0, 1, 0]
    assert abs(turn) < 1e-3 or np.array_equal(first[away], second[away])
