# SPDX-License-Identifier: GPL-3.0-or-later
"""Every point of a texture-mapped splat has the texture coordinate of the surface below it."""

from dataclasses import replace

import numpy as np
import pytest

from splat_addon.images import Image
from splat_addon.sampling import Channel, Surface, Texture, Tolerance, TriangleMesh, VertexColors, corner_values
from splat_addon.sampling.materials.texture_mapping import UV_FIELDS
from tests.plain import sample_surface

IMAGE = Image(np.dstack([np.random.default_rng(1).uniform(0, 1, (32, 32, 3)), np.ones((32, 32))]))
TEXTURED = Surface(Channel((1.0, 0.5, 1.0, 1.0), Texture(IMAGE)))
#: Texture coordinates of a point, affine in all of space and so on every triangle.
LINEAR, SHIFT = np.array([[0.4, -0.3, 0.2], [0.1, 0.5, -0.6]]), np.array([0.3, -2.0])
REDUCTIONS = ("normal", "surfel_normal", "grazing", "none", "three_to_one")


def mapped(points):
    return points @ LINEAR.T + SHIFT


def textured(mesh, surface=TEXTURED, **fields):
    """The mesh with one surface, and with the map's coordinates at its corners."""
    uvs = mapped(mesh.positions)[mesh.triangles]
    return TriangleMesh(mesh.positions, mesh.triangles, corner_uvs=uvs, surfaces=(surface,), **fields)


def coordinates(surfels, x, y):
    """The (N, 2) texture coordinates and (N, 3) points of the ellipses at a place of the unit disc."""
    u, v = surfels.half_axes()
    points = surfels.origin + surfels.positions.astype(np.float64) + u * x + v * y
    return surfels.uvs + surfels.uv_along_x * x + surfels.uv_along_y * y, points


def check(surfels, atol=2e-5):
    assert surfels.has_uvs
    for x, y in ((0, 0), (1, 0), (0, 1), (-0.6, 0.7)):
        uvs, points = coordinates(surfels, x, y)
        np.testing.assert_allclose(uvs, mapped(points), atol=atol)


@pytest.mark.parametrize("reduction", [r for r in REDUCTIONS if r != "three_to_one"])
def test_an_affine_map_is_continued_over_every_splat(reduction, cube, sphere):
    for mesh in (cube(0.37), sphere):
        check(sample_surface(textured(mesh), resolution=24, reduction=reduction, texture_mapped=True).surfels)


def test_a_surfel_that_is_moved_to_a_lattice_keeps_the_texture_where_it_was(sphere):
    surfels = sample_surface(textured(sphere), resolution=24, reduction="three_to_one", texture_mapped=True).surfels
    exact = sample_surface(textured(sphere), resolution=24, reduction="none", texture_mapped=True).surfels
    # The surface below the lattice node, along the normal of the splat.
    uvs, points = coordinates(surfels, 0, 0)
    distance = np.einsum("ij,ij->i", points, surfels.geometric_normals()) - 1
    below = points - distance[:, None] * surfels.geometric_normals()
    assert np.abs(uvs - mapped(below)).max() < 0.1 / 24
    assert len(exact) > len(surfels)


def test_merged_surfels_continue_it_too_whatever_the_texture_shows(square):
    mesh = textured(square(3.0))
    mesh = TriangleMesh(mesh.positions @ np.linalg.qr(LINEAR.T @ LINEAR + np.eye(3))[0], mesh.triangles)
    mapped_sampling = sample_surface(textured(mesh), resolution=64, tolerance=Tolerance(1e-4), texture_mapped=True)
    plain = sample_surface(textured(mesh), resolution=64, tolerance=Tolerance(1e-4))
    check(mapped_sampling.surfels)
    assert len(mapped_sampling.surfels) < 0.25 * len(plain.surfels)


def test_surfels_do_not_merge_over_a_bent_map(square):
    """A single corner's coordinates are moved, so that the map is not affine."""
    mesh = textured(square(3.0))
    bent = mesh.corner_uvs.copy()
    bent[1, 2] += 0.2
    mesh = TriangleMesh(mesh.positions, mesh.triangles, corner_uvs=bent, surfaces=mesh.surfaces)
    sampling = sample_surface(mesh, resolution=64, tolerance=Tolerance(1e-4), texture_mapped=True)
    x, y = (sampling.surfels.origin + sampling.surfels.positions)[:, :2].T
    large = sampling.surfels.radius > 2 * sampling.surfels.radius.min()
    assert large.any()
    # every disc lies on one side of the diagonal, where the two maps meet
    assert (np.abs(x - y)[large] / np.sqrt(2) > 0.9 * sampling.surfels.radius[large] / 1.75).all()


def test_a_part_between_the_rays_has_the_map_of_its_largest_triangle(square):
    mesh = textured(TriangleMesh(square(0.2).positions + 5.0, square().triangles))
    surfels = sample_surface(mesh, spacing=1.0, texture_mapped=True).surfels
    assert len(surfels) == 1
    u, v = surfels.half_axes()
    np.testing.assert_allclose(surfels.uv_along_x, u @ LINEAR.T, atol=1e-5)
    np.testing.assert_allclose(surfels.uv_along_y, v @ LINEAR.T, atol=1e-5)


def test_the_placement_of_the_texture_is_in_the_coordinates(cube):
    placement = np.array([[2.0, 1.0, 0.5], [0.0, -3.0, 0.25]])
    surface = Surface(Channel((1.0, 1.0, 1.0, 1.0), Texture(IMAGE, placement=placement)))
    placed = sample_surface(textured(cube(), surface), resolution=8, texture_mapped=True).surfels
    plain = sample_surface(textured(cube()), resolution=8, texture_mapped=True).surfels
    np.testing.assert_allclose(placed.uvs, plain.uvs @ placement[:, :2].T + placement[:, 2], atol=1e-5)
    np.testing.assert_allclose(placed.uv_along_x, plain.uv_along_x @ placement[:, :2].T, atol=1e-5)


#: Surfaces whose colour is not one image times a constant.
OTHERS = {
    "constant": Surface(),
    "tinted by vertices": Surface(Channel((1.0, 1.0, 1.0, 1.0), (Texture(IMAGE), VertexColors()))),
    "one number": Surface(Channel((1.0, 1.0, 1.0, 1.0), Texture(IMAGE, weights=(1.0, 0.0, 0.0, 0.0)))),
    "another layer": Surface(Channel((1.0, 1.0, 1.0, 1.0), Texture(IMAGE, layer=1))),
}


@pytest.mark.parametrize("name", OTHERS)
def test_other_surfaces_show_their_own_colour(name, square):
    mesh = textured(square())
    mesh = TriangleMesh(
        mesh.positions, mesh.triangles, corner_uvs=mesh.corner_uvs, materials=np.array([0, 1]),
        surfaces=(TEXTURED, OTHERS[name]),
    )  # fmt: skip
    surfels = sample_surface(mesh, resolution=8, texture_mapped=True).surfels
    for field in UV_FIELDS:
        values = getattr(surfels, field)
        assert (values[surfels.materials == 1] == 0).all() and (values[surfels.materials == 0] != 0).any()


def test_coordinates_that_are_not_finite_leave_the_surfel_its_own_colour(square):
    mesh = textured(square())
    uvs = mesh.corner_uvs.copy()
    uvs[1, 2] = np.nan
    mesh = TriangleMesh(mesh.positions, mesh.triangles, corner_uvs=uvs, surfaces=mesh.surfaces)
    surfels = sample_surface(mesh, resolution=8, texture_mapped=True).surfels
    held = (surfels.uv_along_x == 0).all(axis=1) & (surfels.uv_along_y == 0).all(axis=1)
    assert 0.3 < held.mean() < 0.7 and len(surfels) == 64


def test_nothing_is_kept_where_nobody_asks_or_nothing_is_textured(square):
    assert not sample_surface(textured(square()), resolution=8).surfels.has_uvs
    assert sample_surface(square(), resolution=8, texture_mapped=True).surfels.uvs is None


def charts(cube):
    """A cube with one chart for each face: 3 x 2 charts without a margin."""
    mesh = cube(-0.5)
    square = np.array([(0, 0), (1, 0), (1, 1), (0, 1)], float)
    uvs = np.zeros((12, 3, 2))
    for face in range(6):
        chart = (square + np.array((face % 3, face // 3))) / (3, 2)
        uvs[face], uvs[face + 6] = chart[[0, 1, 2]], chart[[0, 2, 3]]
    return TriangleMesh(mesh.positions, mesh.triangles, corner_uvs=uvs, surfaces=(TEXTURED,))


def test_the_map_ends_at_the_edges_between_charts(cube):
    """The outline of a face is a border, its diagonal is not; the map ends at the border of the surfel's triangle that
    is nearest.
    """
    surfels = sample_surface(charts(cube), resolution=8, texture_mapped=True).surfels
    lined = (surfels.uv_border != 0).any(axis=1)
    centre = surfels.origin + surfels.positions.astype(np.float64)
    u, v = surfels.half_axes()
    to_line = surfels.uv_border / np.maximum((surfels.uv_border**2).sum(axis=1, keepdims=True), 1e-30)
    ends = (centre + u * to_line[:, :1] + v * to_line[:, 1:])[lined]
    inside = np.sort(np.abs(ends), axis=1)
    np.testing.assert_allclose(inside[:, 1:], 0.5, atol=1e-5)  # on an edge of the cube
    is_near = np.sort(np.abs(centre), axis=1)[:, 1] > 0.5 - 1.5 / 8
    # all except those in corners whose nearest edge belongs to the other triangle
    assert lined[is_near].mean() > 0.8 and 0.2 < lined.mean() < 0.8


def test_a_map_without_seams_has_no_borders_but_the_meshes_own(square):
    surfels = sample_surface(textured(square(3.0)), resolution=16, texture_mapped=True).surfels
    x, y = (surfels.origin + surfels.positions)[:, :2].T
    far = np.minimum(np.minimum(x, 3 - x), np.minimum(y, 3 - y)) > 1.5 * surfels.radius
    assert (surfels.uv_border[far] == 0).all() and (surfels.uv_border[~far] != 0).any()


def test_corners_tell_where_a_chart_ends(sphere):
    """One triangle's coordinates are moved away; the others of a closed surface share all their edges."""
    mesh = textured(sphere)
    assert not corner_values(mesh)["seams"].any()
    uvs = mesh.corner_uvs.copy()
    uvs[0] += 3
    seams = corner_values(replace(mesh, corner_uvs=uvs))["seams"].reshape(-1, 3)
    is_at = np.isin(mesh.triangles, mesh.triangles[0])
    assert (seams[0] == 1).all()
    assert ((seams & 1).sum(axis=1)[1:] == (is_at.sum(axis=1) == 2)[1:]).all()
    assert ((seams[1:] >> 1) == (is_at & (is_at.sum(axis=1) == 1)[:, None])[1:]).all()
