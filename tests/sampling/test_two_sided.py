# SPDX-License-Identifier: GPL-3.0-or-later
"""The two sides of cards move apart by more than they blend, and nothing else moves."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from splat_addon.sampling import (
    DEFAULT_CREASE_ANGLE,
    Channel,
    Surface,
    Tolerance,
    TriangleMesh,
    VertexColors,
    drop_unusable,
    grid_spacing,
    is_solid,
    joined_blocks,
    sample_block,
    sample_surface,
)
from splat_addon.sampling.refine import two_sided
from splat_addon.surfels import quaternion_axes

OPTIONS = {
    "crease_angle": DEFAULT_CREASE_ANGLE,
    "fits_blending": True,
    "fits_planes": True,
    "tolerance": Tolerance(0.0),
}
FRONT, BACK = (0.9, 0.1, 0.1, 1.0), (0.1, 0.1, 0.9, 1.0)


def card(turn=None, bend=0.0, other_diagonal=False, apart=0.0):
    """A red square and a blue one that faces the other way. bend: of one corner, out of the plane. other_diagonal:
    whether the back is divided along its other diagonal. apart: from the back to the front."""
    places = np.array([(0, 0, 0), (1, 0, 0), (1, 1, bend), (0, 1, 0)])
    front = [(0, 1, 2), (0, 2, 3)]
    back = [(4, 7, 5), (5, 7, 6)] if other_diagonal else [(4, 6, 5), (4, 7, 6)]
    corners = np.concatenate([places, places - (0, 0, apart)])
    colors = np.repeat(np.repeat([FRONT, BACK], 2, axis=0)[:, None], 3, axis=1).astype(np.float32)
    surfaces = (Surface(Channel((1, 1, 1, 1), VertexColors())),)
    positions = corners if turn is None else turn.apply(corners)
    return TriangleMesh(positions, np.array(front + back), corner_colors=colors, surfaces=surfaces)


def seen(surfels, direction):
    """(n, 3) colours where places are seen from this direction: those of the nearest splats, or means of all splats
    within their blend depth. Backs of solids are not seen."""
    x, y, z = quaternion_axes(surfels.rotations.astype(np.float64))
    places = surfels.positions.astype(np.float64)
    depth = surfels.blend_depth * surfels.radius
    colors = []
    for place in places[:: max(len(places) // 200, 1)]:
        way = np.einsum("ij,ij->i", places - place, z) / (z @ direction)
        hit = place - places + way[:, None] * direction
        inside = (np.einsum("ij,ij->i", hit, x) / surfels.scales[:, 0]) ** 2
        inside += (np.einsum("ij,ij->i", hit, y) / surfels.scales[:, 1]) ** 2
        inside[surfels.is_solid & (z @ direction < 0)] = 2
        height, blends = way[inside < 1], (depth / np.abs(z @ direction))[inside < 1]
        colors.append(surfels.colors[inside < 1, :3][height >= (height - blends).max()].mean(axis=0))
    return np.array(colors)


angles = st.tuples(*[st.floats(-3, 3)] * 3)


@settings(deadline=None, max_examples=15)
@given(
    angles=angles,
    resolution=st.sampled_from([17, 40, 97]),
    other_diagonal=st.booleans(),
    bend=st.sampled_from([0, 0.004]),
)
def test_each_side_of_a_card_has_its_own_colour(angles, resolution, other_diagonal, bend):
    turn = Rotation.from_euler("xyz", angles)
    mesh = card(turn, bend, other_diagonal)
    surfels = sample_surface(mesh, resolution=resolution, **OPTIONS).surfels
    # bent apart, the two sheets bound a solid
    surfels = surfels.as_solid() if is_solid(mesh) else surfels
    up = turn.apply((0.1, 0.2, 1.0))
    for direction, color in ((up, FRONT), (-up, BACK)):
        assert np.abs(seen(surfels, direction) - color[:3]).max() < 1e-6


@pytest.mark.parametrize("apart", [0.0, 0.01, 0.1])
def test_they_move_by_some_hundredths_of_a_cell(apart):
    mesh = card(apart=apart / 40)
    surfels = sample_surface(mesh, resolution=40, **OPTIONS).surfels
    heights = (surfels.positions[:, 2] + surfels.origin[2]) * 40
    is_front = surfels.colors[:, 0] > 0.5
    assert 0.005 < heights[is_front].min() and heights[is_front].max() < 0.05
    assert 0.005 < -(heights[~is_front] + apart).max() and -(heights[~is_front] + apart).min() < 0.05
    assert (surfels.hidden_back == 1).all()


@pytest.mark.parametrize("name", ["cube", "sphere", "sheet", "parallel sheets"])
def test_nothing_else_moves(name, cube, sphere, monkeypatch):
    one = card()
    lower = card(apart=0.3 / 60)
    mesh = {
        "cube": cube(),
        "sphere": sphere,
        "sheet": one.with_triangles(np.arange(2)),
        "parallel sheets": lower,
    }[name]
    moved = sample_surface(mesh, resolution=60, **OPTIONS).surfels
    assert moved.hidden_back is None
    monkeypatch.setattr(two_sided, "_REACH", 0.0)
    assert np.array_equal(moved.positions, sample_surface(mesh, resolution=60, **OPTIONS).surfels.positions)


def test_a_large_splat_finds_small_ones_behind_it():
    """The front is one large face; the back consists of strips that are too narrow for large splats."""
    steps = np.linspace(0, 1, 21)
    places = np.array([(x, y, 0.0) for x in steps for y in (0, 1)])
    k = 2 * np.arange(20)
    back = np.concatenate([np.stack([k, k + 1, k + 3], axis=1), np.stack([k, k + 3, k + 2], axis=1)])
    places[2::4, 2] = 1e-9  # no face is as wide as two strips
    mesh = card()
    colors = np.concatenate([mesh.corner_colors[:2], np.broadcast_to(mesh.corner_colors[2], (len(back), 3, 4))])
    both = TriangleMesh(
        np.concatenate([mesh.positions[:4], places]), np.concatenate([mesh.triangles[:2], back + 4]),
        corner_colors=colors, surfaces=mesh.surfaces,
    )  # fmt: skip
    surfels = sample_surface(both, resolution=120, **OPTIONS).surfels
    is_front = surfels.colors[:, 0] > 0.5
    assert surfels.scales[is_front].max() > 3 * grid_spacing(both, resolution=120)
    heights = surfels.positions[:, 2] + surfels.origin[2]
    assert heights[is_front].min() > 0 > heights[~is_front].max()


def test_blocks_move_as_the_whole_does():
    mesh = card(Rotation.from_euler("xyz", (0.3, 0.2, 0.1)))
    whole = sample_surface(mesh, resolution=60, **OPTIONS).surfels
    blocks = [sample_block(mesh, k, 3, resolution=60, **OPTIONS) for k in range(3)]
    assert np.array_equal(joined_blocks(mesh, blocks, resolution=60, **OPTIONS).surfels.positions, whole.positions)


def test_a_back_stays_if_it_looks_different(cube):
    mesh = card()
    front = np.concatenate([mesh.triangles[:2], mesh.triangles[:2, [0, 2, 1]]])
    for colors, dropped in (([FRONT, BACK], {}), ([FRONT, FRONT], {"that repeat another": 2})):
        colors = np.repeat(np.repeat(colors, 2, axis=0)[:, None], 3, axis=1).astype(np.float32)
        assert drop_unusable(TriangleMesh(mesh.positions, front, corner_colors=colors))[1] == dropped
    materials = np.array([0, 0, 1, 1], np.int32)
    twice = TriangleMesh(mesh.positions, np.tile(front, (2, 1)), materials=np.tile(materials, 2))
    assert drop_unusable(twice)[1] == {"that repeat another": 4}
