# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfels follow a deforming mesh: rigid motion is exact, bending leaves no holes, and the surfels stay the
same ones.
"""

from dataclasses import replace

import numpy as np
import pytest
import trimesh
from trimesh.transformations import rotation_matrix

from splat_addon.reference.bare import uncovered_points
from splat_addon.sampling import STRETCHED_SHARE, Channel, Surface, TriangleMesh, VertexColors
from splat_addon.sampling.deform.binding import LARGEST_STRETCH
from tests.plain import deforming_surfels

TURN = rotation_matrix(1.1, (1, 2, 3))[:3, :3]


@pytest.fixture(scope="module")
def bar():
    """A smooth, rounded bar along z, 1 x 1 x 4, of small triangles, with a speck beside it that no ray hits."""
    made = trimesh.creation.capsule(height=3, radius=0.5, count=(24, 24)).subdivide()
    speck = np.array([(0.83, 0.83, 1), (0.831, 0.83, 1), (0.83, 0.831, 1)])
    positions = np.concatenate([made.vertices, speck])
    triangles = np.concatenate([made.faces, len(made.vertices) + np.arange(3)[None]])
    normals = np.concatenate([made.vertex_normals[made.faces], np.tile((0.0, 0, 1), (1, 3, 1))])
    return TriangleMesh(positions, triangles, corner_normals=normals)


@pytest.fixture(scope="module")
def deforming(bar):
    made = deforming_surfels(bar, spacing=0.05)
    assert made.sampling.small_parts == 1
    return made


@pytest.fixture(scope="module")
def homes(bar, deforming):
    """The triangle that each surfel of the bar was sampled in, (N,), and its barycentric weights there, (N, 3)."""
    rest = trimesh.Trimesh(bar.positions, bar.triangles[:-1], process=False)
    places = (deforming.sampling.surfels.origin + deforming.sampling.surfels.positions)[:-1]
    _, _, triangle = trimesh.proximity.closest_point(rest, places)
    return triangle, trimesh.triangles.points_to_barycentric(rest.triangles[triangle], places)


def moved(mesh, place, normals=None):
    """The mesh with its vertices at place((V, 3)), and with the given normals or recomputed smooth ones."""
    positions = place(mesh.positions)
    if normals is None:
        solid = trimesh.Trimesh(positions, mesh.triangles, process=False)
        normals = solid.vertex_normals[mesh.triangles]
    return replace(mesh, positions=positions, corner_normals=normals)


def frames(surfels):
    """(N, 3, 3) float64: the half-axes and the geometric normal as columns."""
    u, v = (axis.astype(np.float64) for axis in surfels.half_axes())
    return np.stack([u, v, surfels.geometric_normals().astype(np.float64)], axis=2)


@pytest.mark.parametrize("shift", [(0, 0, 0), (3, -2, 1), (1e7, 0, -1e7)], ids=str)
def test_a_rigid_motion_moves_every_surfel_exactly(bar, deforming, shift):
    rest = deforming.sampling.surfels
    turned = moved(bar, lambda p: p @ TURN.T + shift, bar.corner_normals @ TURN.T)
    surfels, stretched = deforming.at(turned)
    # float64 rounds a position of 1e7 by 2e-9; edges are 0.03 long
    tight = {"atol": 2e-6}
    wanted = (rest.origin + rest.positions.astype(np.float64)) @ TURN.T + shift
    assert np.allclose(surfels.positions + (surfels.origin - shift), wanted - shift, **tight)
    assert np.allclose(frames(surfels), TURN @ frames(rest), **tight)
    assert np.allclose(surfels.scales, rest.scales, rtol=1e-5)
    assert np.allclose(surfels.normals, rest.normals @ TURN.T, **tight)
    assert np.array_equal(surfels.colors, rest.colors) and stretched == 0


def test_the_same_shape_gives_the_same_object(bar, deforming):
    assert deforming.at(replace(bar, positions=bar.positions.copy()))[0] is deforming.at(bar)[0]


def bend(p):
    """The bar bent by 120 degrees about an axis beside it."""
    angle, radius = p[:, 2] / 2, 2 + p[:, 0]
    return np.stack([radius * np.cos(angle) - 2, p[:, 1], radius * np.sin(angle)], axis=1)


def twist(p):
    angle = p[:, 2] * 0.8
    c, s = np.cos(angle), np.sin(angle)
    return np.stack([c * p[:, 0] - s * p[:, 1], s * p[:, 0] + c * p[:, 1], p[:, 2]], axis=1)


SHAPES = {
    "stretched by 2": lambda p: p * (1, 1, 2),
    "larger by 2": lambda p: p * 2.0,
    "sheared": lambda p: p + p[:, [2, 2, 2]] * (0.7, 0, 0),
    "bent": bend,
    "twisted": twist,
    "squeezed to a third": lambda p: p * (1, 1, 1 / 3),
    "bulging": lambda p: p * (1 + np.exp(-(p[:, 2:] ** 2))),
}


@pytest.mark.parametrize("shape", SHAPES.values(), ids=SHAPES)
def test_a_deformed_surface_stays_covered(bar, deforming, shape):
    mesh = moved(bar, shape)
    surfels, stretched = deforming.at(mesh)
    without_speck = replace(mesh, triangles=mesh.triangles[:-1], corner_normals=mesh.corner_normals[:-1])
    assert len(uncovered_points(without_speck, surfels, 0.05)) <= 40
    assert stretched <= STRETCHED_SHARE


@pytest.mark.parametrize("shape", SHAPES.values(), ids=SHAPES)
def test_surfels_stay_on_the_surface_in_their_own_triangles(bar, deforming, homes, shape):
    """Their number and order stay the same, and each lies in the triangle that it was sampled in."""
    (triangle, weights), mesh = homes, moved(bar, shape)
    surfels, _ = deforming.at(mesh)
    assert len(surfels) == len(deforming.sampling.surfels)
    after = trimesh.Trimesh(mesh.positions, mesh.triangles[:-1], process=False)
    places = (surfels.origin + surfels.positions)[:-1]
    assert np.allclose(weights, trimesh.triangles.points_to_barycentric(after.triangles[triangle], places), atol=1e-3)
    # for a point on an edge, the oracle may return the other triangle
    same = np.isclose(frames(surfels)[:-1, :, 2], after.face_normals[triangle], atol=1e-4).all(axis=1)
    assert same.mean() > 0.97
    own = trimesh.triangles.barycentric_to_points(after.triangles[triangle], weights)
    assert np.allclose(places, own, atol=1e-5)


def test_the_ellipse_is_the_image_of_the_ellipse(bar, deforming):
    """Under one linear map, every point of every rim is mapped onto the new rim."""
    linear = np.array([[1.0, 0.3, 0], [0, 1.2, 0.4], [0.2, 0, 0.8]])
    rest, (surfels, _) = deforming.sampling.surfels, deforming.at(moved(bar, lambda p: p @ linear.T))
    angle = np.linspace(0, 2 * np.pi, 9)[:-1]
    rims = frames(rest)[:, :, :2] @ np.stack([np.cos(angle), np.sin(angle)])
    local = np.linalg.solve(frames(surfels), linear @ rims)
    # the speck's disc is only nearly in the plane of its triangle
    assert np.allclose((local[:-1, :2] ** 2).sum(axis=1), 1, atol=1e-3)
    assert np.abs(local[:-1, 2]).max() < 1e-5


def test_too_much_stretch_is_said(bar, deforming):
    _, stretched = deforming.at(moved(bar, lambda p: p * (1, 1, 1.1 * LARGEST_STRETCH)))
    assert stretched > 0.5


def test_a_part_that_grows_from_nothing_is_said(bar):
    """The part had no area when it was sampled, so it has no surfels."""
    top = bar.positions[:, 2] > 0.5
    collapsed = replace(bar, positions=np.where(top[:, None], (0, 0, 2), bar.positions))
    deforming = deforming_surfels(collapsed, spacing=0.05)
    surfels, stretched = deforming.at(bar)
    assert len(surfels) == len(deforming.sampling.surfels)
    assert stretched > 0.1


def test_a_collapsed_and_a_broken_mesh_keep_every_surfel(bar, deforming):
    broken = bar.positions.copy()
    broken[7] = np.nan
    for positions in (bar.positions * (1, 1, 0), bar.positions * 0, broken):
        surfels, _ = deforming.at(replace(bar, positions=positions))
        assert len(surfels) == len(deforming.sampling.surfels)
        assert (surfels.scales > 0).all()


def test_other_triangles_are_refused(bar, deforming):
    with pytest.raises(ValueError, match="other triangles"):
        deforming.at(TriangleMesh(bar.positions, bar.triangles[::-1]))


def test_colours_that_change_are_sampled_at_the_same_places(bar):
    painted = Surface(Channel((1, 1, 1, 1), VertexColors()))
    colors = np.random.default_rng(1).uniform(size=(len(bar), 3, 4))
    deforming = deforming_surfels(replace(bar, corner_colors=colors, surfaces=(painted,)), spacing=0.1)
    before, bent_before = deforming.sampling.surfels, deforming.at(replace(moved(bar, bend), corner_colors=colors))[0]
    darker = replace(moved(bar, bend), corner_colors=colors / 2, surfaces=(painted,))
    after, _ = deforming.at(darker)
    assert np.allclose(after.colors, before.colors / 2, atol=1e-6)
    assert np.array_equal(after.positions, bent_before.positions)


def test_a_solid_that_is_turned_inside_out_is_none_any_more(bar):
    ball = replace(bar, triangles=bar.triangles[:-1], corner_normals=None)
    deforming = deforming_surfels(ball, spacing=0.1)
    assert deforming.at(ball)[0].is_solid
    assert not deforming.at(replace(ball, positions=ball.positions * (1, 1, -1)))[0].is_solid


def test_texture_coordinates_keep_their_direction_on_the_surface(bar):
    """On the bar u = x and v = z; after shearing, u and v still change along the axes as x and z did before."""
    deforming = deforming_surfels(bar, spacing=0.1)
    rest = deforming.sampling.surfels
    u, v = rest.half_axes()
    deforming.sampling = replace(
        deforming.sampling,
        surfels=replace(rest, uvs=rest.positions[:, [0, 2]], uv_along_x=u[:, [0, 2]], uv_along_y=v[:, [0, 2]]),
    )
    linear = np.array([[1.0, 0, 0.5], [0, 1, 0], [0, 0.3, 1]])
    surfels, _ = deforming.at(moved(bar, lambda p: p @ linear.T))
    back = np.linalg.inv(linear)
    for along, axis in zip((surfels.uv_along_x, surfels.uv_along_y), surfels.half_axes(), strict=True):
        assert np.allclose(along[:-1], (axis @ back.T)[:-1, [0, 2]], atol=1e-4)
