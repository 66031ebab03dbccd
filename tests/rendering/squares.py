# SPDX-License-Identifier: GPL-3.0-or-later
"""A square as polygons and as surfels, for tests of both forms."""

from dataclasses import replace

import numpy as np

from splat_addon.rendering import Camera, Polygons, look_at, make_polygons
from splat_addon.sampling import TriangleMesh
from tests.plain import sample_mesh

SIZE = (96, 96)
SQUARE = np.array([(-1.0, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0)])
HALVES = np.array([(0, 1, 2), (0, 2, 3)])
ABOVE = Camera.perspective(look_at((0, -2.6, 2.2), (0, 0, 0)), 0.75, SIZE)


def square(color=(0.5, 0.5, 0.5, 1.0), **fields) -> Polygons:
    return make_polygons(SQUARE, HALVES, color=color, **fields)


def square_surfels(spacing: float, color, keep=lambda x, y: x > -9):
    surfels = sample_mesh(TriangleMesh(SQUARE, HALVES), spacing=spacing)
    places = surfels.positions + surfels.origin
    kept = keep(places[:, 0], places[:, 1])
    arrays = {name: array[kept] for name, array in surfels.arrays().items()}
    return replace(surfels, **arrays | {"colors": np.tile(np.float32(color), (kept.sum(), 1))})
