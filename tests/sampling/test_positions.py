# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfels lie on the surface and on the grid, wherever the mesh is and however large."""

import numpy as np
import pytest

from splat_addon.sampling import Channel, Surface, TriangleMesh, VertexColors
from splat_addon.sampling import sample as sample_module
from splat_addon.sampling.ldc import scan_conversion
from splat_addon.sampling.mesh import triangle_mesh as mesh_module
from tests.plain import sample_mesh


def test_surfels_lie_on_the_faceted_sphere(sphere):
    """Facets are below the sphere by up to the sagitta, about edge^2 / 6 for edges of 0.02."""
    surfels = sample_mesh(sphere, resolution=64)
    radius = np.linalg.norm(surfels.origin + surfels.positions, axis=1)
    assert radius.max() < 1 + 1e-6 and radius.min() > 1 - 1e-4


def test_surfels_lie_on_their_ray_in_the_middle_of_a_cell(cube):
    cells = sample_mesh(cube(), resolution=32).positions * 32
    off_centre = np.abs(cells - np.floor(cells) - 0.5)
    assert (np.sort(off_centre, axis=1)[:, :2] < 1e-5).all()


def test_a_tilted_plane_holds_its_surfels(triangle):
    """The plane is z = x / 3 - 4 y / 9."""
    surfels = sample_mesh(triangle((0, 0, 0), (9, 0, 3), (0, 9, -4)), resolution=200)
    x, y, z = (surfels.origin + surfels.positions).T
    assert np.abs(z - (x / 3 - y * 4 / 9)).max() < 1e-6


def test_surfels_are_measured_from_the_middle_of_the_mesh(armadillo):
    """The origin is within 8 cells of the middle: float32 rounds numbers half as large by half as much."""
    low, high = armadillo.bounds()
    spacing = (high - low).max() / 256
    surfels = sample_mesh(armadillo, resolution=256)
    assert (np.abs(surfels.positions).max(axis=0) <= (high - low) / 2 + 9 * spacing).all()


@pytest.mark.parametrize("offset", [1e7, -1e7])
def test_a_mesh_far_from_the_origin_keeps_every_bit(armadillo, offset):
    """Vertices at multiples of 2^-20 are moved without rounding, so that only the origin may change."""
    near = TriangleMesh(np.rint(armadillo.positions * 2**20) / 2**20, armadillo.triangles)
    far = TriangleMesh(near.positions + offset, near.triangles)
    a, b = sample_mesh(near, resolution=64), sample_mesh(far, resolution=64)
    assert (a.positions == b.positions).all() and (a.rotations == b.rotations).all()
    assert (b.origin - a.origin == offset).all()


@pytest.mark.parametrize("scale", [1e-6, 1e6])
def test_a_scaled_mesh_gives_scaled_surfels(armadillo, scale):
    a = sample_mesh(armadillo, resolution=64)
    b = sample_mesh(TriangleMesh(armadillo.positions * scale, armadillo.triangles), resolution=64)
    assert len(a) == len(b)
    assert np.abs(b.positions / scale - a.positions).max() < 1e-5 * np.abs(a.positions).max()


def test_chunks_and_batches_of_any_size_give_the_same_surfels(armadillo, monkeypatch):
    whole = sample_mesh(armadillo, resolution=64)
    monkeypatch.setattr(mesh_module.triangle_chunks, "__defaults__", (1000,))
    monkeypatch.setattr(scan_conversion, "BATCH", 777)
    monkeypatch.setattr(sample_module, "BATCH", 501)
    parts = sample_mesh(armadillo, resolution=64)
    assert (whole.positions == parts.positions).all() and (whole.rotations == parts.rotations).all()
    assert (whole.normals == parts.normals).all()


def test_a_flat_mesh_keeps_its_exact_height(square):
    mesh = square()
    surfels = sample_mesh(TriangleMesh(mesh.positions + np.array([0, 0, 0.1]), mesh.triangles), resolution=10)
    assert len(surfels) == 100 and (surfels.positions[:, 2] == 0).all() and surfels.origin[2] == 0.1


def slivers(thicknesses, count=1000):
    """Triangles with one corner that far from the line between two random ones; their colours are 0 or 1 at random."""
    random = np.random.default_rng(3)
    a, b = random.random((2, count * len(thicknesses), 3))
    middle = a + random.random((len(a), 1)) * (b - a)
    off = np.repeat(thicknesses, count)[:, None] * random.normal(size=a.shape)
    corners = np.stack([a, b, middle + off], axis=1)
    colors = random.integers(0, 2, (len(a), 3, 4)).astype(float)
    surfaces = (Surface(Channel((1, 1, 1, 1), VertexColors())),)
    triangles = np.arange(3 * len(a)).reshape(-1, 3)
    return TriangleMesh(corners.reshape(-1, 3), triangles, corner_colors=colors, surfaces=surfaces)


def test_collinear_and_sliver_triangles_give_finite_surfels_inside_the_box():
    """Snapping widens slivers thinner than a sub-cell; Surfels refuses values that are not finite."""
    surfels = sample_mesh(slivers([0, 1e-17, 1e-9]), resolution=4096)
    places = surfels.origin + surfels.positions
    assert len(surfels) > 100 and (places > -1e-3).all() and (places < 1.001).all()


def test_a_sample_beside_its_sliver_takes_no_value_beyond_the_corners():
    """Snapping moves a triangle's outline by up to a sub-cell, which is much of a sliver's width."""
    colors = sample_mesh(slivers([1e-6, 1e-7, 1e-8]), resolution=4096).colors
    assert len(colors) > 1000 and colors.min() > -1e-6 and colors.max() < 1 + 1e-6
