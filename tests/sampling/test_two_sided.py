# SPDX-License-Identifier: GPL-3.0-or-later
"""The backs of a card's two sides are hidden, and no others."""

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
)
from tests.plain import joined_blocks, sample_block, sample_surface

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


def hidden(mesh, resolution):
    """(N,) of the mesh's surfels, None if they lack the field."""
    return sample_surface(mesh, resolution=resolution, **OPTIONS).surfels.hidden_back


angles = st.tuples(*[st.floats(-3, 3)] * 3)


@settings(max_examples=settings.default.max_examples // 5)
@given(
    angles=angles,
    resolution=st.sampled_from([17, 40, 97]),
    other_diagonal=st.booleans(),
    bend=st.sampled_from([0, 3e-4, -3e-4]),
)
def test_a_card_has_two_hidden_backs(angles, resolution, other_diagonal, bend):
    mesh = card(Rotation.from_euler("xyz", angles), bend, other_diagonal)
    if is_solid(mesh):  # bent apart, the two sheets bound a solid
        assert hidden(mesh, resolution) is None
    else:
        assert (hidden(mesh, resolution) == 1).all()


@pytest.mark.parametrize(
    ("apart", "is_card"), [(0.0, True), (0.3, True), (0.9, True), (1.1, False), (-0.01, True), (-0.1, False)]
)
def test_sheets_are_cards_if_one_is_close_behind_the_other(apart, is_card):
    """With a negative distance the sheets face each other across a gap."""
    backs = hidden(card(apart=apart / 40), 40)
    assert (backs == 1).all() if is_card else backs is None


@pytest.mark.parametrize(("angle", "is_card"), [(20, True), (50, True), (70, False)])
def test_a_wedge_is_a_card_where_it_is_thin(angle, is_card):
    """Two squares that meet at this angle, in degrees."""
    half = np.radians(angle) / 2
    far = np.array([(np.cos(half), 0, 1), (np.cos(half), 1, 1)]) * (1, 1, np.sin(half))
    places = np.concatenate([[(0, 0, 0), (0, 1, 0)], far, far * (1, 1, -1)])
    front, back = [(0, 2, 3), (0, 3, 1)], [(0, 5, 4), (0, 1, 5)]
    mesh = TriangleMesh(places, np.array(front + back))
    surfels = sample_surface(mesh, spacing=1 / 40, **OPTIONS).surfels
    if not is_card:
        assert surfels.hidden_back is None
        return
    # in spacings, from one square straight to the other
    thickness = 40 * 2 * np.sin(half) * (surfels.positions + surfels.origin)[:, 0]
    assert (surfels.hidden_back == 1)[thickness < 0.5].mean() > 0.9
    assert not surfels.hidden_back[thickness > 2].any()


@pytest.mark.parametrize("name", ["cube", "sphere", "sheet"])
def test_nothing_else_has_hidden_backs(name, cube, sphere):
    mesh = {"cube": cube(), "sphere": sphere, "sheet": card().with_triangles(np.arange(2))}[name]
    assert hidden(mesh, 60) is None
    assert hidden(mesh.with_triangles(np.arange(1, len(mesh))), 60) is None


@pytest.mark.parametrize(("deforms", "is_open"), [(False, False), (True, False), (True, True)])
def test_a_floor_is_no_card_if_the_closed_box_on_it_may_move(deforms, is_open, cube):
    """The floor would have a hole from below after the box is lifted. A card stays one, and so does an open box."""
    whole = cube()
    is_top = (whole.positions[whole.triangles][..., 2] == whole.positions[:, 2].max()).all(axis=1)
    box = whole.with_triangles(np.flatnonzero(~is_top)) if is_open else whole
    floor, leaf = card().with_triangles(np.arange(2)), card(apart=0.01)
    low, high = whole.bounds()
    places = (
        (box.positions - low) / (high - low) / 2 + (0.2, 0.2, 0),
        floor.positions,
        np.add(leaf.positions, (0, 0, 2)),
    )
    first = np.cumsum([0, len(box.positions), len(floor.positions)])
    triangles = [one.triangles + start for one, start in zip((box, floor, leaf), first, strict=True)]
    mesh = TriangleMesh(np.concatenate(places), np.concatenate(triangles))
    surfels = sample_surface(mesh, resolution=60, deforms=deforms, **OPTIONS).surfels
    height = (surfels.positions + surfels.origin)[:, 2]
    assert (surfels.hidden_back[height > 1.9] == 1).all()
    assert surfels.hidden_back[height < 0.6].any() == (is_open or not deforms)


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
    assert (surfels.hidden_back == 1).all()


def test_blocks_have_the_hidden_backs_of_the_whole():
    mesh = card(Rotation.from_euler("xyz", (0.3, 0.2, 0.1)))
    whole = sample_surface(mesh, resolution=60, **OPTIONS).surfels
    blocks = [sample_block(mesh, k, 3, resolution=60, **OPTIONS) for k in range(3)]
    joined = joined_blocks(mesh, blocks, resolution=60, **OPTIONS).surfels
    assert np.array_equal(joined.hidden_back, whole.hidden_back) and whole.hidden_back.all()


def test_a_back_stays_if_it_looks_different():
    mesh = card()
    front = np.concatenate([mesh.triangles[:2], mesh.triangles[:2, [0, 2, 1]]])
    for colors, dropped in (([FRONT, BACK], {}), ([FRONT, FRONT], {"that repeat another": 2})):
        colors = np.repeat(np.repeat(colors, 2, axis=0)[:, None], 3, axis=1).astype(np.float32)
        assert drop_unusable(TriangleMesh(mesh.positions, front, corner_colors=colors))[1] == dropped
    materials = np.array([0, 0, 1, 1], np.int32)
    twice = TriangleMesh(mesh.positions, np.tile(front, (2, 1)), materials=np.tile(materials, 2))
    assert drop_unusable(twice)[1] == {"that repeat another": 4}
