# SPDX-License-Identifier: GPL-3.0-or-later
"""Points on surfaces with known normals."""

import gzip

import numpy as np
import pytest


@pytest.fixture
def sphere_points():
    """sphere_points(n, noise=0) -> (n, 3) random points near the unit sphere, and their normals."""

    def make(count, noise=0.0):
        random = np.random.default_rng(5)
        normals = random.normal(size=(count, 3))
        normals /= np.linalg.norm(normals, axis=1, keepdims=True)
        return normals * (1 + noise * random.normal(size=(count, 1))), normals

    return make


@pytest.fixture
def torus_points():
    """torus_points(n, noise=0) -> (n, 3) random points near a torus of radii 1 and 0.3, and their normals."""

    def make(count, noise=0.0):
        random = np.random.default_rng(6)
        around, tube = random.uniform(0, 2 * np.pi, (2, count))
        ring = np.stack([np.cos(around), np.sin(around), 0 * around], axis=1)
        normals = np.cos(tube)[:, None] * ring + np.sin(tube)[:, None] * (0, 0, 1)
        return ring + (0.3 + noise * random.normal(size=(count, 1))) * normals, normals

    return make


@pytest.fixture
def grid_points():
    """grid_points(columns, rows, dx=1, dy=1) -> the points of a grid in the plane z = 0."""

    def make(columns, rows, dx=1.0, dy=1.0):
        x, y = np.meshgrid(np.arange(columns) * dx, np.arange(rows) * dy, indexing="ij")
        return np.stack([x, y, np.zeros_like(x)], axis=-1).reshape(-1, 3)

    return make


@pytest.fixture(scope="session")
def range_map_mesh(models):
    """The (62702, 3) vertices of a range map, seen by a scanner at the origin, and its (120995, 3) faces."""
    data = gzip.decompress((models / "rangemap_lato315.ply.gz").read_bytes())
    head, body = data.split(b"end_header\n", 1)
    assert b"element vertex 62702" in head and b"element face 120995" in head
    camera = 23 * 4
    row = np.dtype([("position", "<f4", 3), ("flags", "<i4"), ("quality", "<f4")])
    face = np.dtype([("corners", "u1"), ("indices", "<i4", 3), ("flags", "<i4"), ("quality", "<f4")])
    vertices = np.frombuffer(body, row, 62702, camera)["position"].astype(float)
    return vertices, np.frombuffer(body, face, 120995, camera + 62702 * row.itemsize)["indices"]


@pytest.fixture(scope="session")
def range_map(range_map_mesh):
    """The range map's vertices without the faces."""
    return range_map_mesh[0]
