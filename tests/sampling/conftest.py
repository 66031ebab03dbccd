# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes for the sampling tests, and the rays of a layered depth cube."""

import gzip

import numpy as np
import pytest

from splat_addon.runs import expand
from splat_addon.sampling import TriangleMesh, drop_unusable, grid_spacing
from splat_addon.sampling.ldc.depth_cube import depth_cube
from splat_addon.sampling.ldc.grid import make_grid
from splat_addon.sampling.ldc.missed_components import SampledSurface


@pytest.fixture
def cube():
    """cube(offset) -> the unit cube with a corner there: 12 triangles with normals outwards."""

    def build(offset=0.0):
        corners = np.array([(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)], float)
        quads = np.array([(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)])
        return TriangleMesh(corners + offset, np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]]))

    return build


@pytest.fixture(scope="session")
def sphere():
    """The unit sphere as 81,920 triangles, with its exact normals at their corners."""
    import trimesh

    ball = trimesh.creation.icosphere(subdivisions=6)
    return TriangleMesh(ball.vertices, ball.faces, corner_normals=ball.vertices[ball.faces])


@pytest.fixture(scope="session")
def armadillo(models):
    """A closed scan of 86,482 triangles."""
    return read_obj(models / "armadillo.obj.gz")


@pytest.fixture(scope="session")
def truck(models):
    """4,770 triangles in 50 parts, many open and thin."""
    return read_obj(models / "truck.obj.gz")


def read_obj(path):
    with gzip.open(path, "rt") as lines:
        rows = [line.split() for line in lines]
    positions = np.array([r[1:4] for r in rows if r[:1] == ["v"]], float)
    triangles = np.array([[c.split("/")[0] for c in r[1:4]] for r in rows if r[:1] == ["f"]], int) - 1
    return TriangleMesh(positions, triangles)


@pytest.fixture
def triangle():
    """triangle(a, b, c, **fields) -> a mesh of one triangle."""
    return lambda *corners, **fields: TriangleMesh(np.array(corners, float), np.array([[0, 1, 2]]), **fields)


@pytest.fixture
def square():
    """square(edge, **fields) -> a square at z = 0 with a corner at the origin: two triangles, normal +z."""

    def build(edge=1.0, **fields):
        positions = np.array([(0, 0, 0), (edge, 0, 0), (edge, edge, 0), (0, edge, 0)])
        return TriangleMesh(positions, np.array([(0, 1, 2), (0, 2, 3)]), **fields)

    return build


@pytest.fixture(scope="session")
def rays():
    """rays(mesh, resolution) -> the grid and, for each axis, the (n, 2) column and row of every sample before
    reduction.
    """

    def shoot(mesh, resolution):
        mesh, _ = drop_unusable(mesh)
        grid = make_grid(mesh, grid_spacing(mesh, resolution=resolution))
        coordinates = grid.coordinates(mesh.positions)
        surface = SampledSurface(len(mesh.positions))
        images = depth_cube(coordinates, mesh.triangles, grid, lambda normals: normals > 0, surface, lambda share: None)
        hits = []
        for spans in images:
            owner, step = expand(spans.counts)
            hits.append(np.stack([spans.columns[owner] + step, spans.rows[owner]], axis=1))
        return grid, hits

    return shoot
